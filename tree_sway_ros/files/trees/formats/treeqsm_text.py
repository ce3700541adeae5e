# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
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
from tree_sway_ros.files.table_file import parse_columns
from tree_sway_ros.files.text_file import finite, read_lines, why_no_number
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.treeqsm_columns import (
    USED_COLUMNS,
    looks_like_cylinders,
    treeqsm_cylinders,
)
from tree_sway_ros.files.trees.tree_format import TreeFormat

_MANY = 15
"""Rows from the beginning of a file that are judged."""


def looks_like_treeqsm_text(head: str) -> bool:
    """Whether the beginning of a file is that of a TreeQSM text, judged by many rows."""
    lines = [line for line in head.splitlines() if line.strip()]
    if lines and lines[0].lower().startswith("radius") and "axis_direction" in lines[0]:
        return True
    rows = [[finite(cell) for cell in _cells(line)] for line in lines[:_MANY]]
    # The first line may be a header of some kind, the last one of many cut in the middle.
    whole = [row for row in rows if None not in row]
    width = max(map(len, whole), default=0)
    table = np.array([row for row in whole if len(row) == width], dtype=np.float64)
    return width > 0 and len(table) >= 0.7 * (len(rows) - 1) and looks_like_cylinders(table)


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
    lines = read_lines(path)
    first = next((i for i, line in enumerate(lines) if line.strip()), 0)
    if lines and all(finite(cell) is None for cell in _cells(lines[first])):
        lines[first] = ""
    table = parse_columns(lines, str(path), [""] * USED_COLUMNS, _cells)
    values = table.values(range(USED_COLUMNS))
    for row in np.flatnonzero(np.isnan(values).any(axis=1))[:1]:
        bad = next(
            (f": {why_no_number(c)}" for c in _cells(table.texts[row]) if finite(c) is None), ""
        )
        raise FormatError(
            f"{np.isfinite(values[row]).sum()} good numbers of {USED_COLUMNS}{bad}",
            where=table.where(row),
            cure="a row is radius, length, start, axis, parent, extension ...",
        )
    labels = [f"{table.where(row)}: cylinder {row + 1}" for row in range(len(values))]
    return (treeqsm_cylinders(values, labels, str(path)),)


FORMAT = TreeFormat("treeqsm-text", (".cyl",), looks_like_treeqsm_text, read_treeqsm_text)
