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

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
import re

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import folded, SENDERS
from tree_sway.files.table_file import TextTable

_COLUMNS = (
    ('_time', '_field', '_value'),
    ('last_changed', 'entity_id', 'state'),
    ('date', 'parameter', 'value'),
    ('createdAt', 'phenomenon', 'value'),
    ('observed', 'parameterId', 'value'),
    ('DT', 'ELEMENT', 'VAL'),
)
"""Columns of the time, the name and the value; one called ``unit`` may be beside them."""
LONG_NAMES = frozenset(chain.from_iterable(_COLUMNS))
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


def widened(table: TextTable) -> TextTable:
    """Return the wide table of a long one, which may be of one instrument only; others stay."""
    names = [name.rpartition('.')[2] for name in table.columns]
    wanted = next((each for each in _COLUMNS if {*each} <= {*names}), None)
    if wanted is None:
        return table
    units: dict[str, str] = {}
    values = _values(table, names, wanted, units)
    return wide_table(values, table.source, wanted[0], units)


def _values(
    table: TextTable, names: list[str], wanted: tuple[str, ...], units: dict[str, str]
) -> Iterator[Value]:
    """Yield the values of a long table, and note the units of their names."""
    senders = [name for name in names if folded(name) in SENDERS[:-1]]
    sender_of: dict[str, str] = {}
    for line, text in zip(table.numbers, table.texts, strict=True):
        cells = table.split(text)
        # There is a header above each of several tables.
        if len(cells) < len(names) or {*wanted} <= {*cells} or text.startswith('#'):
            continue
        record = dict(zip(names, cells, strict=False))
        time, name, value = (record[each] for each in wanted)
        sender = ' '.join(record[each] for each in senders)
        first = sender_of.setdefault(name, sender)
        if sender != first:
            raise FormatError(
                f'rows of 2 instruments: {first}, {sender}',
                where=f'{table.source}:{line}',
                cure='write a table for each',
            )
        if value not in _NO_STATE:
            units.setdefault(name, record.get('unit', record.get('unit_of_measurement', '')))
            yield line, time, name, value
