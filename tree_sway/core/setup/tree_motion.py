# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion of branches and their tips by small key rotations, joined from the root."""

from __future__ import annotations

from collections.abc import Iterator
import math
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records

Numbers: TypeAlias = NDArray[Any]
"""Real or complex numbers."""


def tip_motion(branches: Records, rotations: Numbers) -> Numbers:
    """Join small rotations (N, ...) from the root to displacements of branch tips, (b, 3, ...)."""
    bases = base_motion(branches, rotations)
    return displacement_at(bases, branches['tip']) + own_motion(branches, 'tip_mode', rotations)


def tip_moments(joints: Records, forces: Floats) -> Floats:
    """Moments on coordinates (N, m) under forces on tips (b, 3, m): `tip_motion` transposed."""
    moments = np.zeros((int(joints['n_coordinates'].sum()), forces.shape[-1]))
    about_root = np.cross(joints['tip'][:, :, None], forces, axis=1)
    wrench = np.concatenate([forces, about_root], axis=1)
    for branch in reversed(range(len(joints))):
        joint = joints[branch]
        own = _own_rows(moments, joint)
        own += _of_rows(joint['tip_mode'], joint) @ forces[branch]
        if joint['parent'] >= 0:
            parent = joints[joint['parent']]
            of_parent = _own_rows(moments, parent)
            of_parent += _of_rows(joint['twist'], parent) @ wrench[branch]
            wrench[joint['parent']] += wrench[branch]
    return moments


def _own_rows(rows: Floats, branch: np.void) -> Floats:
    """Return the rows of the coordinates of a branch among those of all, (N, ...)."""
    first = int(branch['coordinate'])
    return rows[first : first + int(branch['n_coordinates'])]


def _of_rows(modes: Floats, branch: np.void) -> Floats:
    """Return modes per unit of the coordinates that a branch has, without spare ones."""
    return modes[: int(branch['n_coordinates'])]


def centre_motion(branches: Records, rotations: Numbers) -> Numbers:
    """Displacement of the load centres of branches by small rotations (N, ...), (b, 3, ...)."""
    bases = base_motion(branches, rotations)
    own = own_motion(branches, 'damping_mode', rotations)
    return displacement_at(bases, branches['centre']) + own


def branch_rotations(branches: Records, rotations: Numbers) -> Numbers:
    """Rotation vectors (b, 3, ...) in [rad] of branches by small rotations (N, ...)."""
    bases = base_motion(branches, rotations)
    return bases[:, 3:] + own_motion(branches, 'load_rotation', rotations)


def own_motion(branches: Records, mode: str, rotations: Numbers) -> Numbers:
    """Sum a field of modes (b, k, 3) of branches by their own rotations (N, ...), (b, 3, ...)."""
    motion = np.zeros((len(branches), 3, *rotations.shape[1:]), dtype=rotations.dtype)
    for own, rows in _moved(branches, rotations):
        motion[rows] = _sums(branches[mode][rows, : own.shape[1]], own)
    return motion


def _moved(branches: Records, rotations: Numbers) -> Iterator[tuple[Numbers, Ints]]:
    """Yield rotations (k, c, ...) and rows (k,) of branches by number c of coordinates."""
    for count in np.unique(branches['n_coordinates']):
        rows = np.flatnonzero(branches['n_coordinates'] == count)
        coordinates = branches['coordinate'][rows, None] + np.arange(count)
        yield rotations[coordinates], rows


def _sums(twists: Floats, rotations: Numbers) -> Numbers:
    """Sum motions per unit of each coordinate, (k, c, d), to those of branches, (k, d, ...)."""
    n_branches, n_coordinates, *further = rotations.shape
    flat = rotations.reshape(n_branches, n_coordinates, math.prod(further))
    moved = np.swapaxes(twists, 1, 2) @ flat
    return moved.reshape(*moved.shape[:2], *further)


def joint_motion(branches: Records, rotations: Numbers) -> Numbers:
    """Motion (v, w) of bases about the root by their parents' rotations only, (b, 6, ...)."""
    motion = np.zeros((len(branches), 6, *rotations.shape[1:]), dtype=rotations.dtype)
    parents = branches['parent']
    for own, rows in _moved(branches, rotations):
        place = np.full(len(branches) + 1, -1)  # with one for the parent of the stem
        place[rows] = np.arange(len(rows))
        place_of_parent = place[parents]
        children = np.flatnonzero(place_of_parent >= 0)
        twists = branches['twist'][children, : own.shape[1]]
        motion[children] = _sums(twists, own[place_of_parent[children]])
    return motion


def base_motion(branches: Records, rotations: Numbers) -> Numbers:
    """Motion (v, w) about the root of branches' bases, (b, 6, ...), by small turns (N, ...)."""
    parents = branches['parent']
    return sum_outward(parents, levels_of(parents), joint_motion(branches, rotations))


def sum_outward(parents: Ints, levels: list[Ints], joints: Numbers) -> Numbers:
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


def displacement_at(motion: Numbers, points: Floats) -> Numbers:
    """Displacement (p, 3, ...) of points (p, 3) of bodies moving by (v, w) about the root."""
    velocity, spin = np.split(motion, 2, axis=1)
    arm = points.reshape(*points.shape, *(1,) * (motion.ndim - 2))
    moved = velocity.copy()
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        moved[:, i] += spin[:, j] * arm[:, k] - spin[:, k] * arm[:, j]
    return moved
