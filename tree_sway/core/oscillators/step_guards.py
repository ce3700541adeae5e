# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What keeps the step of a branch on two axes bounded, for any wind and step."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats

LOAD_MAX = 3.0
"""Largest load over stiffness at w h = 1, |W| / k1 [rad]."""

_LOAD_FINE, _LOAD_COARSE = 10.0, 0.8
"""Bounds on it at long and at short steps."""

_MOMENT_MARGIN = 1.5
"""The limit of the whole moment over that of the load."""

_GYRO_STEP = 0.5
"""w h from which a step does not resolve the gyroscopic term."""


def guards(inertia: Floats, stiffness: Floats, dt: float) -> Floats:
    """
    Return what keeps a step of dt [s] bounded, (b, 3).

    Inertia [kg m^2] of the gyroscopic term, and the limits of the load and of the whole moment
    [N m]: s_max k1 with s_max = 3 / (w h)^2 between 0.8 and 10. Within it one corrector converges,
    and a steady load gives the right angle; at 4 / (w h)^2 it does not. A branch without stiffness
    has no limits.
    """
    square = stiffness * dt * dt  # (w h)^2 times the inertia
    most = LOAD_MAX * inertia / np.maximum(square, 1e-300)
    limit = np.where(
        stiffness > 0.0, stiffness * np.clip(most, _LOAD_COARSE, _LOAD_FINE), math.inf
    )
    gyro_inertia = np.where(square < _GYRO_STEP * _GYRO_STEP * inertia, inertia, 0.0)
    return np.stack([gyro_inertia, limit, _MOMENT_MARGIN * limit], axis=1)
