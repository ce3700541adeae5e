# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Functions that readers of wind share: a velocity, and bearings from degrees."""

from __future__ import annotations

from math import radians

Velocity = tuple[float, float, float]


def degrees_to_bearing(degrees: float) -> float | None:
    """Bearing in [rad] from degrees in [0, 360]; None outside, as for a sensor's error value."""
    return radians(degrees) if 0.0 <= degrees <= 360.0 else None
