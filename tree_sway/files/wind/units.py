# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Units and conventions that wind files come in, to m/s, blowing to, east, north, up."""

from __future__ import annotations

from math import pi, radians

Velocity = tuple[float, float, float]

SPEED_UNITS = {
    'm/s': 1.0, 'ms': 1.0, 'mps': 1.0, 'ms-1': 1.0, 'm s-1': 1.0, 'm s^-1': 1.0,
    'meters/second': 1.0, 'metres/second': 1.0, 'cm/s': 0.01,
    'km/h': 1.0 / 3.6, 'kmh': 1.0 / 3.6, 'kph': 1.0 / 3.6,
    'kn': 1852.0 / 3600.0, 'kt': 1852.0 / 3600.0, 'kts': 1852.0 / 3600.0,
    'knot': 1852.0 / 3600.0, 'knots': 1852.0 / 3600.0,
    'mph': 0.44704, 'miles/hour': 0.44704, 'ft/s': 0.3048,
}  # fmt: skip
"""Units of speed in [m/s]."""

TIME_UNITS = {'s': 1.0, 'sec': 1.0, 'seconds': 1.0, 'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9,
              'min': 60.0,
              'h': 3600.0}  # fmt: skip
"""Units of time in [s]."""

ANGLE_UNITS = {'deg': pi / 180.0, 'degrees': pi / 180.0, 'degree': pi / 180.0, '°': pi / 180.0,
               'degm': pi / 180.0, 'degt': pi / 180.0, 'rad': 1.0, 'radians': 1.0}  # fmt: skip
"""Units of angle in [rad]."""


def degrees_to_bearing(degrees: float) -> float | None:
    """Bearing in [rad] from degrees in [0, 360]; None if outside, as a sensor's error value is."""
    return radians(degrees) if 0.0 <= degrees <= 360.0 else None
