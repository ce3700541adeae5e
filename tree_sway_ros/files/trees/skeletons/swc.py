"""
SWC, the skeleton format of neuroscience, which tree reconstructions use too.

A node a line: number, type, x, y, z, radius, parent, -1 at a root. Each root is a tree of its own.
SWC has no unit: ``unit`` says how many metres one is.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.files.table_file import row_numbers, whole
from tree_sway_ros.files.text_file import finite, read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.joining import checked_order
from tree_sway_ros.files.trees.cylinders.numbering import positions_of_parents
from tree_sway_ros.files.trees.skeletons.node_skeleton import Skeleton

_COLUMNS = ("number", "type", "x", "y", "z", "radius", "parent")


def looks_like_swc(head: str) -> bool:
    """Whether the beginning of a file is that of an SWC file."""
    for line in head.splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            cells = line.split()
            return len(cells) == 7 and None not in map(finite, cells)
    return False


def read_swc(path: Path, unit: float = 1.0) -> tuple[Cylinders, ...]:
    """
    Read the trees of an SWC file.

    Parameters
    ----------
    path
        The file.
    unit
        Length of its unit in [m].

    Raises
    ------
    FormatError
        A row that is no node, a number that stands twice, no nodes.
    TreeError
        A parent that is not there, or a cycle.

    """
    if not 0.0 < unit < 1e6:
        raise ParameterError(f"unit is {unit:g} m", cure="give more than 0")
    source, labels = str(path), list[str]()
    numbers, parents, rows = list[int](), list[int](), list[list[float]]()
    for line, text in enumerate(read_lines(path), start=1):
        if not text.strip() or text.lstrip().startswith("#"):
            continue
        where = f"{source}:{line}"
        values = row_numbers(text.split(), range(7), _COLUMNS, where)
        numbers.append(whole(values[0], "number", where))
        parents.append(whole(values[6], "parent", where))
        rows.append(values)
        labels.append(f"{where}: node {numbers[-1]}")
    if not rows:
        raise FormatError("no nodes", where=source, cure="give a node a line")
    parent = positions_of_parents(numbers, parents, labels, [-1])
    point, width = unit * np.array(rows)[:, 2:5], 2.0 * unit * np.array(rows)[:, 5]
    trees: dict[int, Skeleton] = {}
    place = np.zeros((len(rows), 2), dtype=np.int64)
    for index in checked_order(parent, labels):
        root, above = (index, -1) if parent[index] < 0 else place[parent[index]].tolist()
        tree = trees.setdefault(root, Skeleton())
        place[index] = root, len(tree.point)
        tree.point.append(point[index].tolist())
        tree.diameter.append(float(width[index]))
        tree.parent.append(above)
        tree.labels.append(labels[index])
    return tuple(tree.cylinders(source, cones=True) for tree in trees.values())
