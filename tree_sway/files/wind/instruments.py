# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of instruments of one maker: `instruments.csv` has the form of each.

``line`` is a regular expression with the groups ``wind_speed``, maybe ``unit``, ``gust``,
``wind_direction`` and ``elevation`` in degrees; or of the components ``u``, ``v`` and maybe ``w``,
of which the first two point to the two ``axes``, in degrees from the instrument's north. Its
``status`` is of the form ``good``, its ``checksum`` is the exclusive or of ``body``. ``units`` are
those that ``unit`` stands for; without any, the speed is in the unit of the address. ``instant``
is the wind of an instant and no mean; ``logged`` lines are read from files as well.
"""

from __future__ import annotations

from cmath import rect
from functools import partial
import math
from pathlib import Path
import re
from typing import Any

from tree_sway.files.column_names import unit_factor
from tree_sway.files.text_file import finite
from tree_sway.files.wind.reading import of_velocity, Reading, Refusal
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.sensor_line import read_sensor_log, STAMP, why_broken
from tree_sway.files.wind.values import reading_of
from tree_sway.tables import table_beside

INSTRUMENTS = [
    {**each, 'line': re.compile(each['line'], re.ASCII | re.DOTALL)}
    for each in table_beside(__file__, 'instruments.csv')
]
LOGGED = tuple(dict.fromkeys(each['name'] for each in INSTRUMENTS if each['logged']))
"""Instruments whose lines are read from files."""


def read_instrument(line: str, heading: float = 0.0, factor: float = 1.0) -> Reading | None:
    """
    Read a line of an instrument of the table, maybe behind a time; None for any other.

    Its directions count from a heading [rad]; a speed without a unit has so many m/s.
    """
    stamp = STAMP.match(line)
    begin = max(stamp.end() if stamp else 0, line.rfind('\x02'))
    parts = line[begin:].strip(' ,;\t\r\n').split(',')
    text = ','.join(map(str.strip, parts))
    for each in INSTRUMENTS:
        if found := each['line'].fullmatch(text):
            return _reading(each, found.groupdict(), heading, factor, len(line))
    return None


def is_logged(head: str) -> bool:
    """Whether a line at the beginning of a file is that of an instrument that is logged."""
    found = map(read_instrument, head.splitlines()[:_LOOKED_AT])
    return any(each is not None and each.kind in LOGGED for each in found)


_LOOKED_AT = 50


def read_instrument_wind(path: Path, rate: float = 10.0, heading: float = 0.0) -> WindRecord:
    """
    Read the wind of a log of an instrument's lines of equal spacing, ``rate`` in [Hz].

    Raises
    ------
    FormatError
        If there is no such line, or no good one.
    ParameterError
        If an option has a wrong value.

    """
    north = f'the north marker is taken to point to {math.degrees(heading):g} degrees'
    read = partial(read_instrument, heading=heading)
    return read_sensor_log(path, read, LOGGED, rate, [north])[1]


def _reading(
    known: dict[str, Any], cells: dict[str, str | None], heading: float, factor: float, length: int
) -> Reading:
    kind = known['name']
    if why := why_broken(length, cells.get('checksum'), cells.get('body') or ''):
        return Refusal(kind, why)
    status = cells.get('status') or ''
    if known['good'] and re.fullmatch(known['good'], status) is None and 'wind_speed' in cells:
        return Refusal(kind, f"status is '{status}', not 00")
    unit = cells.get('unit') or ''
    text = cells.get('wind_speed') or ''
    if known['units']:
        units = dict(each.split('=') for each in known['units'].split())
        known_unit = unit_factor('speed', units.get(unit, ''))
        text += unit if known_unit is None else ''
        factor = known_unit or 0.0
    told = {name: finite(cells.get(name) or '') for name in ('u', 'v', 'w', 'gust')}
    sizes = {name: factor * size for name, size in told.items() if size is not None}
    if 'u' in sizes:
        axes = zip((sizes['u'], sizes['v']), known['axes'], strict=True)
        flow = sum(rect(size, heading + math.radians(axis)) for size, axis in axes)
        return of_velocity(kind, (flow.imag, flow.real, sizes.get('w', 0.0)))
    return reading_of(
        kind,
        text,
        cells.get('wind_direction'),
        factor=factor,
        turn=heading,
        rise=math.radians(float(cells.get('elevation') or 0.0)),
        up=sizes.get('w'),
        gust=sizes.get('gust'),
        interval=0.0 if known['instant'] else None,
    )
