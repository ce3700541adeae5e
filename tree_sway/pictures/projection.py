# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From points to a picture plane.

A camera without perspective looks level or from above; what it sees to the right and up are two
coordinates, what is away from it is the third.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats

_MARGIN = 0.06


@dataclass(frozen=True)
class Camera:
    """Where a picture is taken from: the south, looking down by ``elevation`` in [rad]."""

    elevation: float = 0.12

    def project(self, points: ArrayLike) -> Floats:
        """Right, up and away of points (..., 3), all in [m]."""
        down, level = np.sin(self.elevation), np.cos(self.elevation)
        rows = np.array([[1.0, 0.0, 0.0], [0.0, down, level], [0.0, level, -down]])
        return np.asarray(np.asarray(points, dtype=np.float64) @ rows.T)


@dataclass(frozen=True)
class Frame:
    """What part of the picture plane is shown: its limits in [m]."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def aspect(self) -> float:
        """Width over height."""
        return (self.right - self.left) / (self.top - self.bottom)


def frame_around(points: Floats, camera: Camera, headroom: float = 0.0) -> Frame:
    """
    Frame all points [m], (..., 3), with a margin round them and headroom above.

    Both are over its height, or over what is much wider than high.
    """
    seen = camera.project(points).reshape(-1, 3)
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    size = max(float(high[1] - low[1]), 0.4 * float(high[0] - low[0]))
    middle = 0.5 * float(low[0] + high[0])
    half = max(0.5 * float(high[0] - low[0]), 0.3 * size) + _MARGIN * size
    top = float(high[1]) + (_MARGIN + headroom) * size
    return Frame(middle - half, middle + half, float(low[1]) - 0.14 * size, top)
