# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of Vaisala's weather transmitters WXT and WMT52, in their own ASCII form.

``0R1,Dn=236D,Dm=283D,Dx=031D,Sn=0.0M,Sm=1.0M,Sx=2.2M``: directions in degrees and speeds, least,
mean and greatest; ``#`` in place of a unit is a failed measurement (Vaisala M211840EN, "Wind data
message"). Which of them are sent is set in the instrument: the mean is read if it is there.
"""

from __future__ import annotations

import re

from tree_sway.files import finite
from tree_sway.files.wind import degrees_to_bearing
from tree_sway.live.reading import LineFormat, Reading, Refusal, WindReading

KIND = 'Vaisala WXT'
_LINE = re.compile(r'\w[Rr][0135],')
_FIELD = re.compile(r'(D[nmx]|S[nmx])=([-\d.]*)([A-Z#])')
_UNITS = {'M': 1.0, 'K': 1.0 / 3.6, 'S': 0.44704, 'N': 1852.0 / 3600.0}


def read_wxt(line: str, heading: float, _factor: float) -> Reading | None:
    """Read a line; its directions count from the north mark, which points to a heading [rad]."""
    if not _LINE.match(line):
        return None
    fields = {name: (value, unit) for name, value, unit in _FIELD.findall(line)}
    chosen = 'm' if 'Sm' in fields else 'x'
    if f'S{chosen}' not in fields:
        return None
    text, unit = fields[f'S{chosen}']
    speed = finite(text)
    factor = _UNITS.get(unit)
    if speed is None or factor is None or speed < 0.0:
        return Refusal(KIND, f"speed is '{text}{unit}'")
    bearing = None
    if f'D{chosen}' in fields:
        text, unit = fields[f'D{chosen}']
        degrees = finite(text)
        bearing = None if degrees is None or unit != 'D' else degrees_to_bearing(degrees)
        if bearing is None:
            return Refusal(KIND, f"direction is '{text}{unit}'")
        bearing += heading
    most, most_unit = fields.get('Sx', ('', ''))
    gust = finite(most)
    gust_factor = _UNITS.get(most_unit)
    return WindReading(
        KIND,
        speed * factor,
        bearing,
        gust=gust * gust_factor if gust is not None and gust_factor is not None else None,
    )


LINES = LineFormat('Vaisala WXT', read_wxt)
