# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Long tables: a row per value, with the name of its quantity in a cell.

InfluxDB's annotated CSV has ``_time``, ``_value`` and ``_field`` below lines with a hash (docs of
InfluxDB, Annotated CSV); Home Assistant's history has ``entity_id,state,last_changed``; those of
wetterdienst, openSenseMap and DMI have the instrument of each value too. The column of the names
is that whose cells are most quantities of the wind; units are in a column called so, else in any,
as in the ``_measurement`` of Home Assistant in InfluxDB. Each value holds until the next of its
name, as Home Assistant stores changes alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf
from statistics import median
from typing import Any

from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import (
    CODES,
    folded,
    is_named,
    is_wind,
    STATION,
    unit_known,
    WIND,
)
from tree_sway.files.json_values import text_of
from tree_sway.files.row_times import time_columns
from tree_sway.files.table_file import TextTable
from tree_sway.files.time_stamps import times_of

_LOOKED_AT = 200
_TOGETHER = 0.1
"""Largest time between the values of a sample, in times between samples."""
_NO_STATE = ('unavailable', 'unknown', '')
Value = tuple[int, str, str, str]
"""Line, time, name and value."""


def wide_table(
    values: Iterable[Value], source: str, clock: str, unit_of: Mapping[str, str] | None = None
) -> TextTable:
    """
    Return a row for each time, in the column ``clock``, with the newest value of each name.

    Values of several names that are much less than a sample apart are of one time, the last.
    ``unit_of`` are the units of some names. Of several values of a name at a time the last is
    taken, and said.
    """
    by_time: dict[str, dict[str, str]] = {}
    several: dict[str, str] = {}
    lines: dict[str, int] = {}
    newest: dict[str, str] = {}
    for line, time, name, value in values:
        at_time = by_time.setdefault(time, {})
        if at_time.get(name, value) != value:
            several[name] = time
        at_time[name] = value
        lines.setdefault(time, line)
        newest[name] = ''
    names = list(newest)
    rows = []
    times = sorted(by_time)
    samples = [by_time[time] for time in times]
    for time, sample in zip(times, samples, strict=True):
        newest |= sample
        rows.append([time, *newest.values()])
    # sensor.garden_wind_speed is wind_speed, if no other sensor is called so.
    short = [STATION.sub('', name, count=1) for name in names]
    columns = short if len({*short}) == len(short) else names
    numbers = [lines[time] for time in times]
    units = [(unit_of or {}).get(name, '') for name in names]
    table = table_of_cells([clock, *columns], rows, source, numbers, ['', *units])
    timed = [*zip(times_of(times).seconds.tolist(), samples, strict=True)]
    own = ([second for second, sample in timed if name in sample] for name in names)
    steps = [then - now for seconds in own for now, then in pairwise(seconds)]
    apart = _TOGETHER * median(steps or [0.0])
    whole = [
        row
        for row, ((now, sample), (then, later)) in enumerate(pairwise([*timed, (inf, {})]))
        if not then - now < apart or sample.keys() & later.keys()
    ]
    return replace(table.part(whole), note=note_of_several(several))


def note_of_several(times: Mapping[str, str]) -> str:
    """Return a note of the names that have several values at a time, by their last times."""
    found = ', '.join(f'{name} at {time}' for name, time in times.items())
    return f'of several values the last is taken: {found}' if found else ''


def widened(table: TextTable) -> TextTable:
    """Return the wide table of a long one, which may be of one instrument only; others stay."""
    last = tuple(name.rpartition('.')[2] for name in table.columns)
    short = replace(table, columns=last)
    wanted = [short.find_all(each)[:1] for each in ('time', 'value')]
    first = table.rows[:_LOOKED_AT]
    columns = range(len(table.columns)) if all(wanted) else ()
    known = [
        (sum(is_wind(_name_of(table, each, cell)) for cell in {*table.cells(each, first)}), each)
        for each in columns
    ]
    most, name = max(known, default=(0, 0), key=lambda each: each[0])
    if not most or [name] in wanted or any(map(is_wind, table.columns)):
        return table
    units: dict[str, str] = {}
    clock, value = (each[0] for each in wanted)
    for rows in table.rows_by(name).values():
        short.part(rows).refuse_several()
    found = time_columns(table)
    parts, form = found[:2] if found and found[1] else ([clock], '{0}')  # a date may be apart
    values = _values(short, (*parts, name, value), form, units)
    return wide_table(values, table.source, table.columns[clock], units)


def unit_for(name: str, units: Mapping[str, Any]) -> str:
    """Return the unit of a name, or that of the quantity of the wind which it names."""
    quantities = [each for each in WIND if is_named(name, each)][:1]
    same = (units[each] for each in units if is_named(each, *quantities))
    return text_of(units.get(name)) or text_of(next(same, ''))


def _name_of(table: TextTable, column: int, cell: str) -> str:
    """Return the name of a quantity in a cell, which may be its code."""
    return CODES.get(table.columns[column], {}).get(cell, cell)


def _values(
    table: TextTable, wanted: Sequence[int], form: str, units: dict[str, str]
) -> Iterator[Value]:
    """Yield the values of a long table, whose times have a form, and note their units."""
    names = table.columns
    others = [i for i in range(len(names)) if i not in wanted]
    units_at = [i for i in others if folded(names[i]).startswith('unit')] or [
        i for i in others if any(unit_known('speed', cell) for cell in table.rows_by(i))
    ]
    for line, text in zip(table.numbers, table.texts, strict=True):
        cells = table.split(text)
        # There is a header above each of several tables.
        if len(cells) < len(names) or cells[wanted[-1]] == table.columns[wanted[-1]]:
            continue
        *clock, name, value = (cells[each] for each in wanted)
        time = form.format(*clock)
        name = _name_of(table, wanted[-2], name)
        if value not in _NO_STATE and is_wind(name):
            units.setdefault(name, cells[units_at[0]] if units_at else '')
            yield line, time, name, value
