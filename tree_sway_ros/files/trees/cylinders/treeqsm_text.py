"""
TreeQSM's text of a cylinder model: without a header, or with one as 2.4 and PyTLidar have it.

Each row has radius, length, start (3), axis (3), parent and extension; what follows depends on the
version: added, unmodified radius, branch, order, position in 2.3, branch, order, position, added in
a saved ``CylData``. The header of 2.4 names start and axis once, though each has three columns.
Tabs, spaces, commas or semicolons stand between the cells.

"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.text_file import finite, read_lines, why_no_number
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.treeqsm_columns import (
    USED_COLUMNS,
    looks_like_cylinders,
    treeqsm_cylinders,
)

_MANY = 15
"""Rows from the beginning of a file that are judged."""


def looks_like_treeqsm_text(head: str) -> bool:
    """Whether the beginning of a file is that of a TreeQSM text, judged by all whole rows there."""
    lines = [line for line in head.splitlines() if line.strip()]
    if lines and lines[0].lower().startswith("radius") and "axis_direction" in lines[0]:
        return True
    rows = [[finite(cell) for cell in _cells(line)] for line in lines]
    # The first line may be a header of some kind, the last one of many cut in the middle.
    whole = [row for row in rows[:_MANY] if None not in row]
    width = max((len(row) for row in whole), default=0)
    table = np.array([row for row in whole if len(row) == width], dtype=np.float64)
    return (
        10 * len(table) >= 7 * (min(len(rows), _MANY) - 1)
        and bool(width)
        and looks_like_cylinders(table)
    )


def _cells(line: str) -> list[str]:
    """Cells of a row; commas separate only where neither semicolons nor white space do."""
    cells = line.replace(";", " ").split()
    return cells if len(cells) >= USED_COLUMNS else line.replace(",", " ").split()


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
        cells = _cells(line)
        is_header = not rows and all(finite(cell) is None for cell in cells)
        if is_header or not cells:
            continue
        values = [finite(cell) for cell in cells[:USED_COLUMNS]]
        good = [value for value in values if value is not None]
        if len(good) < USED_COLUMNS:
            bad = next((f": {why_no_number(c)}" for c in cells if finite(c) is None), "")
            raise FormatError(
                f"{len(good)} good numbers of {USED_COLUMNS}{bad}",
                where=f"{source}:{number}",
                cure="a row is radius, length, start, axis, parent, extension ...",
            )
        rows.append(good)
        labels.append(f"{source}:{number}: cylinder {len(rows)}")
    return (treeqsm_cylinders(np.array(rows).reshape(-1, USED_COLUMNS), labels, source),)
