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
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, WHY_PLAIN
from tree_sway.core.model.drag_law import drag_density, DragLaw
from tree_sway.core.model.load_layouts import WORK
from tree_sway.core.model.load_records import load_records
from tree_sway.core.setup.branch_loads import wind_moments
from tree_sway.core.setup.load_derivatives import LoadSlopes
from tree_sway.core.setup.numpy_branch_loads import (
    copies_of,
    into_slots,
    NumpyPasses,
    symmetric_matrices,
)
from tree_sway.core.setup.tree_motion import base_motion, own_motion

_SPEEDS = (10.0, 20.0, 40.0)
_AZIMUTHS = np.arange(8) * np.pi / 4.0
_TURNS = 6
_FARTHEST = 1.0
"""Largest key rotation of a pose in [rad]."""

_TOGETHER = 2000
"""Branches of copies of a tree whose loads are found at once in numpy, for speed."""


class WindMoments:
    """Moments (N,) of uniform winds on the coordinates of a tree that bends and moves."""

    def __init__(self, branches: Records) -> None:
        """Make scratch memory."""
        self.branches = branches
        self._plain = bool(WHY_PLAIN)
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
        parts = []
        for first in range(0, len(poses), together):
            part = slice(first, first + together)
            parts.append(self._in_copies(poses[part], winds[part]))
        return np.vstack(parts)

    def _in_copies(self, poses: Floats, winds: Floats) -> Floats:
        """Find the moments of `at_poses` in numpy, on as many copies of the tree, side by side."""
        passes = self._passes_of(len(poses))
        angles = passes.per_branch(poses.ravel())
        bases = passes.outward(angles, np.zeros_like(angles))
        wind = np.repeat(winds, len(self.branches), axis=0)
        still = np.zeros_like(angles)
        at_once = np.zeros(len(angles))
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
        passes = self._passes
        count = len(self.branches)
        angles = passes.per_branch(x)
        rates = passes.per_branch(v)
        bases = passes.outward(angles, rates)
        at_once = np.zeros(count)
        impulse = np.zeros((count, 3))
        force = passes.wind_forces(bases, angles, rates, wind, 1.0, at_once, impulse)
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
        branches = self.branches
        n_components = 3 * len(branches)
        base = base_motion(branches, shapes)
        moved = base[:, :3] + branches['coupling'].swapaxes(1, 2) @ base[:, 3:]
        moved += own_motion(branches, 'load_mode', shapes)
        projector = symmetric_matrices(branches['projector'])
        across = projector @ winds.T
        square = np.maximum((across * winds.T).sum(axis=1), 0.0)
        area = branches['area'] * branches['speed'] ** 2
        per_velocity = area[:, None] * np.sqrt(square)
        force = per_velocity[:, None] * across
        by_wind = force.reshape(n_components, -1).T
        return np.asarray(by_wind @ moved.reshape(n_components, -1))

    def slopes(self, shapes: Floats) -> LoadSlopes:
        """Return the slopes of the loads on some shapes (N, m)."""
        return LoadSlopes(self._records, self, shapes)


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
