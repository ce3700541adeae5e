# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A camera without distortion: where points of the world are in its picture.

The picture has x to the right and y down, in pixels, from its upper left corner.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats

_NEAREST = 0.1
"""Least depth in [m] at which a point is seen."""


class Camera(NamedTuple):
    """
    A pinhole camera.

    Parameters
    ----------
    position
        Its place in [m], (3,).
    axes
        Unit vectors to the right, down and ahead of it, (3, 3).
    focal
        Focal length in pixels.
    centre
        Middle of the picture in pixels, (2,).

    """

    position: Floats
    axes: Floats
    focal: float
    centre: Floats

    def project(self, points: Floats) -> Floats:
        """Places of points of the world (p, 3) in the picture, (p, 2); not a number behind it."""
        seen = (points - self.position) @ self.axes.T
        depth = np.where(seen[:, 2] > _NEAREST, seen[:, 2], np.nan)
        return self.centre + self.focal * seen[:, :2] / depth[:, None]

    def depth(self, points: Floats) -> Floats:
        """How far ahead of the camera points (p, 3) are in [m], (p,)."""
        return (points - self.position) @ self.axes[2]

    def slopes(self, points: Floats) -> Floats:
        """Motion in the picture per motion of points (p, 3) in pixels per metre, (p, 2, 3)."""
        seen = (points - self.position) @ self.axes.T
        away = seen[:, :2, None] / seen[:, 2, None, None]
        across = self.axes[:2] - away * self.axes[2]
        return self.focal * across / seen[:, 2, None, None]


def looking(bearing: float, pitch: float, roll: float) -> Floats:
    """
    Axes of a camera, (3, 3).

    Parameters
    ----------
    bearing
        Where it looks, clockwise from north (y), in [rad].
    pitch
        How far it looks up in [rad].
    roll
        How far it is turned clockwise about where it looks in [rad].

    """
    sine, cosine = math.sin(bearing), math.cos(bearing)
    ahead = np.array([math.cos(pitch) * sine, math.cos(pitch) * cosine, math.sin(pitch)])
    right = np.array([cosine, -sine, 0.0])
    down = np.cross(ahead, right)
    turned = math.cos(roll) * right + math.sin(roll) * down
    return np.stack([turned, np.cross(ahead, turned), ahead])
