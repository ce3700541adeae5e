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
from tree_sway.files.wind import checksum_of
from tree_sway.live.readers.values import reading_of
from tree_sway.live.reading import Reading, Refusal
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
        known_unit = unit_factor('speed', units.get(unit, ''))
        text += unit if known_unit is None else ''
        factor = known_unit or 0.0
    gust = finite(cells.get('gust') or '')
    return reading_of(
        kind,
        text,
        cells.get('wind_direction'),
        factor=factor,
        turn=heading,
        rise=math.radians(float(cells.get('elevation') or 0.0)),
        gust=None if gust is None else factor * gust,
        interval=0.0 if known['instant'] else None,
    )
