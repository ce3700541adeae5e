"""
A plain table of segments: one row each, with nodes, diameters, parent and branch.

Columns ``segment, parent, branch, x0, y0, z0, x1, y1, z1, d0, d1`` in any order, in metres;
``segment`` names the row and ``parent`` refers to such a name, -1 for the root; without ``branch``
the branches are found from how the segments go on, without ``d1`` a segment is a cylinder.

"""

from __future__ import annotations

from pathlib import Path

from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.errors import FormatError, TreeError
from tree_sway_ros.files.table_file import parse_table, whole
from tree_sway_ros.files.text_file import read_lines
from tree_sway_ros.files.trees.assembly import SegmentTable
from tree_sway_ros.files.trees.imported_tree import TreeFile

_GEOMETRY = ("segment", "parent", "x0", "y0", "z0", "x1", "y1", "z1", "d0")


def read_csv_tree(path: Path, species: str = "broadleaf") -> TreeFile:
    """
    Read a tree from a table of segments.

    Parameters
    ----------
    path
        The file.
    species
        Key of its wood.

    Raises
    ------
    FormatError
        A column that is missing, a cell that is no finite number, a segment that stands twice.
    TreeError
        A tree that cannot be.

    """
    source = str(path)
    text = parse_table(read_lines(path), source)
    columns = {column.lower() for column in text.columns}
    optional = [name for name in ("d1", "branch") if name in columns]
    table, index, parent_keys = SegmentTable(), dict[int, int](), list[int]()
    for line, values in text.numbers([*_GEOMETRY, *optional]):
        where = f"{source}:{line}"
        row = dict(zip([*_GEOMETRY, *optional], values, strict=True))
        key = whole(row["segment"], "segment", where)
        if key in index:
            raise FormatError(f"segment {key} stands twice", where=where, cure="renumber it")
        index[key] = len(index)
        parent_keys.append(whole(row["parent"], "parent", where))
        if "branch" in row:
            table.branch.append(whole(row["branch"], "branch", where))
        table.start.append(values[2:5])
        table.end.append(values[5:8])
        table.diameter.append([row["d0"], row.get("d1", row["d0"])])
        table.labels.append(f"{where}: segment {key}")
    for key, label in zip(parent_keys, table.labels, strict=True):
        if key not in index and key != -1:
            raise TreeError(
                f"orphan: no segment {key}", where=label, cure="name a segment, or -1 for the root"
            )
        table.parent.append(index.get(key, -1))
    wood = species_named(species)
    return TreeFile(table.build(source, path.stem, wood.key), wood, source)
