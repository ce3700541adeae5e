# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Long tables: a row per value, with the name of its quantity in a cell.

InfluxDB's annotated CSV has ``_time``, ``_value`` and ``_field`` below lines with a hash (docs of
InfluxDB, Annotated CSV); Home Assistant's history has ``entity_id,state,last_changed``. Each value
holds until the next of its name, as Home Assistant stores changes alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import chain
import re

from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import split_row, TextTable

_COLUMNS = {
    'influxdb': ('_time', '_field', '_value'),
    'home assistant': ('last_changed', 'entity_id', 'state'),
}
"""Columns of the time, the name and the value."""
_STATION = re.compile(r'(?:sensor\.)?(?:.*_)?(?=(?:avg_)?wind|gust)')
_NO_STATE = ('unavailable', 'unknown', '')
Value = tuple[int, str, str, str]
"""Line, time, name and value."""


def wide_table(
    values: Iterable[Value], source: str, clock: str, unit_of: Mapping[str, str] | None = None
) -> TextTable:
    """
    Return a row for each time, in the column ``clock``, with the newest value of each name.

    ``unit_of`` are the units of some names.
    """
    by_time: dict[str, dict[str, str]] = {}
    lines: dict[str, int] = {}
    for line, time, name, value in values:
        by_time.setdefault(time, {})[name] = value
        lines.setdefault(time, line)
    names = list(dict.fromkeys(chain.from_iterable(by_time.values())))
    newest = dict.fromkeys(names, '')
    rows = []
    for time in sorted(by_time):
        newest |= by_time[time]
        rows.append([time, *newest.values()])
    # sensor.garden_wind_speed is wind_speed, if no other sensor is called so.
    short = [_STATION.sub('', name, count=1) for name in names]
    is_clear = len(set(short)) == len(short)
    columns = short if is_clear else names
    numbers = [lines[time] for time in sorted(by_time)]
    units = [(unit_of or {}).get(name, '') for name in names]
    return table_of_cells([clock, *columns], rows, source, numbers, ['', *units])


def _read(lines: list[str], source: str, wanted: Sequence[str]) -> TextTable:
    return wide_table(_values(lines, wanted), source, wanted[0])


def _values(lines: list[str], wanted: Sequence[str]) -> Iterable[Value]:
    places = list[int]()
    for number, line in enumerate(lines, start=1):
        cells = split_row(line, ',')
        if _is_header(line, wanted):  # there is one above each of several tables
            places = [list(cells).index(name) for name in wanted]
        elif places and not line.startswith('#') and len(cells) > max(places):
            time, name, value = (cells[place] for place in places)
            if value not in _NO_STATE:
                yield number, time, name, value


def _is_header(line: str, wanted: Sequence[str]) -> bool:
    return not line.startswith('#') and set(wanted) <= set(split_row(line, ','))


def _is_long(lines: Sequence[str], wanted: Sequence[str]) -> bool:
    return any(_is_header(line, wanted) for line in lines[:10])


LONG = tuple(
    Layout(name, partial(_is_long, wanted=wanted), partial(_read, wanted=wanted))
    for name, wanted in _COLUMNS.items()
)
