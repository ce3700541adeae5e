# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Winds in which the drag of a crooked branch is sampled."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats

_N_BEARINGS = 16
_ELEVATIONS = np.radians([-10.0, 0.0, 10.0])


class SlantingWinds:
    """
    Winds of unit speed from all sides, horizontal and, as branches bend, oblique.

    The first one follows a direction (3,), so that a rotated tree has the load of the rotated
    wind.
    """

    def __init__(self, direction: Floats) -> None:
        """Make winds of 16 bearings at each of three elevations."""
        turns = np.arange(_N_BEARINGS) * 2.0 * np.pi / _N_BEARINGS
        bearings = _bearing_of(direction) + turns
        level = np.cos(_ELEVATIONS)[:, None]
        winds = np.empty((len(_ELEVATIONS), _N_BEARINGS, 3))
        winds[..., 0] = level * np.cos(bearings)
        winds[..., 1] = level * np.sin(bearings)
        winds[..., 2] = np.sin(_ELEVATIONS)[:, None]
        self.winds = winds.reshape(-1, 3)
        """Unit vectors, (48, 3)."""
        x, y, z = self.winds.T
        products = [x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z]
        self._products = np.stack(products, axis=1)

    def squares(self, projectors: Floats) -> Floats:
        """Return ``u . P u`` of projectors (k, 6) in each wind u, (48, k)."""
        return np.asarray(np.maximum(self._products @ projectors.T, 0.0))

    def nearest(self, squares: Floats) -> Floats:
        """Return the projector (6,) that fits these squares, (48,), best."""
        return np.asarray(np.linalg.lstsq(self._products, squares, rcond=None)[0])


def _bearing_of(direction: Floats) -> float:
    """Return the bearing of a direction in [rad]; 0 where it is vertical."""
    x, y, _ = direction
    is_vertical = not math.hypot(x, y) > 1e-6 * float(np.linalg.norm(direction))
    return 0.0 if is_vertical else math.atan2(y, x)
