# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
NOAA's Integrated Surface Database: hourly CSV.

The CSV has the wind in one cell, ``WND = "270,1,N,0040,1"``: direction, its quality, kind, speed
in 0.1 m/s, its quality; 999 and 9999 are missing, and a gust is in ``OC1 = "0098,1"`` (Federal
Climate Complex Data Documentation for ISD, 2018).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

from tree_sway.files.cell_table import cell_at, numbered, NumberedRow, table_of_lines
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import split_row, TextTable

_COLUMNS = 'time wind_speed wind_direction gust'.split()
_UNITS = ('', '0.1 m/s', 'deg', '0.1 m/s')
_CALM = 'C'
_WRONG = ('3', '7')
"""Qualities of an erroneous value."""


def _has_wnd(lines: Sequence[str]) -> bool:
    names = lines[0].replace('"', '').split(',')
    return {'STATION', 'DATE', 'WND'} <= set(names)


def _read(lines: list[str], source: str) -> TextTable:
    return table_of_lines(_COLUMNS, _rows(lines), source, _UNITS)


def _rows(lines: Sequence[str]) -> Iterator[NumberedRow]:
    names = list(split_row(lines[0], ','))
    date = names.index('DATE')
    wind = names.index('WND')
    gust = names.index('OC1') if 'OC1' in names else None
    for number, line in numbered(lines, 1):
        cells = split_row(line, ',')
        if len(cells) > max(date, wind):
            speed, direction = _wind(cells[wind])
            gust_speed, _, _ = cell_at(cells, gust).partition(',')
            yield number, [cells[date], speed, direction, _known(gust_speed, '9999')]


def _wind(cell: str) -> tuple[str, str]:
    """Speed and direction of the five fields of a wind; empty where missing or wrong."""
    fields = map(str.strip, [*cell.split(','), *4 * ['']])
    direction, good_direction, kind, speed, good_speed = islice(fields, 5)
    if good_speed in _WRONG:
        return '', ''
    if kind == _CALM:
        return '0', '0'
    at = '' if good_direction in _WRONG else _known(direction, '999')
    return _known(speed, '9999'), at


def _known(text: str, missing: str) -> str:
    return '' if text == missing else text


ISD_CSV = Layout('isd', _has_wnd, _read)
