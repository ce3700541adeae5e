# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
CSV of meteoblue's history, whose columns begin with the place: ``Basel Wind Speed [10 m]``.

Above the row ``timestamp,...`` stand rows of which one, ``unit``, has the unit of each column
(meteoblue, "history+", CSV). The lowest height with speed and direction is taken, 10 m.
"""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.files.cell_table import table_of_lines
from tree_sway.files.table_file import TextTable
from tree_sway.files.wind.layouts.layout import Layout

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
    units = next((line.split(',') for line in lines[:header] if line.startswith('unit,')), [])
    places = [0]
    columns = ['time']
    for quantity, ending in _QUANTITIES.items():
        found = [place for place, name in enumerate(names) if name.endswith(ending)]
        places += found[:1]
        columns += [quantity] * len(found[:1])
    rows = []
    for number, line in enumerate(lines[header + 1 :], start=header + 2):
        cells = line.split(',')
        if len(cells) == len(names):
            rows.append((number, [cells[place].strip() for place in places]))
    found_units = ['', *(units[place] if place < len(units) else '' for place in places[1:])]
    return table_of_lines(columns, rows, source, found_units)


METEOBLUE = Layout('meteoblue', _is_meteoblue, _read)
