# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of R. M. Young's ultrasonic anemometers.

- 81000, as it leaves the factory: ``speed azimuth elevation speed-of-sound temperature``, in m/s
  and degrees, four times a second (manual 81000-90, "Initial checkout").
- 85000, 86000 and 91000 in polar ASCII: ``a www.w ddd ss*cc``, the address, speed, direction,
  status and the exclusive or of all characters before the asterisk (manual 85000-90, 5.3.2). The
  unit of the speed is set in the instrument; m/s is assumed unless ``unit`` says otherwise.
"""

from __future__ import annotations

import math
import re

from tree_sway.files import finite
from tree_sway.files.wind import checksum_of, degrees_to_bearing
from tree_sway.live.reading import LineFormat, Reading, Refusal, WindReading

KIND_81000 = 'Young 81000'
KIND_85000 = 'Young 85000'
_POLAR = re.compile(r'(\w) +(\d+\.\d+) +(\d{1,3}(?:\.\d)?) +(\w\w)\*([0-9A-Fa-f]{2})')
_SOUND = (300.0, 360.0)
"""Speeds of sound that the instrument reports [m/s]."""
_STEEPEST = 90.0


def read_young(line: str, heading: float, factor: float) -> Reading | None:
    """Read a line; its directions count from a heading [rad], its unit has so many m/s."""
    text = line.strip()
    polar = _POLAR.fullmatch(text)
    if polar is not None:
        return _polar(text, polar, heading, factor)
    values = [finite(cell) for cell in text.split()]
    if len(values) != 5 or None in values:
        return None
    speed, azimuth, elevation, sound, _ = (value or 0.0 for value in values)
    if not (_SOUND[0] <= sound <= _SOUND[1] and abs(elevation) <= _STEEPEST):
        return None
    bearing = degrees_to_bearing(azimuth)
    if bearing is None or speed < 0.0:
        return Refusal(KIND_81000, f'speed is {speed:g}, azimuth {azimuth:g}')
    rise = math.radians(elevation)
    level = speed * math.cos(rise)
    up = speed * math.sin(rise)
    return WindReading(KIND_81000, level, bearing + heading, up, interval=0.0)


def _polar(text: str, found: re.Match[str], heading: float, factor: float) -> Reading:
    _, speed, direction, status, sent_sum = found.groups()
    if checksum_of(text.partition('*')[0]) != sent_sum.upper():
        return Refusal(KIND_85000, 'wrong checksum')
    if status.strip('0'):
        return Refusal(KIND_85000, f"status is '{status}', not 00")
    bearing = degrees_to_bearing(float(direction))
    if bearing is None:
        return Refusal(KIND_85000, f'direction is {direction}')
    return WindReading(KIND_85000, factor * float(speed), bearing + heading, interval=0.0)


LINES = LineFormat('Young', read_young)
