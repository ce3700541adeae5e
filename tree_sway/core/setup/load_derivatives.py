# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Derivatives of the wind load on a bent tree, for many shapes of motion in one pass.

The native core finds how the moments on key rotations change (``native/load_slopes.h``); by
virtual work, the load on a shape is their power on it.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.wind_moments import WindMoments

_LANES = 8
"""The native core takes as many shapes at once."""


class LoadSlopes:
    """
    Derivatives of the load of a tree on some shapes by the motion of these shapes.

    Parameters
    ----------
    moments
        Loads of the tree.
    shapes
        Key rotations of each shape, (N, m).

    """

    def __init__(self, moments: WindMoments, shapes: Floats) -> None:
        self._moments = moments
        self._shapes = shapes
        count, m = shapes.shape
        padded = np.zeros((3, count, -(-m // _LANES) * _LANES))
        padded[0, :, :m] = shapes
        self._padded, self._turning, self._damping = padded

    def __call__(self, x: Floats, wind: Floats) -> tuple[Floats, Floats]:
        """
        Differentiate modal loads by the amounts of the shapes, and by their rates, both (m, m).

        The first axis is the shape that moves, the second the one that is loaded; the tree is at
        x, (N,), without motion, in a wind [m/s], (3,), of 1 kg/m^3.
        """
        self._moments.find_slopes(x, wind, self._padded, self._turning, self._damping)
        m = self._shapes.shape[1]
        turning, damping = (
            each[:, :m].T @ self._shapes for each in (self._turning, self._damping)
        )
        return turning, damping
