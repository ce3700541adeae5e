# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of ASCII that sonic anemometers send: Gill's and TriSonica's.

- Gill (WindSonic, WindObserver, WindMaster): ``<STX>Q,121,000.08,M,00,<ETX>hh`` with a direction,
  or ``<STX>Q,+000.12,-000.34,+000.05,M,...,00,<ETX>hh`` with components: U from south to north, V
  from east to west, W up (WindSonic manual 1405-PS-0019, WindMaster manual 1561-PS-0001).
- TriSonica: names and values in turn, ``S 2.5 D 270 U -2.5 V 0.0 W 0.1 T 21.3``. The direction D,
  where the wind comes from, gives the sense; U and V only their size (TriSonica Mini manual).

North is the instrument's marker: option ``heading`` says where that points. A wrong checksum, a
status other than good, a value that is missing: the line is refused.
"""

from __future__ import annotations

from functools import partial
from math import hypot, pi, sqrt
from pathlib import Path
import re

from tree_sway.core.wind.convention import velocity_of_bearing
from tree_sway.files.text_file import finite
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.sensor_line import line_of, MAX_LINE, read_sensor_log, SensorLine
from tree_sway.files.wind.units import degrees_to_bearing, Velocity

KINDS = ('gill', 'trisonica')
"""Kinds of lines."""

_UNITS = {'M': 1.0, 'N': 1852.0 / 3600.0, 'P': 0.44704, 'K': 1.0 / 3.6, 'F': 0.00508}
_GOOD = ('00', '60')
"""Gill's status: good, and good while heated."""
_CALM = 0.05
"""Below this a direction may be missing [m/s]."""
_GILL = re.compile(r'\x02?([A-Z],[^\x02\x03]*)(?:\x03(.*))?', re.ASCII | re.DOTALL)
_STATUS = re.compile(r'[0-9A-F]{2}', re.ASCII)


def parse_sonic(line: str, heading: float = 0.0) -> SensorLine | None:
    """
    Parse a line of a sonic anemometer, with or without STX, ETX and what follows it.

    The wind is of a kind of `KINDS`; any other line is None. ``heading`` is where the instrument's
    north marker points, clockwise from true north, in [rad].
    """
    begin = line.rfind('\x02') if '\x02' in line else len(line) - len(line.lstrip())
    gill = _GILL.match(line, begin)
    if gill is not None:
        body, readings = gill[1], (gill[2] or '').strip().upper()[:2] or None
        # The examples of one manual (WindSonic) leave ETX out, those of another (WindObserver)
        # not.
        bodies = [body, f'{body}\x03']
        read = partial(_gill, [field.strip() for field in body.split(',')], heading)
        return line_of(KINDS[0], len(line), readings, bodies, read)
    words = line[: MAX_LINE + 1].replace(',', ' ').split()
    if len(words) < 4 or words[0] not in ('S', 'S2', 'D', 'U'):
        return None
    read = partial(_trisonica, words, heading)
    return line_of(KINDS[1], len(line), None, (), read)


def read_sonic_wind(path: Path, rate: float = 10.0, heading: float = 0.0) -> WindRecord:
    """
    Read the wind of a log of a sonic anemometer's lines, taken as evenly spaced, ``rate`` in [Hz].

    Raises
    ------
    FormatError
        If there is no such line, or no good one.
    ParameterError
        If an option is not what it can be.

    """
    north = f'the north marker is taken to point to {heading * 180.0 / pi:g} degrees'
    return read_sensor_log(path, partial(parse_sonic, heading=heading), KINDS, rate, [north])[1]


def _gill(fields: list[str], heading: float) -> Velocity | str:
    place = next((i for i, field in enumerate(fields[2:5], start=2) if field in _UNITS), None)
    if place is None:
        return 'no unit of M, N, P, K or F'
    status = next((f for f in fields[place + 1 :] if _STATUS.fullmatch(f)), '')
    if status not in _GOOD:
        return f"status is '{status}', not 00"
    texts, unit = fields[1:place], _UNITS[fields[place]]
    values = [finite(text) for text in texts]
    signed = [text[:1] in ('+', '-') for text in texts]
    if len(values) >= 2 and None not in values and all(signed):
        u, v, w = (unit * (value or 0.0) for value in (*values, 0.0)[:3])
        x, y, _ = velocity_of_bearing(u, heading, 'to')
        left_x, left_y, _ = velocity_of_bearing(v, heading - 0.5 * pi, 'to')
        return x + left_x, y + left_y, w
    if len(values) < 2 or '.' not in texts[1] or signed[0]:
        return f'neither components nor a direction: {",".join(texts)[:30]}'
    speed, up = values[1], values[2] if len(values) > 2 else 0.0
    bearing = degrees_to_bearing(values[0]) if values[0] is not None else None
    if speed is None or up is None or speed < 0.0:
        return f"speed '{texts[1][:8]}'"
    if bearing is None:
        if texts[0] or speed * unit >= _CALM:
            return f"direction '{texts[0][:8]}'"
        bearing = 0.0
    x, y, _ = velocity_of_bearing(unit * speed, bearing + heading)
    return x, y, unit * up


def _trisonica(words: list[str], heading: float) -> Velocity | str:
    readings = dict(zip(words[::2], map(finite, words[1::2]), strict=False))
    for name in ('S', 'S2', 'D', 'U', 'V', 'W'):
        if name in readings and readings[name] is None:
            return f'{name} is no number'
    direction, up = readings.get('D'), readings.get('W') or 0.0
    bearing = None if direction is None else degrees_to_bearing(direction)
    if bearing is None:
        return 'no direction D' if direction is None else f'direction {direction:g}'
    u, v, level, speed = (readings.get(name) for name in ('U', 'V', 'S2', 'S'))
    if any(value is not None and value < 0.0 for value in (level, speed)):
        return 'a speed below 0'
    if level is None and u is not None and v is not None:
        level = hypot(u, v)
    if level is None and speed is not None:
        level = sqrt(max(speed * speed - up * up, 0.0))
    if level is None:
        return 'no speed S, S2, or U and V'
    if speed is not None and abs(hypot(level, up) - speed) > 0.5 + 0.2 * speed:
        return f'components of {hypot(level, up):.3g} m/s at a speed of {speed:g}'
    x, y, _ = velocity_of_bearing(level, bearing + heading)
    return x, y, up
