# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of ASCII that Gill's sonic anemometers send.

WindSonic, WindObserver and WindMaster send ``<STX>Q,121,000.08,M,00,<ETX>hh`` with a direction, or
``<STX>Q,+000.12,-000.34,+000.05,M,...,00,<ETX>hh`` with components: U from south to north, V from
east to west, W up (WindSonic manual 1405-PS-0019, WindMaster manual 1561-PS-0001).

North is the instrument's marker, whose direction is the option ``heading``. A wrong checksum, a
status other than good, a value that is missing: the line is refused.
"""

from __future__ import annotations

from functools import partial
from math import pi
from pathlib import Path
import re

from tree_sway.core.wind import velocity_of_bearing
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.sensor_line import (
    degrees_to_bearing,
    line_of,
    read_sensor_log,
    SensorLine,
    STAMP,
    Velocity,
)

KINDS = ('gill',)
"""Kinds of lines."""

_UNITS = {'M': 1.0, 'N': 1852.0 / 3600.0, 'P': 0.44704, 'K': 1.0 / 3.6, 'F': 0.00508}
_GOOD = ('00', '60')
"""Gill's status: good, and good while heated."""
_CALM = 0.05
"""Speed below which a direction may be missing [m/s]."""
_GILL = re.compile(r'\x02?([A-Z],[^\x02\x03]*)(?:\x03(.*))?', re.ASCII | re.DOTALL)
_NUMBER = r'\d{1,9}(?:\.\d{0,9})?'
_FORM = re.compile(
    rf'[A-Z],(?:(?=(?P<signed>[-+]{_NUMBER},[-+]))|(?={_NUMBER},\d+\.|,\d+\.))'
    rf'(?P<first>[-+]?{_NUMBER}|),(?P<second>[-+]?{_NUMBER})(?:,(?P<up>[-+]{_NUMBER}))?,'
    r'(?P<unit>[MNPKF])(?:,(?!(?:[\dA-F]{2})(?:,|$))[^,]*)*(?:,(?P<status>[\dA-F]{2})(?:,.*)?)?',
    re.ASCII,
)
"""U and V with signs, or a direction and a speed with a point; maybe W; a unit; the status."""


def parse_sonic(line: str, heading: float = 0.0) -> SensorLine | None:
    """
    Parse a line of a sonic anemometer, with or without STX, ETX and checksum.

    The wind is of a kind of `KINDS`; any other line is None. ``heading`` is the direction of the
    instrument's north marker, clockwise from true north, in [rad].
    """
    stamp = STAMP.match(line)
    begin = len(line) - len(line[stamp.end() if stamp else 0 :].lstrip(' ,;\t'))
    begin = max(begin, line.rfind('\x02'))
    gill = _GILL.match(line, begin)
    if gill is None:
        return None
    body = gill[1]
    checksum = (gill[2] or '').strip().upper()[:2] or None
    # The examples of one manual (WindSonic) leave ETX out, those of another (WindObserver) not.
    bodies = [body, f'{body}\x03']
    return line_of(KINDS[0], len(line), checksum, bodies, partial(_gill, body, heading))


def read_sonic_wind(path: Path, rate: float = 10.0, heading: float = 0.0) -> WindRecord:
    """
    Read the wind of a log of a sonic anemometer's lines of equal spacing, ``rate`` in [Hz].

    Raises
    ------
    FormatError
        If there is no such line, or no good one.
    ParameterError
        If an option has a wrong value.

    """
    north = f'the north marker is taken to point to {heading * 180.0 / pi:g} degrees'
    return read_sensor_log(path, partial(parse_sonic, heading=heading), KINDS, rate, [north])[1]


def _gill(body: str, heading: float) -> Velocity | str:
    found = _FORM.fullmatch(re.sub(r'\s*,\s*', ',', body))
    if found is None:
        return f'neither components nor a direction, a speed and a unit: {body[:30]}'
    if found['status'] not in _GOOD:
        return f"status is '{found['status'] or ''}', not 00"
    unit = _UNITS[found['unit']]
    u, v, w = (unit * float(found[each] or 0.0) for each in ('first', 'second', 'up'))
    if found['signed']:
        x, y, _ = velocity_of_bearing(u, heading, 'to')
        left_x, left_y, _ = velocity_of_bearing(v, heading - 0.5 * pi, 'to')
        return x + left_x, y + left_y, w
    bearing = degrees_to_bearing(u / unit)
    if bearing is None or (not found['first'] and v >= _CALM):
        return f"direction '{found['first'][:8]}'"
    x, y, _ = velocity_of_bearing(v, bearing + heading)
    return x, y, w
