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
