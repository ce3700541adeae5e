# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Numbers, units and directions as instruments write them."""

from __future__ import annotations

import math
from typing import Any

from tree_sway.files import finite, unit_factor
from tree_sway.files.wind import degrees_of, degrees_to_bearing

_CALM = 0.05
"""Speed [m/s] below which a direction may be missing."""
_LONGEST = 40
"""Length of the longest text that may be a number or a direction."""


def number(value: Any) -> float | None:
    """Return a value of JSON or a text as a finite number; None for any other."""
    if isinstance(value, str):
        return finite(value.strip()[:_LONGEST])
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        found = float(value)
    except OverflowError:
        return None
    return found if math.isfinite(found) else None


def speed_factor(unit: str) -> float | None:
    """Metres per second in one unit of speed; None for an unknown one."""
    return unit_factor('speed', unit)


def bearing_of(value: Any) -> float | None:
    """Bearing [rad] from degrees, or from a point of the compass such as NNW."""
    degrees = number(value)
    if degrees is None and isinstance(value, str) and value.strip():
        degrees = float(degrees_of([value.strip()[:_LONGEST]])[0])
    return None if degrees is None else degrees_to_bearing(degrees)


def is_calm(speed: float) -> bool:
    """Whether a speed [m/s] is so small that its direction does not matter."""
    return speed < _CALM
