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

from tree_sway_ros.core.arrays import Floats, Records
from tree_sway_ros.core.motion.numpy_rotation import cayley_turned, cross
from tree_sway_ros.core.motion.records import LANES


class NumpyPasses:
    """
    Outward pass, wind and inward pass over `BRANCH` records, parents before children.

    Subtrees stand in runs.
    """

    def __init__(self, branches: Records) -> None:
        """Take over columns, and sort the branches by level."""
        names = (
            'parent', 'source', 'twist', 'centre', 'flow', 'turn', 'push', 'lever', 'speed',
            'base', 'arm', 'per_arm',
        )  # fmt: skip
        self._of: dict[str, NDArray[Any]] = {
            name: np.ascontiguousarray(branches[name])
            for name in (*names, 'spread', 'area', 'axial_lever', 'frame', 'couple')
        }
        xx, yy, zz, xy, xz, yz = branches['projector'].T
        self._projector = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
        self.levels = levels_of(branches['parent'])
        self._end = subtree_ends(branches['parent'])
        column = np.arange(branches['push'].shape[1])
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
        slip: Floats,
    ) -> Floats:
        """Force of the wind on each branch in [N], (b, 3); the slip (b, 3) is written anew."""
        of = self._of
        motion = base[:, :3] + cross(base[:, 3:6], of['centre'])
        motion += np.einsum('bc,bck->bk', v, of['flow'])
        turn = base[:, 6:] + np.einsum('bc,bck->bk', x, of['turn'])
        free = cayley_turned(-turn, of['speed'][:, None] * wind - motion)
        free += compliance[:, None] * slip
        across = np.einsum('bij,bj->bi', self._projector, free)
        spread = of['spread'] * np.square(v[:, :2]).sum(axis=1)
        speed = np.sqrt(np.maximum(np.einsum('bi,bi->b', free, across), 0.0) + spread)
        c = per_speed_squared * of['area']
        share = 2.0 / (1.0 + np.sqrt(1.0 + 4.0 * compliance * c * speed))
        per_speed = (c * speed * share**2)[:, None]
        slip[:] = per_speed * free
        return cayley_turned(turn, per_speed * across)[of['source']]

    def generalised_loads(
        self, rotation: Floats, force: Floats, carries: bool, moment: Floats
    ) -> Floats:
        """Write moments on the coordinates in [N m], (N,); return pulls along the chords, (b,)."""
        of = self._of
        chord = of['frame'][:, 0]
        turned = cayley_turned(-rotation, force)
        own = np.einsum('bck,bk->bc', of['push'], turned)
        pull: Floats = of['lever'] * np.einsum('bk,bk->b', chord, turned)
        if carries:
            wrench = np.hstack([force, np.einsum('bij,bj->bi', of['couple'], force)])
            total = np.vstack([np.zeros(6), np.cumsum(wrench, axis=0)])
            carried = (total[self._end] - total[:-1])[1:]
            parent = of['parent'][1:]
            np.add.at(own, parent, np.einsum('bck,bk->bc', of['twist'][1:], carried))
            along = np.einsum('bk,bk->b', chord[parent], carried[:, :3])
            np.add.at(pull, parent, of['axial_lever'][1:] * along)
        moment[self._column[self.is_there]] = own[self.is_there]
        return pull

    def bent_loads(self, base: Floats, x: Floats, force: Floats, moment: Floats) -> None:
        """Write moments on the coordinates of a tree as it is bent and turned, (N,), in [N m]."""
        of = self._of
        own_turn = np.einsum('bc,bck->bk', x, of['turn'])
        turned = cayley_turned(-(base[:, 6:] + own_turn), force)
        own = np.einsum('bck,bk->bc', of['push'], turned)
        couple = np.einsum('bij,bj->bi', of['couple'], turned) - cross(of['base'], turned)
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


def even_wind_moments(branches: Records, n_coordinates: int, *, carries: bool = True) -> Floats:
    """
    Moments [N m], (N, 2), of an even wind of 1 m/s and 1 kg/m^3, along x and along y, at rest.

    ``carries`` tells whether what a branch carries pushes on it.
    """
    passes, n = NumpyPasses(branches), len(branches)
    moments, still, none = np.zeros((2, n_coordinates)), np.zeros((n, 9)), np.zeros(n)
    at_rest = np.zeros(branches['push'].shape[:2])
    for moment, wind in zip(moments, np.eye(2, 3), strict=True):
        slip = np.zeros((n, 3))
        force = passes.wind_forces(still, at_rest, at_rest, wind, 1.0, none, slip)
        passes.generalised_loads(still[:, 6:], force, carries, moment)
    return moments.T


def levels_of(parent: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Branches as many steps from the stem as each other, the nearest first, without the stem."""
    depth = np.zeros(len(parent), dtype=np.int64)
    for b, below in enumerate(parent.tolist()):
        depth[b] = depth[below] + 1 if below >= 0 else 0
    return [np.flatnonzero(depth == k) for k in range(1, int(depth.max()) + 1)]


def subtree_ends(parent: NDArray[np.int64]) -> NDArray[np.int64]:
    """One past the last branch of each subtree, (b,)."""
    end = np.arange(1, len(parent) + 1)
    for b in range(len(parent) - 1, 0, -1):
        end[parent[b]] = max(end[parent[b]], end[b])
    return end


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

    Those along x and y then stand for any between. Per 1 m/s along x, y and z in level winds of 1
    m/s and 1 kg/m^3.
    """
    xx, yy, zz, xy, xz, yz = branches['projector'].T
    level, slant = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    sides = np.cos((np.arange(8) + 0.5) * np.pi / 8.0)
    across = np.sqrt(np.maximum(level[:, None] + slant[:, None] * sides, 0.0)).mean(axis=1)
    force = np.stack([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 1, 0)
    force = force * (branches['area'] * branches['speed'] ** 2 * across)[:, None, None]
    wrench = np.concatenate([force, branches['couple'] @ force], axis=1)
    moments = np.zeros((n_coordinates, 3))
    for b in range(len(branches) - 1, -1, -1):
        i, k = int(branches['coordinate'][b]), int(branches['n_coordinates'][b])
        moments[i : i + k] += branches['push'][b, :k] @ force[b]
        below = int(branches['parent'][b])
        if below >= 0:
            wrench[below] += wrench[b]
            i, k = int(branches['coordinate'][below]), int(branches['n_coordinates'][below])
            moments[i : i + k] += branches['twist'][b, :k] @ wrench[b]
    return moments
