# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion of branches and their tips by small key rotations, joined from the root."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.rotation import CYCLES

_Numbers: TypeAlias = NDArray[Any]
"""Real or complex numbers."""


def tip_motion(branches: Records, rotations: _Numbers) -> _Numbers:
    """Join small rotations (N, ...) from the root to displacements of branch tips, (b, 3, ...)."""
    bases = base_motion(branches, rotations)
    return _displacement_at(bases, branches['tip']) + own_motion(branches, 'tip_mode', rotations)


def tip_moments(joints: Records, forces: Floats) -> Floats:
    """Moments on coordinates (N, m) under forces on tips (b, 3, m): `tip_motion` transposed."""
    n_coordinates = int(joints['n_coordinates'].sum())
    moments = np.zeros((n_coordinates, forces.shape[-1]))
    arms = joints['tip'][:, :, None]
    about_root = np.cross(arms, forces, axis=1)
    wrench = np.concatenate([forces, about_root], axis=1)
    for branch in reversed(range(len(joints))):
        joint = joints[branch]
        own = _own_rows(moments, joint)
        own += _of_rows(joint['tip_mode'], joint) @ forces[branch]
        parent = joint['parent']
        if parent >= 0:
            below = joints[parent]
            of_parent = _own_rows(moments, below)
            of_parent += _of_rows(joint['twist'], below) @ wrench[branch]
            wrench[parent] += wrench[branch]
    return moments


def _own_rows(rows: Floats, branch: np.void) -> Floats:
    """Return the rows of the coordinates of a branch among those of all, (N, ...)."""
    first = int(branch['coordinate'])
    return rows[first : first + int(branch['n_coordinates'])]


def _of_rows(modes: Floats, branch: np.void) -> Floats:
    """Return modes per unit of the coordinates that a branch has, without spare ones."""
    return modes[: int(branch['n_coordinates'])]


def centre_motion(branches: Records, rotations: _Numbers) -> _Numbers:
    """Displacement of the load centres of branches by small rotations (N, ...), (b, 3, ...)."""
    bases = base_motion(branches, rotations)
    own = own_motion(branches, 'damping_mode', rotations)
    return _displacement_at(bases, branches['centre']) + own


def branch_rotations(branches: Records, rotations: _Numbers) -> _Numbers:
    """Rotation vectors (b, 3, ...) in [rad] of branches by small rotations (N, ...)."""
    bases = base_motion(branches, rotations)
    return bases[:, 3:] + own_motion(branches, 'load_rotation', rotations)


def own_motion(branches: Records, mode: str, rotations: _Numbers) -> _Numbers:
    """Sum a field of modes (b, k, d) of branches by their own rotations (N, ...), (b, d, ...)."""
    return _moved(branches, np.arange(len(branches)), branches[mode], rotations)


def _joint_motion(branches: Records, rotations: _Numbers) -> _Numbers:
    """Motion (v, w) of bases about the root by their parents' rotations only, (b, 6, ...)."""
    motion = np.zeros((len(branches), 6, *rotations.shape[1:]), dtype=rotations.dtype)
    parents = branches['parent']
    has_parent = parents >= 0
    twists = branches['twist'][has_parent]
    motion[has_parent] = _moved(branches, parents[has_parent], twists, rotations)
    return motion


def _moved(branches: Records, moving: Ints, modes: Floats, rotations: _Numbers) -> _Numbers:
    """
    Sum the motion of some bodies by small rotations of the branches that move them.

    Parameters
    ----------
    branches
        Records of all branches.
    moving
        Branch that moves each body, (p,).
    modes
        Motion of each body per unit of each coordinate of that branch, (p, k, d).
    rotations
        Small rotations of all branches, (N, ...).

    Returns
    -------
    Numbers
        Motion of the bodies, (p, d, ...).

    """
    n_bodies, _, n_components = modes.shape
    columns = rotations.shape[1:]
    flat = rotations.reshape(len(rotations), math.prod(columns))
    motion = np.zeros((n_bodies, n_components, flat.shape[1]), dtype=rotations.dtype)
    first = branches['coordinate'][moving]
    counts = branches['n_coordinates'][moving]
    for count in np.unique(counts):
        bodies = np.flatnonzero(counts == count)
        coordinates = first[bodies, None] + np.arange(count)
        per_unit = np.swapaxes(modes[bodies, :count], 1, 2)
        motion[bodies] = per_unit @ flat[coordinates]
    return motion.reshape(n_bodies, n_components, *columns)


def base_motion(branches: Records, rotations: _Numbers) -> _Numbers:
    """Motion (v, w) about the root of branches' bases, (b, 6, ...), by small turns (N, ...)."""
    parents = branches['parent']
    return sum_outward(parents, _joint_motion(branches, rotations))


def sum_outward(parents: Ints, joints: _Numbers) -> _Numbers:
    """Add the motion of its parent to that of each branch, from the root on, (b, ...)."""
    total = joints.copy()
    for level in _levels_of(parents)[1:]:  # children of the stem are complete
        total[level] += total[parents[level]]
    return total


def _levels_of(parent: Ints) -> list[Ints]:
    """Sort the branches into levels by their distance from the stem, without the stem."""
    depth = np.zeros(len(parent), dtype=np.int64)
    for branch, below in enumerate(parent.tolist()):
        if below >= 0:
            depth[branch] = depth[below] + 1
    deepest = int(depth.max())
    return [np.flatnonzero(depth == level) for level in range(1, deepest + 1)]


def _displacement_at(motion: _Numbers, points: Floats) -> _Numbers:
    """Displacement (p, 3, ...) of points (p, 3) of bodies moving by (v, w) about the root."""
    velocity = motion[:, :3]
    spin = motion[:, 3:]
    columns = motion.ndim - 2
    arm = np.expand_dims(points, tuple(range(2, 2 + columns)))
    moved = velocity.copy()
    for i, j, k in CYCLES:
        moved[:, i] += spin[:, j] * arm[:, k] - spin[:, k] * arm[:, j]
    return moved


def projectors(entries: Floats) -> Floats:
    """Return matrices (..., 3, 3) of their entries xx, yy, zz, xy, xz, yz, (..., 6)."""
    row_by_row = entries[..., [0, 3, 4, 3, 1, 5, 4, 5, 2]]
    return row_by_row.reshape(*entries.shape[:-1], 3, 3)
