"""
TreeQSM's text of a cylinder model: version 2.3 without a header, 2.4 and PyTLidar with one.

Version 2.3: 15 columns, radius, length, start (3), axis (3), parent, extension, added, unmodified
radius, branch, order, position. Version 2.4: the header names start and axis once, though each has
three columns. Tabs or spaces between them.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.text_file import finite, read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.treeqsm_columns import treeqsm_cylinders

_USED = 10
"""Columns from the left that are used; the same in every version."""


def looks_like_treeqsm_text(head: str) -> bool:
    """Whether the beginning of a file is that of a TreeQSM text."""
    first = head.lstrip().splitlines()[:1]
    if not first:
        return False
    if first[0].lower().startswith("radius") and "axis_direction" in first[0]:
        return True
    cells = first[0].split()
    numbers = [finite(cell) for cell in cells]
    if len(cells) < 13 or None in numbers:
        return False
    # The axis of a cylinder has length 1.
    return abs(float(np.linalg.norm([x or 0.0 for x in numbers[5:8]])) - 1.0) < 0.01


def read_treeqsm_text(path: Path) -> tuple[Cylinders, ...]:
    """
    Read the cylinders of a TreeQSM text.

    Raises
    ------
    FormatError
        A row that is too short or holds something that is not a finite number.

    """
    source, rows, labels = str(path), list[list[float]](), list[str]()
    for number, line in enumerate(read_lines(path), start=1):
        cells = line.split()
        if not cells or (not rows and line.lower().startswith("radius")):
            continue
        values = [finite(cell) for cell in cells[:_USED]]
        good = [value for value in values if value is not None]
        if len(good) < _USED:
            raise FormatError(
                f"{len(good)} good numbers of {_USED}",
                where=f"{source}:{number}",
                cure="a row is radius, length, start, axis, parent, extension ...",
            )
        rows.append(good)
        labels.append(f"{source}:{number}: cylinder {len(rows)}")
    if not rows:
        raise FormatError("no cylinders", where=source)
    table = np.array(rows)
    columns = table[:, 0], table[:, 1], table[:, 2:5], table[:, 5:8], table[:, 8], table[:, 9]
    return (treeqsm_cylinders(*columns, labels, source),)
