# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Static response of a tree to steady winds: the loads on it, and its equilibria.

A wind loads every branch, and motion outside of the span of the coordinates is lost. So the
responses to winds of all directions and speeds are found once, and the coordinates are made of
these and of the responses to gusts (`gust_responses`, `modes.leading_modes`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property, partial
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, WHY_PLAIN
from tree_sway.core.model.load_records import load_records
from tree_sway.core.model.records import WORK
from tree_sway.core.setup.branch_loads import wind_moments
from tree_sway.core.setup.load_derivatives import LoadSlopes
from tree_sway.core.setup.numpy_branch_loads import copies_of, into_slots, NumpyPasses
from tree_sway.core.setup.tree_motion import base_motion, own_motion

_SPEEDS = (10.0, 20.0, 40.0)
_AZIMUTHS = np.arange(8) * np.pi / 4.0
_TURNS, _FARTHEST = 6, 1.0

_TOGETHER = 2000
"""Branches of copies of a tree whose loads are found at once in numpy, for speed."""


class WindMoments:
    """Moments (N,) of uniform winds on the coordinates of a tree that bends and moves."""

    def __init__(self, branches: Records, *, plain: bool = False) -> None:
        """Make scratch memory."""
        self.branches, self._plain = branches, plain or bool(WHY_PLAIN)
        self.n = int(branches['n_coordinates'].sum())
        self._of_copies: dict[int, NumpyPasses] = {}

    def reset(self) -> None:
        """Forget the drag of the last call, which may be of a motion that was not finite."""
        self._records[2]['drag_impulse'] = 0.0

    @cached_property
    def _passes(self) -> NumpyPasses:
        return NumpyPasses(self.branches)

    @cached_property
    def _records(self) -> tuple[Records, Records, Records]:
        return self.branches, np.zeros(len(self.branches), WORK), load_records(self.branches)

    @cached_property
    def _compiled(self) -> Callable[..., Any]:
        rows = np.zeros(self.n), np.zeros(self.n), np.zeros(self.n)
        compiled = entry_of(wind_moments, *self._records, *rows, 0.0, 0.0, 0.0, 0.0)
        return partial(compiled, *self._records)

    def __call__(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Moments by a wind (3,) of 1 kg/m^3 on a tree at x that moves at v, both (N,)."""
        moments = np.empty(self.n)
        self.fill(x, v, wind.tolist(), moments)
        return moments

    def fill(self, x: Floats, v: Floats, wind: Iterable[float], moments: Floats) -> None:
        """Write the moments of a call, (N,); arrays are contiguous."""
        wx, wy, wz = wind
        if self._plain:
            self._in_numpy(x, v, np.array([wx, wy, wz]), moments)
        else:
            self._compiled(x, v, moments, wx, wy, wz, 1.0)

    def at_poses(self, poses: Floats, winds: Floats) -> Floats:
        """Moments (k, N) by winds (k, 3) as in a call, each on the tree held in a pose (k, N)."""
        if not self._plain:
            rest = np.zeros(self.n)
            pairs = zip(poses, winds, strict=True)
            return np.array([self(pose, rest, wind) for pose, wind in pairs])
        together = max(1, _TOGETHER // len(self.branches))
        parts = [slice(i, i + together) for i in range(0, len(poses), together)]
        return np.vstack([self._in_copies(poses[part], winds[part]) for part in parts])

    def _in_copies(self, poses: Floats, winds: Floats) -> Floats:
        """Find the moments of `at_poses` in numpy, on as many copies of the tree, side by side."""
        passes = self._passes_of(len(poses))
        angles = passes.per_branch(poses.ravel())
        bases = passes.outward(angles, np.zeros_like(angles))
        wind = np.repeat(winds, len(self.branches), axis=0)
        still, at_once = np.zeros_like(angles), np.zeros(len(angles))
        force = passes.wind_forces(bases, angles, still, wind, 1.0, at_once, np.zeros_like(wind))
        moments = np.empty(poses.size)
        passes.bent_loads(bases, angles, force, moments)
        return moments.reshape(poses.shape)

    def _passes_of(self, count: int) -> NumpyPasses:
        """Return the passes over a number of copies of the tree; made once."""
        if count not in self._of_copies:
            self._of_copies[count] = NumpyPasses(copies_of(self.branches, count))
        return self._of_copies[count]

    def forces(self, x: Floats, v: Floats, wind: Floats) -> Floats:
        """Find the forces on the branches, (b, 3), by a wind as in a call, in the tree's frame."""
        self(x, v, wind)
        return np.asarray(self._records[1]['force'])

    def _in_numpy(self, x: Floats, v: Floats, wind: Floats, moments: Floats) -> None:
        """Write the moments, and in the records what `LoadSlopes` reads, as the kernel does."""
        passes, n = self._passes, len(self.branches)
        angles, rates = passes.per_branch(x), passes.per_branch(v)
        bases = passes.outward(angles, rates)
        force = passes.wind_forces(bases, angles, rates, wind, 1.0, np.zeros(n), np.zeros((n, 3)))
        _, work, loads = self._records
        work['force'] = passes.bent_loads(bases, angles, force, moments)
        for name in ('orientation', 'rotation', 'displacement', 'arm'):
            work[name] = getattr(bases, name)
        work['wrench'] = passes.wrench
        into_slots(passes.load_rotation(angles), loads['rotation'])
        into_slots(passes.air, loads['air_velocity'])
        into_slots(force, loads['own_force'])

    def at_rest(self, winds: Floats, shapes: Floats) -> Floats:
        """Return loads of winds (k, 3) on shapes (N, m) of a tree at rest, (k, m), at 1 kg/m^3."""
        branches, n = self.branches, len(self.branches)
        moved = base_motion(branches, shapes)
        at = moved[:, :3] + branches['coupling'].swapaxes(1, 2) @ moved[:, 3:]
        at += own_motion(branches, 'load_mode', shapes)
        projector = branches['projector'][:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(n, 3, 3)
        across = projector @ winds.T
        square = np.maximum((across * winds.T).sum(axis=1), 0.0)
        load = (branches['area'] * branches['speed'] ** 2)[:, None] * np.sqrt(square)
        return np.asarray((load[:, None] * across).reshape(3 * n, -1).T @ at.reshape(3 * n, -1))

    def slopes(self, shapes: Floats) -> LoadSlopes:
        """Return the slopes of the loads on some shapes (N, m)."""
        return LoadSlopes(self._records, self, shapes)


def static_responses(
    moments: WindMoments, solve: Callable[[Floats], Floats], pressure: Callable[[float], float]
) -> Floats:
    """
    Find the equilibria of a tree in winds: key rotations [rad], (N, k).

    Parameters
    ----------
    moments
        Loads of the tree.
    solve
        Key rotations under moments [N m], (N,): the inverse of the stiffness.
    pressure
        Dynamic pressure [kg/m/s^2] of a wind in [m/s].

    """
    rest = np.zeros(moments.n)
    directions = np.array([[np.cos(each), np.sin(each), 0.0] for each in _AZIMUTHS])
    winds = np.repeat(directions, len(_SPEEDS), axis=0)
    calm = np.zeros((len(directions), moments.n))
    found = list(solve(moments.at_poses(calm, directions).T).T)
    scale = np.array([pressure(speed) for speed in _SPEEDS])
    x = np.zeros((len(directions), len(scale), moments.n))
    for turn in range(_TURNS):
        loads = moments.at_poses(x.reshape(-1, moments.n), winds)
        scaled = np.tile(scale, len(directions))[:, None] * loads
        x += (solve(scaled.T).T.reshape(x.shape) - x) / (turn + 2.0) ** 0.5
        x *= np.minimum(1.0, _FARTHEST / np.maximum(np.abs(x).max(axis=2), 1e-12))[..., None]
    # Where air has no pressure, none of these winds bends the tree.
    found.extend((x / np.maximum(scale, 1e-300)[:, None]).reshape(-1, moments.n))
    for rise in (-np.pi / 2.0, -np.pi / 4.0, np.pi / 4.0, np.pi / 2.0):
        for azimuth in _AZIMUTHS[::2] if abs(rise) < 1.5 else _AZIMUTHS[:1]:
            level = np.cos(rise)
            wind = np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(rise)])
            found.append(solve(moments(rest, rest, wind)))
    return np.array(found).T
