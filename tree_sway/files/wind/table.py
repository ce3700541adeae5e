# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind in a table: CSV with a header, and the TOA5 of Campbell Scientific's loggers.

Rows 20 s and more apart are means of a station or of a reanalysis: turbulence is added to them, by
the column of gusts if there is one (`filled_means`). Lines before the header are ignored, as
weather services put the place there.

A time column (``time``, ``t``, ``timestamp``, ``stamp`` ...) in seconds or as ISO 8601 dates, and
either components ``u, v`` and perhaps ``w`` (or ``x, y, z``), or ``speed`` and ``direction`` in
degrees clockwise from north. A unit may follow the name: ``speed [km/h]``, ``u (m/s)``,
``time_ms``, ``direction_deg``. Components point where the wind blows to, a direction is where it
comes from, as is usual; ``direction_convention`` changes that.

TOA5 has four header lines: the logger, the names, units and processing. The components of a sonic,
``Ux Uy Uz``, point where the wind blows, in the axes of the instrument (CSAT3 manual, 2.3);
``yaw`` rotates them to east and north. Diagnostic words differ between instruments and are not
read. A row that is not numbers is refused.
"""

from __future__ import annotations

from array import array
from functools import partial
from math import pi
from pathlib import Path
import re

import numpy as np

from tree_sway.core.wind.convention import WindConvention
from tree_sway.files.table_file import Column, COLUMNS, parse_table, split_row, TextTable
from tree_sway.files.text_file import read_lines
from tree_sway.files.wind.record import WindRecord, WindRows
from tree_sway.files.wind.station_means import filled_means

_TIMES = '|'.join(COLUMNS['time']['names'])
_CLOCK = re.compile(rf'(?i)(^|[,;\t])\s*"?({_TIMES})\b[^\n]*[,;\t]')
LOOKS_LIKE_WIND = rf'(?i)^(?!#)([^\n]*[,;\t])?\s*"?({_TIMES})\b[^\n]*[,;\t]'
"""Names in the header of a table of wind."""
_LOGGER = re.compile(r'(\d{4})(\d\d)(\d\d)(\d\d)(\d\d)?', re.ASCII)


def read_table_wind(
    path: Path,
    columns: tuple[str, ...] | None = None,
    direction_convention: str | None = None,
    yaw: float = 0.0,
    turbulence: bool = True,
    seed: float = 0,
) -> WindRecord:
    """
    Read the wind of a table, given as components (``to``) or as a direction (``from``).

    ``columns`` are the two or three of the components, found by their usual names if None. ``yaw``
    is from east to the sensor's x axis, counter-clockwise, in [rad]; for a direction, from north
    to the sensor's zero, likewise. Means get ``turbulence`` of a ``seed``. A `FormatError` reports
    a missing column, an unknown unit, or no good row.
    """
    WindConvention(direction_convention or 'to')  # refused before the file is read
    lines = read_lines(path)
    if lines[0].lstrip('"').startswith('TOA5') and len(lines) > 3:
        table = _toa5(lines, str(path))
    else:
        first = next((i for i, line in enumerate(lines[:40]) if _CLOCK.search(line)), 0)
        lines[:first] = [''] * first
        table = parse_table(lines, str(path))
    chosen = None if columns is None else [table.index_of(name) for name in columns]
    return _wind(table, direction_convention, yaw, chosen, turbulence, seed)


def _toa5(lines: list[str], source: str) -> TextTable:
    """Table below the four header lines of a logger."""
    split = partial(split_row, separator=',')
    stored = [number for number, line in enumerate(lines[4:], start=5) if line.strip()]
    texts = [lines[number - 1] for number in stored]
    names, units = tuple(split(lines[1])), tuple(split(lines[2]))
    return TextTable(names, stored, texts, split, source, 2, 3, units)


def _wind(
    table: TextTable,
    convention: str | None,
    yaw: float,
    chosen: list[int] | None,
    turbulence: bool,
    seed: float,
) -> WindRecord:
    """Wind of a table, from the chosen columns or those of the usual names."""
    clock = table.find('time')
    if chosen is None:
        found = [table.find(each) for each in ('wind_x', 'wind_y', 'wind_z')]
    else:
        found = [Column(index, table.factor(index, 'speed')) for index in chosen]
    has_components = found[0] is not None and found[1] is not None
    if not has_components:
        found = [table.find('wind_speed'), table.find('wind_direction')]
    if clock is None or None in found[:2]:
        names = ', '.join(table.columns[:20])
        what = f'no time with u and v, or with speed and direction, among {names}'
        cure = (
            'use these names in the header, or give those of the components: '
            '--wind-option columns=u,v'
        )
        raise table.error(what, cure=cure)
    columns = [column for column in found if column is not None]
    indices = [column.index for column in columns]
    values = table.values(indices) * [column.factor for column in columns]
    rows = WindRows(table.source)
    good = np.isfinite(values).all(axis=1)
    for row in np.flatnonzero(~good).tolist():
        rows.refuse(table.numbers[row], table.why_none(row, indices))
    if has_components:
        velocity = np.zeros((len(values), 3))
        velocity[:, : values.shape[1]] = values
    else:
        speed, bearing = values[:, 0], values[:, 1] - yaw
        for row in np.flatnonzero(good & (speed < 0.0)).tolist():
            rows.refuse(table.numbers[row], f'speed is {speed[row]:g}')
        good &= speed >= 0.0
        for row in np.flatnonzero(good & (np.abs(values[:, 1]) > 7.0)).tolist():
            rows.refuse(
                table.numbers[row], f'direction is {values[row, 1] * 180.0 / pi:g} degrees'
            )
        good &= np.abs(values[:, 1]) <= 7.0
        against = 1.0 if convention == 'to' else -1.0
        velocity = against * (speed * np.array([np.sin(bearing), np.cos(bearing), 0.0 * speed])).T
        convention, yaw = 'to', 0.0
    stored = np.flatnonzero(good)
    seconds, epoch = table.seconds(_stamps(table, clock, stored.tolist()), clock.factor)
    rows.number = array('q', [table.numbers[row] for row in stored.tolist()])
    rows.velocity, rows.time = array('d', velocity[stored].ravel()), array('d', seconds)
    gust = table.find('gust')
    if gust is not None:
        rows.gust = table.values([gust.index])[stored, 0] * gust.factor
    record = rows.record(epoch=epoch, yaw=yaw, direction_convention=convention or 'to')
    return filled_means(record, turbulence, seed)


def _stamps(table: TextTable, clock: Column, rows: list[int]) -> list[str]:
    """Return times as texts, loggers' dates as ISO 8601, with the time of a second column."""
    stamps = table.cells(clock.index, rows)
    names = [heading for heading, _ in table.headings]
    if names[clock.index] in ('date', 'time') and {'date', 'time'} <= set(names):
        both = (table.cells(names.index(each), rows) for each in ('date', 'time'))
        return [f'{date} {time}' for date, time in zip(*both, strict=True)]
    if names[clock.index] != 'mess_datum':
        return stamps
    parts = (_LOGGER.fullmatch(stamp) for stamp in stamps)
    return ['{}-{}-{}T{}:{}'.format(*each.groups('00')) if each else '' for each in parts]
