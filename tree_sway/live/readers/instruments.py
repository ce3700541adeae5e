# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of instruments of one maker: `instruments.csv` has the form of each.

``line`` is a regular expression with the groups ``wind_speed``, maybe ``unit``, ``gust``,
``wind_direction`` and ``elevation`` in degrees, ``status``, of which all but zeros are bad, and
``checksum``, the exclusive or of ``body``. ``units`` are those that ``unit`` stands for; without
any, the speed is in the unit of the address. ``instant`` is the wind of an instant and no mean.
"""

from __future__ import annotations

import math
import re
from typing import Any

from tree_sway.files import finite, unit_factor
from tree_sway.files.wind import checksum_of, degrees_to_bearing
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.tables import table_beside

INSTRUMENTS = [
    {**each, 'line': re.compile(each['line'], re.ASCII)}
    for each in table_beside(__file__, 'instruments.csv')
]


def read_instrument(line: str, heading: float, factor: float) -> Reading | None:
    """
    Read a line of an instrument of the table; None for any other.

    Its directions count from a heading [rad]; a speed without a unit has so many m/s.
    """
    for each in INSTRUMENTS:
        if found := each['line'].fullmatch(line.strip()):
            return _reading(each, found.groupdict(), heading, factor)
    return None


def _reading(
    known: dict[str, Any], cells: dict[str, str | None], heading: float, factor: float
) -> Reading:
    kind = known['name']
    sent_sum = cells.get('checksum')
    if sent_sum and checksum_of(cells['body'] or '') != sent_sum.upper():
        return Refusal(kind, 'wrong checksum')
    status = cells.get('status') or ''
    if status.strip('0'):
        return Refusal(kind, f"status is '{status}', not 00")
    unit = cells.get('unit') or ''
    text = cells['wind_speed'] or ''
    if known['units']:
        units = dict(each.split('=') for each in known['units'].split())
        factor = unit_factor('speed', units.get(unit, '')) or math.nan
    number = finite(text)
    speed = math.nan if number is None else factor * number
    if not speed >= 0.0:
        return Refusal(kind, f"speed is '{text}{unit}'")
    direction = cells.get('wind_direction')
    degrees = finite(direction or '')
    bearing = None if degrees is None else degrees_to_bearing(degrees)
    if direction is not None and bearing is None:
        return Refusal(kind, f"direction is '{direction}'")
    rise = math.radians(float(cells.get('elevation') or 0.0))
    gust = finite(cells.get('gust') or '')
    return WindReading(
        kind,
        speed * math.cos(rise),
        None if bearing is None else bearing + heading,
        speed * math.sin(rise),
        None if gust is None else factor * gust,
        0.0 if known['instant'] else None,
    )
