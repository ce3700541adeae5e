# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
CSV of meteoblue's history, whose columns begin with the place: ``Basel Wind Speed [10 m]``.

Above the row ``timestamp,...`` stand rows of which one, ``unit``, has the unit of each column
(meteoblue, "history+", CSV). The lowest height with speed and direction is taken, 10 m.
"""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.files.cell_table import cell_at, numbered, table_of_lines
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import TextTable

_QUANTITIES = {
    'wind speed': ' Wind Speed [10 m]',
    'wind direction': ' Wind Direction [10 m]',
    'gust': ' Wind Gust',
}
_HEAD = 20


def _header(lines: Sequence[str]) -> int | None:
    """Row of the names, below that of the places; None without them."""
    if not lines or not lines[0].startswith('location,'):
        return None
    head = enumerate(lines[:_HEAD])
    return next((number for number, line in head if line.startswith('timestamp,')), None)


def _is_meteoblue(lines: Sequence[str]) -> bool:
    return _header(lines) is not None


def _read(lines: list[str], source: str) -> TextTable:
    header = _header(lines) or 0
    names = lines[header].split(',')
    above = [line.split(',') for line in lines[:header] if line.startswith('unit,')]
    units = above[0] if above else []
    places = [0]
    columns = ['time']
    for quantity, ending in _QUANTITIES.items():
        found = [place for place, name in enumerate(names) if name.endswith(ending)]
        places += found[:1]
        columns += [quantity] * len(found[:1])
    rows = []
    for number, line in numbered(lines, header + 1):
        cells = line.split(',')
        if len(cells) == len(names):
            row = [cell_at(cells, place) for place in places]
            rows.append((number, row))
    found_units = [cell_at(units, place) for place in places]
    found_units[0] = ''  # of the time, which has the word itself
    return table_of_lines(columns, rows, source, found_units)


METEOBLUE = Layout('meteoblue', _is_meteoblue, _read)
