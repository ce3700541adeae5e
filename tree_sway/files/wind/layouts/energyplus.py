# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Weather files of EnergyPlus (.epw), in which a place's typical year is given by the hour.

Eight lines stand above the rows, which have no names: year, month, day, the hour that ends at the
row's time, and from the twenty-first field on the direction in degrees, with 999 for a missing
one, and the speed in [m/s] (EnergyPlus, "Auxiliary Programs": EPW data dictionary). The months of
a typical year are of several years: the first row's year counts for all.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tree_sway.files.cell_table import cell_at, numbered, NumberedRow, table_of_lines
from tree_sway.files.table_file import TextTable
from tree_sway.files.wind.layouts.layout import Layout

_NAMES = ('time', 'wind direction', 'wind speed')
_UNITS = ('', 'deg', 'm/s')
_HEADER = 8
_DIRECTION = 20
_SPEED = 21
_MISSING = '999'


def _is_epw(lines: Sequence[str]) -> bool:
    return len(lines) > _HEADER and lines[0].startswith('LOCATION,')


def _read(lines: list[str], source: str) -> TextTable:
    return table_of_lines(_NAMES, _rows(lines), source, _UNITS)


def _rows(lines: Sequence[str]) -> Iterator[NumberedRow]:
    year = cell_at(lines[_HEADER].split(','), 0)
    for number, line in numbered(lines, _HEADER):
        cells = line.split(',')
        if len(cells) > _SPEED:
            month, day, hour = (cell.strip().zfill(2) for cell in cells[1:4])
            stamp = f'{year}-{month}-{day} {hour}:00'
            yield number, [stamp, _known(cells, _DIRECTION), _known(cells, _SPEED)]


def _known(cells: Sequence[str], place: int) -> str:
    cell = cell_at(cells, place)
    return '' if cell == _MISSING else cell


EPW = Layout('epw', _is_epw, _read)
