# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Largest speed of wind, for all sources."""

from __future__ import annotations

import math

FASTEST_WIND = 150.0
"""Speed in [m/s] above which a sample is refused; the record gust is 113 m/s (Courtney et al.
2012)."""


def is_wind(x: float, y: float, z: float, limit: float = FASTEST_WIND) -> bool:
    """Whether a vector in [m/s] is finite and no faster than a limit."""
    return math.hypot(x, y, z) <= limit


_WHOLE = 0.99
"""Share of the time that is asked for from which a wind is long enough."""


def shorter_than(length: float, seconds: float | None, what: str = 'the wind') -> str:
    """Return a note where a wind of a length [s] is shorter than what is asked for; or nothing."""
    if seconds is None or seconds == math.inf or length >= _WHOLE * seconds:
        return ''
    return f'{what} has {length:.3g} s of the {seconds:g} s that were asked for'
