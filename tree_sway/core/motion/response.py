# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How far branches and their tips move by small key rotations, joined from the root."""

from __future__ import annotations

from collections.abc import Iterator
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records


def tip_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Join small rotations (N, ...) from the root to displacements of branch tips, (b, 3, ...)."""
    tips = carried_to(base_motion(branches, rotations), branches['tip'])
    for own, rows in _moved(branches, rotations):
        tips[rows] += _sums(branches['tip_mode'][rows, : own.shape[1]], own)
    return tips


def turn_of_branches(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Rotation vectors (b, 3, ...) in [rad] of branches by small rotations (N, ...)."""
    turns = base_motion(branches, rotations)[:, 3:]
    for own, rows in _moved(branches, rotations):
        turns[rows] += _sums(branches['load_rotation'][rows, : own.shape[1]], own)
    return turns


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
