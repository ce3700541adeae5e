# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Long tables: a row per value, with the name of its quantity in a cell.

InfluxDB's annotated CSV has ``_time``, ``_value`` and ``_field`` below lines with a hash (docs of
InfluxDB, Annotated CSV); Home Assistant's history has ``entity_id,state,last_changed``; those of
wetterdienst, openSenseMap and DMI have the instrument of each value too. Each value holds until
the next of its name, as Home Assistant stores changes alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache, partial
from itertools import chain
import re

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import folded, SENDERS
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import split_row, TextTable

_COLUMNS = {
    'influxdb': ('_time', '_field', '_value'),
    'home assistant': ('last_changed', 'entity_id', 'state'),
    'wetterdienst': ('date', 'parameter', 'value'),
    'openSenseMap': ('createdAt', 'phenomenon', 'value'),
    'DMI': ('observed', 'parameterId', 'value'),
    'CHMI': ('DT', 'ELEMENT', 'VAL'),
}
"""Columns of the time, the name and the value; one called ``unit`` may be beside them."""
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


def long_table(
    records: Iterable[tuple[int, Mapping[str, str]]], wanted: Sequence[str], source: str
) -> TextTable:
    """Return the wide table of numbered records; a `FormatError` for several instruments."""
    units: dict[str, str] = {}
    return wide_table(_values(records, wanted, source, units), source, wanted[0], units)


def _values(
    records: Iterable[tuple[int, Mapping[str, str]]],
    wanted: Sequence[str],
    source: str,
    units: dict[str, str],
) -> Iterator[Value]:
    """Yield the values of records, and note the units of their names."""
    sender_of: dict[str, str] = {}
    for line, record in records:
        time, name, value = (record[each] for each in wanted)
        sender = ' '.join(each for key, each in record.items() if _is_sender(key))
        first = sender_of.setdefault(name, sender)
        if sender != first:
            raise FormatError(
                f'rows of 2 instruments: {first}, {sender}',
                where=f'{source}:{line}',
                cure='write a table for each',
            )
        if value not in _NO_STATE:
            units.setdefault(name, record.get('unit', record.get('unit_of_measurement', '')))
            yield line, time, name, value


@lru_cache(256)
def _is_sender(name: str) -> bool:
    return folded(name) in SENDERS[:-1]


def long_columns(names: Iterable[str]) -> tuple[str, ...] | None:
    """Columns of the time, the name and the value of a long table; None for another one."""
    there = set(names)
    return next((wanted for wanted in _COLUMNS.values() if there >= set(wanted)), None)


def _records(lines: list[str], wanted: Sequence[str]) -> Iterator[tuple[int, dict[str, str]]]:
    header: Sequence[str] = ()
    for number, line in enumerate(lines, start=1):
        cells = split_row(line, ',')
        if _is_header(line, wanted):  # there is one above each of several tables
            header = cells
        elif header and not line.startswith('#') and len(cells) >= len(header):
            yield number, dict(zip(header, cells, strict=False))


def _read(lines: list[str], source: str, wanted: Sequence[str]) -> TextTable:
    return long_table(_records(lines, wanted), wanted, source)


def _is_header(line: str, wanted: Sequence[str]) -> bool:
    return not line.startswith('#') and set(wanted) <= set(split_row(line, ','))


def _is_long(lines: Sequence[str], wanted: Sequence[str]) -> bool:
    return any(_is_header(line, wanted) for line in lines[:10])


LONG = tuple(
    Layout(name, partial(_is_long, wanted=wanted), partial(_read, wanted=wanted))
    for name, wanted in _COLUMNS.items()
)
