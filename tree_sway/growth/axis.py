# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The line of a growing shoot in space, given by its heading.

A heading is an azimuth (from x towards y) and an elevation above the horizon, both in [rad].
Habits of growth are plain in these terms: a weeping shoot starts above the horizon and ends below
it, a conifer's starts low and turns up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats

GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
"""Angle between successive shoots in spiral phyllotaxis in [rad]."""

UP = np.array([0.0, 0.0, 1.0])


def direction_of(azimuth: ArrayLike, elevation: ArrayLike) -> Floats:
    """Return the unit vectors (..., 3) of headings given in [rad]."""
    across = np.cos(elevation)
    x = across * np.cos(azimuth)
    y = across * np.sin(azimuth)
    z = np.sin(elevation)
    return np.stack([x, y, z], axis=-1)


def heading_of(direction: Floats) -> tuple[float, float]:
    """Azimuth and elevation in [rad] of a vector (3,)."""
    x, y, z = direction
    azimuth = np.arctan2(y, x)
    elevation = np.arctan2(z, np.hypot(x, y))
    return float(azimuth), float(elevation)


def aim(axis: Floats, polar: float, azimuth: float) -> Floats:
    """
    Return the unit vector (3,) at an angle from an axis, both in [rad].

    The azimuth about the axis is 0 level and to the right of someone who looks along it, pi/2 up.
    """
    x, y, _ = axis
    across = float(np.hypot(x, y))
    right = np.array([0.0, -1.0, 0.0])
    if across > 1e-6:
        right = np.array([y / across, -x / across, 0.0])
    upward = np.cross(right, axis)
    side = np.cos(azimuth) * right + np.sin(azimuth) * upward
    return np.asarray(np.cos(polar) * axis + np.sin(polar) * side)


def grow_axis(
    origin: Floats,
    azimuth: float,
    elevation: tuple[float, float],
    length: float,
    n_segments: int,
    rng: np.random.Generator,
    *,
    wander: float = 0.0,
    unevenness: float = 0.15,
    floor: float = -np.inf,
) -> Floats:
    """
    Draw the nodes (n_segments + 1, 3) [m] of a shoot whose elevation turns evenly.

    Parameters
    ----------
    origin, length, n_segments
        First node, (3,), and length along the nodes, both in [m], and number of segments.
    azimuth, elevation
        Heading of the first segment, and elevation of the first and the last one, in [rad].
    rng
        Source of randomness.
    wander
        Standard deviation of the change of heading per segment in [rad].
    unevenness
        Largest relative deviation of a segment's length from the mean.
    floor
        The shoot ends before it would sink below this height in [m]; it keeps one segment.

    """
    steps = 1.0 + unevenness * rng.uniform(-1.0, 1.0, n_segments)
    steps *= length / steps.sum()

    changes = wander * rng.standard_normal((n_segments, 2))
    up_drift, side_drift = np.cumsum(changes, axis=0).T
    elevations = np.linspace(elevation[0], elevation[1], n_segments) + up_drift
    # A given change of azimuth bends a steep shoot less; undo that, but bounded towards the
    # vertical.
    level_part = np.maximum(np.cos(elevations), 0.3)
    azimuths = azimuth + side_drift / level_part

    segments = steps[:, None] * direction_of(azimuths, elevations)
    path = np.cumsum(segments, axis=0)
    nodes = np.vstack([origin, origin + path])
    sunk = np.flatnonzero(nodes[2:, 2] < floor)
    if len(sunk):
        return nodes[: sunk[0] + 2]
    return nodes
