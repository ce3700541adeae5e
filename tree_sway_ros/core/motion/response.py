# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How far tips go in a wind that swings at one pace: linear response, before a step is taken.

Loads are split as turbulence is: along the mean wind, where the load goes with the square of the
speed, and across it. The gain of a model is the motion of the tips of all branches, joined from
the root, per unit of load at each frequency. Gains of two models can be set against each other;
that is how the error of the lesser one is known without running the greater.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Ints, Records
from tree_sway_ros.core.motion.numpy_passes import even_wind_moments

Complexes = NDArray[np.complex128]


class Responding(Protocol):
    """Oscillators whose steady answer to a swinging moment is known."""

    branches: Records
    carries: bool
    is_tabled: bool

    def response(self, moments: Floats, circular: Floats) -> Complexes:
        """Key rotations (N, k, f) under moments (N, k) that swing at w [rad/s], (f,)."""


def key_response(
    oscillators: Responding,
    n_coordinates: int,
    frequencies: Floats,
    patterns: Sequence[Floats | float] = (1.0,),
) -> Complexes:
    """
    Key rotations (N, 2, f) [m^2/N] under an even load of 1 N/m^2 along x and y that swings.

    The frequencies are in [Hz], (f,); 0 is the static answer.
    """
    moments = []
    for pattern in patterns:
        branches = oscillators.branches.copy()
        branches['area'] *= pattern
        moments.append(even_wind_moments(branches, n_coordinates, carries=oscillators.carries))
    return oscillators.response(np.hstack(moments), 2.0 * np.pi * np.asarray(frequencies))


def tip_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Join small rotations (N, ...) from the root to displacements of branch tips, (b, 3, ...)."""
    tips = carried_to(base_motion(branches, rotations), branches['tip'])
    for own, rows in _moved(branches, rotations):
        tips[rows] += _sums(branches['reach'][rows, : own.shape[1]], own)
    return tips


def _moved(branches: Records, rotations: NDArray[Any]) -> Iterator[tuple[NDArray[Any], Ints]]:
    """Rotations (k, c, ...) of those branches (k,) that have as many coordinates, c."""
    for count in np.unique(branches['n_coordinates']):
        rows = np.flatnonzero(branches['n_coordinates'] == count)
        yield rotations[branches['coordinate'][rows, None] + np.arange(count)], rows


def _sums(twists: Floats, rotations: NDArray[Any]) -> NDArray[Any]:
    """Motion (k, d, ...) of branches by what a unit of each coordinate moves, (k, c, d)."""
    flat = rotations.reshape(*rotations.shape[:2], math.prod(rotations.shape[2:]))
    moved = np.swapaxes(twists, 1, 2) @ flat
    return moved.reshape(len(twists), twists.shape[2], *rotations.shape[2:])


def base_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Motion (v, w) about the root of branches' bases, (b, 6, ...), by small turns (N, ...)."""
    base = np.zeros((len(branches), 6, *rotations.shape[1:]), dtype=rotations.dtype)
    parents = branches['parent']
    for own, rows in _moved(branches, rotations):
        place = np.full(len(branches) + 1, -1)
        place[rows] = np.arange(len(rows))
        children = np.flatnonzero(place[parents] >= 0)
        twists = branches['twist'][children, : own.shape[1]]
        base[children] = _sums(twists, own[place[parents[children]]])
    for branch in np.flatnonzero(parents > 0):  # children of the stem have all that is theirs
        base[branch] += base[parents[branch]]
    return base


def carried_to(motion: NDArray[Any], points: Floats) -> NDArray[Any]:
    """Displacement (p, 3, ...) of points (p, 3) of bodies moving by (v, w) about the root."""
    x, y, z = points.T.reshape(3, -1, *(1,) * (motion.ndim - 2))
    wx, wy, wz = motion[:, 3], motion[:, 4], motion[:, 5]
    moved = motion[:, :3].copy()
    moved[:, 0] += wy * z - wz * y
    moved[:, 1] += wz * x - wx * z
    moved[:, 2] += wx * y - wy * x
    return moved
