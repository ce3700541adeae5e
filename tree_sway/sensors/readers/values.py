# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Numbers, units and compass points as instruments write them."""

from __future__ import annotations

import math
from typing import Any

from tree_sway.files.table_file import UNITS
from tree_sway.files.text_file import finite
from tree_sway.files.wind.units import degrees_to_bearing

_POINTS = 'N NNE NE ENE E ESE SE SSE S SSW SW WSW W WNW NW NNW'.split()
_CALM = 0.05
"""Speed [m/s] below which a direction may be missing."""


def number(value: Any) -> float | None:
    """Return a value of JSON or a text as a finite number; None for any other."""
    if isinstance(value, str):
        return finite(value.strip()[:40])
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        found = float(value)
    except OverflowError:
        return None
    return found if math.isfinite(found) else None


def speed_factor(unit: str) -> float | None:
    """Metres per second in one unit of speed; None for an unknown one."""
    return UNITS['speed'].get(unit.strip().lower())


def bearing_of(value: Any) -> float | None:
    """Bearing [rad] from degrees, or from a point of the compass such as NNW."""
    if isinstance(value, str) and value.strip().upper() in _POINTS:
        return math.tau / 16.0 * _POINTS.index(value.strip().upper())
    degrees = number(value)
    return None if degrees is None else degrees_to_bearing(degrees)


def is_calm(speed: float) -> bool:
    """Whether a speed [m/s] is so small that its direction does not matter."""
    return speed < _CALM
