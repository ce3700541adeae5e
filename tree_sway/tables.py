# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of the package: one CSV file each, beside the module that reads it."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any


def table_beside(module: str, name: str) -> list[dict[str, Any]]:
    """
    Read a table in the folder of a module, which is given by its ``__file__``.

    One row a line under a line of names. Cells are numbers, several numbers with spaces between
    them, ``yes`` or ``no``, or else text.
    """
    with Path(module).with_name(name).open(encoding='utf-8', newline='') as lines:
        rows = list(csv.DictReader(lines))
    return [{column: _value(cell) for column, cell in row.items()} for row in rows]


def _value(cell: str) -> Any:
    if cell in ('yes', 'no'):
        return cell == 'yes'
    try:
        numbers = tuple(int(word) if word.isdecimal() else float(word) for word in cell.split())
    except ValueError:
        return cell
    return numbers[0] if len(numbers) == 1 else numbers
