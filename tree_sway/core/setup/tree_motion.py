# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion of branches and their tips by small key rotations, joined from the root."""

from __future__ import annotations

from collections.abc import Iterator
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records


def tip_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Join small rotations (N, ...) from the root to displacements of branch tips, (b, 3, ...)."""
    bases = base_motion(branches, rotations)
    return displacement_at(bases, branches['tip']) + own_motion(branches, 'tip_mode', rotations)


def tip_moments(joints: Records, forces: Floats) -> Floats:
    """Moments on coordinates (N, m) under forces on tips (b, 3, m): `tip_motion` transposed."""
    moments = np.zeros((int(joints['n_coordinates'].sum()), forces.shape[-1]))
    wrench = np.concatenate([forces, np.cross(joints['tip'][:, :, None], forces, axis=1)], axis=1)
    for b in range(len(joints) - 1, -1, -1):
        joint = joints[b]
        k, i = int(joint['n_coordinates']), int(joint['coordinate'])
        moments[i : i + k] += joint['tip_mode'][:k] @ forces[b]
        if joint['parent'] >= 0:
            parent = joints[joint['parent']]
            k, i = int(parent['n_coordinates']), int(parent['coordinate'])
            moments[i : i + k] += joint['twist'][:k] @ wrench[b]
            wrench[joint['parent']] += wrench[b]
    return moments


def centre_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Displacement of the load centres of branches by small rotations (N, ...), (b, 3, ...)."""
    bases = base_motion(branches, rotations)
    own = own_motion(branches, 'damping_mode', rotations)
    return displacement_at(bases, branches['centre']) + own


def branch_rotations(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Rotation vectors (b, 3, ...) in [rad] of branches by small rotations (N, ...)."""
    bases = base_motion(branches, rotations)
    return bases[:, 3:] + own_motion(branches, 'load_rotation', rotations)


def own_motion(branches: Records, mode: str, rotations: NDArray[Any]) -> NDArray[Any]:
    """Sum a field of modes (b, k, 3) of branches by their own rotations (N, ...), (b, 3, ...)."""
    motion = np.zeros((len(branches), 3, *rotations.shape[1:]), dtype=rotations.dtype)
    for own, rows in _moved(branches, rotations):
        motion[rows] = _sums(branches[mode][rows, : own.shape[1]], own)
    return motion


def _moved(branches: Records, rotations: NDArray[Any]) -> Iterator[tuple[NDArray[Any], Ints]]:
    """Yield rotations (k, c, ...) and rows (k,) of branches by number c of coordinates."""
    for count in np.unique(branches['n_coordinates']):
        rows = np.flatnonzero(branches['n_coordinates'] == count)
        yield rotations[branches['coordinate'][rows, None] + np.arange(count)], rows


def _sums(twists: Floats, rotations: NDArray[Any]) -> NDArray[Any]:
    """Sum motions per unit of each coordinate, (k, c, d), to those of branches, (k, d, ...)."""
    flat = rotations.reshape(*rotations.shape[:2], math.prod(rotations.shape[2:]))
    moved = np.swapaxes(twists, 1, 2) @ flat
    return moved.reshape(len(twists), twists.shape[2], *rotations.shape[2:])


def joint_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Motion (v, w) of bases about the root by their parents' rotations only, (b, 6, ...)."""
    motion = np.zeros((len(branches), 6, *rotations.shape[1:]), dtype=rotations.dtype)
    parents = branches['parent']
    for own, rows in _moved(branches, rotations):
        place = np.full(len(branches) + 1, -1)
        place[rows] = np.arange(len(rows))
        children = np.flatnonzero(place[parents] >= 0)
        twists = branches['twist'][children, : own.shape[1]]
        motion[children] = _sums(twists, own[place[parents[children]]])
    return motion


def base_motion(branches: Records, rotations: NDArray[Any]) -> NDArray[Any]:
    """Motion (v, w) about the root of branches' bases, (b, 6, ...), by small turns (N, ...)."""
    parents = branches['parent']
    return sum_outward(parents, levels_of(parents), joint_motion(branches, rotations))


def sum_outward(parents: Ints, levels: list[Ints], joints: NDArray[Any]) -> NDArray[Any]:
    """Add the motion of the parent from the root on to that of each branch on it, (b, ...)."""
    total = joints.copy()
    for level in levels[1:]:  # children of the stem are complete
        total[level] += total[parents[level]]
    return total


def levels_of(parent: Ints) -> list[Ints]:
    """Sort the branches into levels by their distance from the stem, without the stem."""
    depth = np.zeros(len(parent), dtype=np.int64)
    for b, below in enumerate(parent.tolist()):
        depth[b] = depth[below] + 1 if below >= 0 else 0
    return [np.flatnonzero(depth == k) for k in range(1, int(depth.max()) + 1)]


def displacement_at(motion: NDArray[Any], points: Floats) -> NDArray[Any]:
    """Displacement (p, 3, ...) of points (p, 3) of bodies moving by (v, w) about the root."""
    x, y, z = points.T.reshape(3, -1, *(1,) * (motion.ndim - 2))
    wx, wy, wz = motion[:, 3], motion[:, 4], motion[:, 5]
    moved = motion[:, :3].copy()
    moved[:, 0] += wy * z - wz * y
    moved[:, 1] += wz * x - wx * z
    moved[:, 2] += wx * y - wy * x
    return moved
