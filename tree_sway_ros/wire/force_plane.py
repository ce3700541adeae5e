# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The force plane as it turns with the wind: x along the wind in the plane, z along its normal."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import quaternions_of_axes
from tree_sway.core.wind import WindConvention

CALM_SPEED = 0.05
"""
Speed in [m/s] below which no direction is computed: sonics repeat their last direction there.
"""


class ForcePlane:
    """
    Orientation of the force plane of a convention.

    Before the first wind x is as near to east as the plane allows, or to north if the plane is
    across east.
    """

    def __init__(self, convention: WindConvention) -> None:
        east, north = (convention.project(axis) for axis in np.eye(3)[:2])
        along = east if np.linalg.norm(east) > 0.1 else north
        across = np.cross(convention.normal, along)
        self._axes = np.stack([along, across]) / np.linalg.norm(along)
        self._at_zero = quaternions_of_axes(self._axes[0], convention.normal)
        self._half_turned = self._at_zero[::-1] * [-1.0, 1.0, -1.0, 1.0]
        self.orientation: Floats = self._at_zero
        """Unit quaternion w, x, y, z of the rotation from the plane's axes to ENU, (4,)."""

    def turn(self, wind: Floats) -> Floats:
        """Turn x along a wind, ENU in [m/s], (3,), unless it is calm; return `orientation`."""
        x, y = self._axes @ np.asarray(wind, dtype=np.float64)
        if math.hypot(x, y) >= CALM_SPEED:
            half = 0.5 * math.atan2(y, x)
            turned = math.cos(half) * self._at_zero + math.sin(half) * self._half_turned
            self.orientation = np.asarray(turned)
        return self.orientation
