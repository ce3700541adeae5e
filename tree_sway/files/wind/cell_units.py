# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Units within the cells of speeds, as in ``4.2 mph``, moved to the head of their column."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import re

from tree_sway.files.column_names import unit_known
from tree_sway.files.table_file import TextTable

_CELL = re.compile(r'\s*(-?\d+(?:[.,]\d+)?)\s*([a-zA-Z][a-zA-Z/]*)\s*')
_LOOKED_AT = 50


def with_units_in_head(table: TextTable) -> TextTable:
    """Return a table whose cells of speed and gust are numbers alone; itself if they are."""
    units: dict[int, str] = {}
    for quantity in ('wind_speed', 'gust'):
        for index in table.find_all(quantity)[:1]:
            cells = table.cells(index, table.rows[:_LOOKED_AT])
            found = {_unit_of(cell) for cell in cells if cell.strip()}
            if len(found) == 1 and found != {''}:
                units[index] = found.pop()
    if not units:
        return table

    def split(line: str) -> Sequence[str]:
        return [
            number[1] if i in units and (number := _CELL.fullmatch(cell)) else cell
            for i, cell in enumerate(table.split(line))
        ]

    names = tuple(
        f'{name} [{units[i]}]' if i in units else name for i, name in enumerate(table.columns)
    )
    return replace(table, columns=names, split=split)


def _unit_of(cell: str) -> str:
    """Return the unit of speed of a cell; empty without one."""
    found = _CELL.fullmatch(cell)
    return found[2] if found and unit_known('speed', found[2]) else ''
