# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Units within the cells of speeds, as in ``4.2 mph``, moved to the head of their column."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import re

from tree_sway.files.column_names import unit_known
from tree_sway.files.table_file import TextTable

_UNIT = re.compile(r'(?<=\d)\s*([a-zA-Z][a-zA-Z/]*)\s*$')
_LOOKED_AT = 50


def with_units_in_head(table: TextTable) -> TextTable:
    """Return a table whose cells of speed and gust are numbers alone; itself if they are."""
    names = list(table.columns)
    places = [index for each in ('wind_speed', 'gust') for index in table.find_all(each)[:1]]
    for index in places:
        cells = filter(None, table.cells(index, table.rows[:_LOOKED_AT]))
        units = {unit for cell in cells for unit in _UNIT.findall(cell) or ['']}
        if len(units) == 1 and unit_known('speed', *units):
            names[index] += f' [{units.pop()}]'
    changed = [index for index in places if names[index] != table.columns[index]]
    if not changed:
        return table

    def split(line: str) -> Sequence[str]:
        cells = table.split(line)
        return [_UNIT.sub('', cell) if i in changed else cell for i, cell in enumerate(cells)]

    return replace(table, columns=tuple(names), split=split)
