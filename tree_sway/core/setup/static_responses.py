# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Static response of a tree to steady winds: its equilibria.

A wind loads every branch, and motion outside of the span of the coordinates is lost. So the
responses to winds of all directions and speeds are found once, and the coordinates are made of
these and of the responses to gusts (`gust_responses`, `modes.leading_modes`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import drag_density, DragLaw
from tree_sway.core.setup.wind_moments import WindMoments

_SPEEDS = (10.0, 20.0, 40.0)
_AZIMUTHS = np.arange(8) * np.pi / 4.0
_TURNS = 6
_FARTHEST = 1.0
"""Largest key rotation of a pose in [rad]."""


def static_responses(
    moments: WindMoments, solve: Callable[[Floats], Floats], law: DragLaw
) -> Floats:
    """
    Find the equilibria of a tree in winds: key rotations [rad], (N, k).

    Parameters
    ----------
    moments
        Loads of the tree.
    solve
        Key rotations under moments [N m], (N,): the inverse of the stiffness.
    law
        Drag law of the tree.

    """
    level_winds = direction(_AZIMUTHS, 0.0)
    at_rest = np.zeros((len(level_winds), moments.n))
    small = solve(moments.at_poses(at_rest, level_winds).T).T
    of_speeds = [drag_density(speed, *law) * speed * speed for speed in _SPEEDS]
    pressures = np.tile(of_speeds, len(level_winds))[:, None]
    strong_winds = np.repeat(level_winds, len(_SPEEDS), axis=0)
    far = _equilibria(moments, solve, strong_winds, pressures)
    # Where air has no pressure, none of these winds bends the tree.
    per_pressure = far / np.maximum(pressures, 1e-300)
    rest = np.zeros(moments.n)
    aslant = [solve(moments(rest, rest, wind)) for wind in _inclined_winds()]
    return np.vstack([small, per_pressure, aslant]).T


def _equilibria(
    moments: WindMoments, solve: Callable[[Floats], Floats], winds: Floats, pressures: Floats
) -> Floats:
    """
    Find the key rotations (k, N) at which a tree is at rest in winds (k, 3) of pressures (k, 1).

    Each turn goes a part of the way to the pose that the springs have under the load of the last,
    less and less of it, so that a pose between two that alternate is reached.
    """
    poses = np.zeros((len(winds), moments.n))
    for turn in range(_TURNS):
        loads = pressures * moments.at_poses(poses, winds)
        sprung = solve(loads.T).T
        poses += (sprung - poses) / (turn + 2.0) ** 0.5
        farthest = np.maximum(np.abs(poses).max(axis=1, keepdims=True), 1e-12)
        poses *= np.minimum(1.0, _FARTHEST / farthest)
    return poses


def _inclined_winds() -> Floats:
    """Return directions of winds that fall and rise, straight and aslant, (k, 3)."""
    azimuths = _AZIMUTHS[::2]
    falling = direction(azimuths, -np.pi / 4.0)
    rising = direction(azimuths, np.pi / 4.0)
    down = direction([0.0], -np.pi / 2.0)
    up = direction([0.0], np.pi / 2.0)
    return np.vstack([down, falling, rising, up])


def direction(azimuth: ArrayLike, elevation: ArrayLike) -> Floats:
    """Return the unit vectors of angles in [rad], (..., 3)."""
    azimuth, elevation = np.broadcast_arrays(azimuth, elevation)
    level = np.cos(elevation)
    x = level * np.cos(azimuth)
    y = level * np.sin(azimuth)
    return np.asarray(np.stack([x, y, np.sin(elevation)], axis=-1))
