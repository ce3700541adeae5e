"""
SimpleForest's table of cylinders (Hackenberg et al. 2021): numbered from 0, the root's parent -1.

It has no column for the extension. The branch order says as much: of the children of a cylinder the
one of the same order goes on; ``branchID`` numbers whole limbs with all they carry, not chains. Of
several of the same order, the one with the greatest growth length, all that hangs on it, goes on.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.files.table_file import parse_table, whole
from tree_sway_ros.files.text_file import read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.numbering import positions_of_parents

_COLUMNS = ("ID", "parentID", "startX", "startY", "startZ", "endX", "endY", "endZ", "radius",
            "branchOrder", "growthLength")  # fmt: skip


def read_simpleforest_csv(path: Path) -> tuple[Cylinders, ...]:
    """
    Read the cylinders of a SimpleForest table.

    Raises
    ------
    FormatError
        A column that is missing, a cell that is no finite number, a number that stands twice.
    TreeError
        A parent that is not there.

    """
    table = parse_table(read_lines(path), str(path))
    rows, labels, numbers = list[list[float]](), list[str](), list[tuple[int, int]]()
    for line, values in table.numbers(_COLUMNS):
        where = f"{path}:{line}"
        numbers.append((whole(values[0], "ID", where), whole(values[1], "parentID", where)))
        labels.append(f"{where}: cylinder {numbers[-1][0]}")
        rows.append(values)
    data = np.array(rows)
    parent = positions_of_parents([n for n, _ in numbers], [p for _, p in numbers], labels, [-1])
    continues = _continues(parent, data[:, 9], data[:, 10])
    diameter = 2.0 * np.stack([data[:, 8], data[:, 8]], axis=1)
    return (Cylinders(data[:, 2:5], data[:, 5:8], diameter, parent, continues, labels),)


def _continues(parent: Ints, order: Floats, growth: Floats) -> NDArray[np.bool_]:
    best: dict[int, int] = {}
    for index, above in enumerate(parent.tolist()):
        if above >= 0 and order[index] == order[above]:
            rival = best.get(above)
            if rival is None or growth[index] > growth[rival]:
                best[above] = index
    continues = np.zeros(len(parent), dtype=np.bool_)
    continues[list(best.values())] = True
    return continues
