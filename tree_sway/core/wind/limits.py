# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How fast wind can be: the one limit of all doors that wind comes in by."""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import three_numbers

FASTEST_WIND = 150.0
"""Speed in [m/s] above which nothing is wind; the record gust is 113 m/s (Courtney et al.
2012)."""


def is_wind(x: float, y: float, z: float, limit: float = FASTEST_WIND) -> bool:
    """Whether a vector in [m/s] is finite and no faster than a limit."""
    return math.hypot(x, y, z) <= limit


def components_of(wind: ArrayLike) -> tuple[float, float, float]:
    """
    Return the components of a wind, (3,), quickly, as every step asks for them.

    Raises
    ------
    ParameterError
        Anything but three numbers.

    """
    try:
        if not isinstance(wind, str | bytes):
            x, y, z = wind  # type: ignore[misc, union-attr]
            return float(x), float(y), float(z)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        pass
    return three_numbers('wind', wind)


def take_wind(kept: Floats, wind: ArrayLike, limit: float) -> bool:
    """
    Keep a wind [m/s], (3,), if it is one: the way in to every simulator.

    Returns False if it is not finite or faster than the limit [m/s]; what was kept stays then.
    """
    x, y, z = components_of(wind)
    if not math.hypot(x, y, z) <= limit:
        return False
    kept[0], kept[1], kept[2] = x, y, z
    return True
