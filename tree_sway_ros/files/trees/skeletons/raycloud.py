"""
RayCloudTools' tree file (Lowe & Stepanas 2021): a tree a line, its nodes one after the other.

After comments a header, such as ``height,crown_radius, x,y,z,radius,parent_id,section_id``:
attributes of the tree, if any, then the fields of a node. The first node of a line is the root,
parent -1, and has no volume; each other one is a cylinder from its parent's point to its own, of
its own radius.

"""

from __future__ import annotations

import re
from pathlib import Path

from tree_sway_ros.errors import FormatError, ParameterError, TreeError
from tree_sway_ros.files.table_file import row_numbers, whole
from tree_sway_ros.files.text_file import read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.skeletons.node_skeleton import Skeleton

_FIELDS = ("x", "y", "z", "radius", "parent_id")


def looks_like_treefile(head: str) -> bool:
    """Whether the beginning of a file is that of a tree file."""
    return re.search(r"^(?!#).*\bx,y,z,radius\b", head, re.MULTILINE) is not None


def read_treefile(path: Path, tree: int = 0) -> tuple[Cylinders, ...]:
    """
    Read the trees of a RayCloudTools tree file.

    Parameters
    ----------
    path
        The file.
    tree
        Which of its trees, from 1; all of them if 0.

    Raises
    ------
    ParameterError
        A tree that the file does not hold.
    FormatError
        No header, trunks without branches, a line that does not hold whole nodes.
    TreeError
        A node whose parent is not there, or a second root in a line.

    """
    source = str(path)
    lines = [
        (number, line)
        for number, line in enumerate(read_lines(path), start=1)
        if line.strip() and not line.startswith("#")
    ]
    if not lines:
        raise FormatError("no header", where=source, cure="a header names x,y,z,radius,parent_id")
    number, header = lines[0]
    of_tree, found, fields = header.partition("x,y,z,radius")
    columns = [name.strip() for name in (found + fields).split(",") if name.strip()]
    for name in _FIELDS:
        if name not in columns:
            trunks = ": trunks without branches" if name == "parent_id" else ""
            raise FormatError(
                f"no field {name}{trunks}",
                where=f"{source}:{number}",
                cure="extract the trees with rayextract trees",
            )
    n_of_tree = sum(bool(name.strip()) for name in of_tree.split(","))
    trees = []
    for index, (number, line) in enumerate(lines[1:], start=1):
        where = f"{source}:{number}"
        skeleton = _skeleton(line, n_of_tree, columns, where)
        cylinders = skeleton.cylinders(where, cones=False)
        cylinders.name = f"{path.stem}{index}" if len(lines) > 2 else path.stem
        trees.append(cylinders)
    if not trees:
        raise FormatError("no trees", where=source)
    if not 0 <= tree <= len(trees):
        raise ParameterError(
            f"tree {tree} of {len(trees)}",
            where=source,
            cure=f"give 1 to {len(trees)}, or 0 for all",
        )
    return (trees[int(tree) - 1],) if tree else tuple(trees)


def _skeleton(line: str, n_of_tree: int, columns: list[str], where: str) -> Skeleton:
    cells = [cell for cell in (cell.strip() for cell in line.split(",")) if cell][n_of_tree:]
    if not cells or len(cells) % len(columns):
        raise FormatError(
            f"{len(cells)} values are not whole nodes of {len(columns)}",
            where=where,
            cure=f"a node has {','.join(columns)}",
        )
    indices = [columns.index(name) for name in _FIELDS]
    skeleton = Skeleton()
    for begin in range(0, len(cells), len(columns)):
        label = f"{where}: node {len(skeleton.point)}"
        values = row_numbers(cells[begin : begin + len(columns)], indices, _FIELDS, label)
        above = whole(values[4], "parent_id", label)
        if (above < 0) != (begin == 0) or above >= len(cells) // len(columns):
            raise TreeError(
                f"parent_id is {above}",
                where=label,
                cure="the first node has -1, every other the number of a node of its line",
            )
        skeleton.point.append(values[:3])
        skeleton.diameter.append(2.0 * values[3])
        skeleton.parent.append(above)
        skeleton.labels.append(label)
    return skeleton
