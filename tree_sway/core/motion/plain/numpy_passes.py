# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The load step on whole levels of a tree at a time: `tree_passes` where nothing is compiled.

The same formulas on the same records; subtree sums are differences of one cumulative sum.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.motion.plain.numpy_rotation import cayley_turned, cross
from tree_sway.core.motion.records import LANES


class NumpyPasses:
    """
    Outward pass, wind and inward pass over `BRANCH` records, parents before children.

    Subtrees are contiguous runs.
    """

    def __init__(self, branches: Records) -> None:
        """Take over columns, and sort the branches by level."""
        names = (
            'parent', 'source', 'twist', 'centre', 'damping_mode', 'load_rotation', 'load_mode',
            'lever', 'speed', 'base', 'arm', 'per_arm',
        )  # fmt: skip
        self._of: dict[str, NDArray[Any]] = {
            name: np.ascontiguousarray(branches[name])
            for name in (*names, 'spread', 'area', 'frame', 'coupling')
        }
        xx, yy, zz, xy, xz, yz = branches['projector'].T
        self._projector = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
        self.levels = levels_of(branches['parent'])
        column = np.arange(branches['load_mode'].shape[1])
        self.is_there = column < branches['n_coordinates'][:, None]
        self._column = np.where(self.is_there, branches['coordinate'][:, None] + column, 0)

    def per_branch(self, x: Floats) -> Floats:
        """Numbers on the coordinates (N,) side by side per branch, zeros where none, (b, c)."""
        found: Floats = np.where(self.is_there, x[self._column], 0.0)
        return found

    def outward(self, x: Floats, v: Floats) -> Floats:
        """Velocity (v, w) and rotation of each base, (b, 9), of angles and rates (b, c)."""
        base = np.zeros((len(x), 9))
        for level in self.levels:
            parent, twist = self._of['parent'][level], self._of['twist'][level]
            base[level, :6] = base[parent, :6] + np.einsum('bc,bck->bk', v[parent], twist)
            base[level, 6:] = base[parent, 6:] + np.einsum('bc,bck->bk', x[parent], twist[..., 3:])
        return base

    def wind_forces(
        self,
        base: Floats,
        x: Floats,
        v: Floats,
        wind: Floats,
        per_speed_squared: float,
        compliance: Floats,
        impulse: Floats,
    ) -> Floats:
        """Force of the wind on each branch in [N], (b, 3); the impulse (b, 3) is written again."""
        of = self._of
        motion = base[:, :3] + cross(base[:, 3:6], of['centre'])
        motion += np.einsum('bc,bck->bk', v, of['damping_mode'])
        turn = base[:, 6:] + np.einsum('bc,bck->bk', x, of['load_rotation'])
        free = cayley_turned(-turn, of['speed'][:, None] * wind - motion)
        free += compliance[:, None] * impulse
        across = np.einsum('bij,bj->bi', self._projector, free)
        spread = of['spread'] * np.square(v[:, :2]).sum(axis=1)
        speed = np.sqrt(np.maximum(np.einsum('bi,bi->b', free, across), 0.0) + spread)
        c = per_speed_squared * of['area']
        share = 2.0 / (1.0 + np.sqrt(1.0 + 4.0 * compliance * c * speed))
        per_speed = (c * speed * share**2)[:, None]
        impulse[:] = per_speed * free
        return cayley_turned(turn, per_speed * across)[of['source']]

    def own_loads(self, force: Floats) -> Floats:
        """Pull along each chord and moments on its key rotation in [N m], (b, 3)."""
        of = self._of
        own = np.einsum('bck,bk->bc', of['load_mode'][:, :2], force)
        pull = of['lever'] * np.einsum('bk,bk->b', of['frame'][:, 0], force)
        return np.hstack([pull[:, None], own])

    def bent_loads(self, base: Floats, x: Floats, force: Floats, moment: Floats) -> None:
        """Write moments on the coordinates of a tree as it is bent and turned, (N,), in [N m]."""
        of = self._of
        own_turn = np.einsum('bc,bck->bk', x, of['load_rotation'])
        turned = cayley_turned(-(base[:, 6:] + own_turn), force)
        own = np.einsum('bck,bk->bc', of['load_mode'], turned)
        couple = np.einsum('bij,bj->bi', of['coupling'], turned) - cross(of['base'], turned)
        wrench = np.hstack([cayley_turned(-base[:, 6:], force), cayley_turned(own_turn, couple)])
        for level in reversed(self.levels):
            parent, twist, at = (of[name][level] for name in ('parent', 'twist', 'base'))
            moved = np.einsum('bc,bck->bk', x[parent], twist)
            turn, shift = moved[:, 3:], moved[:, :3] + cross(moved[:, 3:], at)
            f, m = (cayley_turned(turn, wrench[level][:, k : k + 3]) for k in (0, 3))
            arm, per = of['arm'][level], of['per_arm'][level, None]
            now = arm * (1.0 - per * np.square(shift).sum(axis=1, keepdims=True)) + shift
            np.add.at(wrench, parent, np.hstack([f, m + cross(now, f)]))
            f = f - 2.0 * per * (arm * f).sum(axis=1, keepdims=True) * shift
            m = m + 0.5 * cross(m, turn) + cross(at, f)
            np.add.at(own, parent, np.einsum('bck,bk->bc', twist, np.hstack([f, m])))
        moment[self._column[self.is_there]] = own[self.is_there]


def even_wind_moments(branches: Records, n_coordinates: int, axes: int = 2) -> Floats:
    """Moments [N m], (N, axes), at rest of even winds of 1 m/s and 1 kg/m^3 along x, y and z."""
    passes, n = NumpyPasses(branches), len(branches)
    moments, still, none = np.zeros((axes, n_coordinates)), np.zeros((n, 9)), np.zeros(n)
    at_rest = np.zeros(branches['load_mode'].shape[:2])
    for moment, wind in zip(moments, np.eye(3), strict=False):
        impulse = np.zeros((n, 3))
        force = passes.wind_forces(still, at_rest, at_rest, wind, 1.0, none, impulse)
        passes.bent_loads(still, at_rest, force, moment)
    return moments.T


def levels_of(parent: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Branches as many steps from the stem as each other, the nearest first, without the stem."""
    depth = np.zeros(len(parent), dtype=np.int64)
    for b, below in enumerate(parent.tolist()):
        depth[b] = depth[below] + 1 if below >= 0 else 0
    return [np.flatnonzero(depth == k) for k in range(1, int(depth.max()) + 1)]


def of_lanes(field: Floats, count: int) -> Floats:
    """Field of records in lanes, (blocks, ..., 16), as rows of branches, (count, ...)."""
    rows = np.moveaxis(field, -1, 1)
    return rows.reshape(-1, *rows.shape[2:])[:count]


def into_lanes(rows: NDArray[Any], field: NDArray[Any]) -> None:
    """Write rows of branches, (b, ...), into a field of records in lanes."""
    block, lane = np.divmod(np.arange(len(rows)), LANES)
    field[block, ..., lane] = rows


def mean_wind_moments(branches: Records, n_coordinates: int) -> Floats:
    """
    Moments (N, 3) [N m] of winds from all sides, as far as they are linear in the wind.

    Those along x and y then serve for any between. Per 1 m/s along x, y and z in level winds of 1
    m/s and 1 kg/m^3.
    """
    xx, yy, zz, xy, xz, yz = branches['projector'].T
    level, slant = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    sides = np.cos((np.arange(8) + 0.5) * np.pi / 8.0)
    across = np.sqrt(np.maximum(level[:, None] + slant[:, None] * sides, 0.0)).mean(axis=1)
    force = np.stack([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 1, 0)
    force = force * (branches['area'] * branches['speed'] ** 2 * across)[:, None, None]
    wrench = np.concatenate([force, branches['coupling'] @ force], axis=1)
    moments = np.zeros((n_coordinates, 3))
    for b in range(len(branches) - 1, -1, -1):
        i, k = int(branches['coordinate'][b]), int(branches['n_coordinates'][b])
        moments[i : i + k] += branches['load_mode'][b, :k] @ force[b]
        below = int(branches['parent'][b])
        if below >= 0:
            wrench[below] += wrench[b]
            i, k = int(branches['coordinate'][below]), int(branches['n_coordinates'][below])
            moments[i : i + k] += branches['twist'][b, :k] @ wrench[b]
    return moments
