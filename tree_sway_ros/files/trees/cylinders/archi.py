"""
aRchi's table of cylinders (Martin-Ducup et al. 2021): numbered from 1, the root's parent 0.

A cylinder that is the ``extension_ID`` of its parent goes on with the branch.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.files.table_file import parse_table, whole
from tree_sway_ros.files.text_file import read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.numbering import positions_of_parents

_COLUMNS = ("cyl_ID", "parent_ID", "extension_ID", "startX", "startY", "startZ", "endX", "endY",
            "endZ",
            "radius_cyl")  # fmt: skip


def read_archi_csv(path: Path) -> tuple[Cylinders, ...]:
    """
    Read the cylinders of an aRchi table.

    Raises
    ------
    FormatError
        A column that is missing, a cell that is no finite number, a number that stands twice.
    TreeError
        A parent that is not there.

    """
    table = parse_table(read_lines(path), str(path))
    rows, labels, numbers = list[list[float]](), list[str](), list[list[int]]()
    for line, values in table.numbers(_COLUMNS):
        where = f"{path}:{line}"
        names = zip(values[:3], _COLUMNS[:3], strict=True)
        numbers.append([whole(value, name, where) for value, name in names])
        labels.append(f"{where}: cylinder {numbers[-1][0]}")
        rows.append(values)
    data = np.array(rows)
    ids = [number for number, _, _ in numbers]
    parent = positions_of_parents(ids, [above for _, above, _ in numbers], labels, [0, -1])
    extension = {(number, after) for number, _, after in numbers}
    continues = np.array([(above, number) in extension for number, above, _ in numbers])
    diameter = 2.0 * np.stack([data[:, 9], data[:, 9]], axis=1)
    return (Cylinders(data[:, 3:6], data[:, 6:9], diameter, parent, continues, labels),)
