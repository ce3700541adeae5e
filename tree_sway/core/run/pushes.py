# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Forces of limited duration on segments of a tree, as by a hand.

A force f at a place p acts on the key rotations x by ``J^T f``, with ``J = dp/dx`` in the present
pose. Only the branches between the place and the root move it, so that J is found by placing the
tree once for each of their coordinates. The static correction for shapes outside of the model
(`Push.residual`) follows the force within `SETTLES`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_read, within
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.modal_coordinates import FARTHEST
from tree_sway.core.settings import STIFFEST
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.errors import ParameterError

LONGEST_PUSH = 3600.0
"""Longest duration of a push in [s]."""

MOST_PUSHES = 64
"""Largest number of segments of a tree that are pushed at once."""

_RENEWED = 0.1
"""Time in [s] after which the lever of a push is computed again, as the tree moves."""

_TURN = 1e-6
"""Rotation in [rad] for difference quotients."""

SETTLES = 0.05
"""Time constant in [s] of the static correction for shapes outside of the model."""

_LEAST_GIVE = 0.5 / STIFFEST
"""
Give of a place in a time step [m/N] below which it does not limit a spring; 0 at the root node.
"""

_GONE = 1e-3
"""Share of the correction, and rotation in [rad], below which a push is over."""


def row_of(segment: int, count: int) -> int:
    """Return a segment, if it is a whole number below a count; else a `ParameterError`."""
    if not (isinstance(segment, int | np.integer) and 0 <= segment < count):
        cure = f'name one of 0 .. {count - 1}'
        raise ParameterError(f'no segment {segment}', where='push', cure=cure)
    return int(segment)


class Spring(NamedTuple):
    """
    A spring from a segment to a place ``to`` [m], (3,), of a stiffness [N/m].

    Its stiffness is limited by the time step.
    """

    to: ArrayLike
    stiffness: float


@dataclass
class Push:
    """
    A force [N] on a segment at a distance from its root side [m], for a time left [s].

    ``lever`` is J, (3, N), computed again after the time ``renewed_in``. With a ``stiffness``
    [N/m] it is a spring to the place ``force`` [m]. ``by_mode`` is J on the model's coordinates,
    (3, m), ``residual`` the static correction of key rotations between it and the root per force,
    (N, 3).
    """

    segment: int
    away: float
    force: Floats
    left: float
    lever: Floats
    by_mode: Floats
    residual: Floats
    renewed_in: float = 0.0
    stiffness: float = 0.0

    def place(self, poses: Floats) -> Floats:
        """Return where it acts in a pose block (n, 7), in [m], (3,)."""
        on = slice(self.segment, self.segment + 1)
        return ends_of_poses(poses[on], [self.away])[1][0]


class Touch:
    """Pushes on one tree, one per segment."""

    def __init__(self, tree: Tree, bank: Bank) -> None:
        """Begin without a push; a `ParameterError` on a model that cannot be pushed."""
        self._tree = tree
        self._bank = bank
        self._oscillators: Any = bank.oscillators
        self.pushes: dict[int, Push] = {}
        """Active pushes by their segments."""
        self._poses = np.zeros((tree.n_segments, 7))
        if not hasattr(bank.oscillators, 'compliance'):
            cure = 'use a number of coordinates, auto or full'
            raise ParameterError("a push on model 'branch'", cure=cure)
        self.load = np.zeros(6)
        """Force [N] and moment about the root node [N m] of the last step's pushes."""
        self.residual = np.zeros(len(bank.oscillators.rotations()))
        """Static correction of the pushed branches [rad], (N,)."""
        self._keys: list[int] = []
        self._share = 0.0

    @property
    def is_gone(self) -> bool:
        """Whether pushes have no effect beyond the state of the model."""
        return not self.pushes and max(self._share, np.abs(self.residual).max()) < _GONE

    def beyond(self, rotations: Floats) -> Floats:
        """
        Return the corrections of pushed branches to key rotations (N,) in [rad].

        They are pairs of the number of a key rotation and a rotation [rad], (k, 2).
        """
        missed = self._share * (self._oscillators.rotations() - rotations) + self.residual
        return np.stack([self._keys, missed[self._keys]], axis=1)

    def add(self, segment: int, force: ArrayLike | Spring, seconds: float, along: float) -> None:
        """Begin a push, or change that on the same segment; raises as `push`."""
        stiffness = 0.0
        if isinstance(force, Spring):
            force, stiffness = force
            within('push: stiffness', stiffness, 0.0, STIFFEST, 'N/m', above=True)
        row = row_of(segment, self._tree.n_segments)
        given = array_to_read('push', force, (3,)).copy()
        if not np.isfinite(given).all():
            raise ParameterError(f'a force of {force!r}', where='push', cure='give x, y, z in N')
        left = within('push: seconds', seconds, 0.0, LONGEST_PUSH, 's', above=True)
        away = within('push: along', along, 0.0, 1.0) * float(self._tree.length[segment])
        push = self.pushes.get(row)
        if push is None and len(self.pushes) >= MOST_PUSHES:
            raise ParameterError(f'more than {MOST_PUSHES} pushes at once', where='push')
        if push is None or push.away != away:
            lever = np.zeros((3, len(self.residual)))
            push = Push(row, away, given, left, lever, lever, lever.T.copy())
        self.pushes[row] = replace(push, force=given, left=left, stiffness=stiffness)

    def step(self, place_all: Callable[[], Floats], dt: float) -> int:
        """Apply the pushes for a step [s]; returns how many moments were clamped."""
        moments = np.zeros(len(self.residual))
        self.load[:] = 0.0
        settled = 1.0 - math.exp(-dt / SETTLES)
        self.residual *= 1.0 - settled
        self._share += settled * (bool(self.pushes) - self._share)
        poses = place_all()
        residual = self.residual.copy()
        eta, rate, total = self._oscillators.swing
        per_force, rate_per_force = self._oscillators.per_force()
        for push in list(self.pushes.values()):
            place = push.place(poses)
            if push.renewed_in <= 0.0:
                self._renew(push, place, self._oscillators.rotations() + residual)
            force = (share := min(1.0, push.left / dt)) * push.force
            if push.stiffness:
                # Implicit, by the force at the end of the step, with the stiffness that it can
                # follow.
                give = per_force * push.by_mode @ push.by_mode.T
                most = 0.5 / max(float(np.trace(give)), _LEAST_GIVE)
                k = share * min(push.stiffness, most)
                give += settled * push.lever @ push.residual
                force = np.linalg.solve(np.eye(3) + k * give, k * (push.force - place))
            moments += force @ push.lever
            self.residual += settled * push.residual @ force
            self.load += [*force, *np.cross(place - self._tree.start[0], force)]
            push.left -= dt
            push.renewed_in -= dt
            if push.left <= 1e-9 * dt:
                del self.pushes[push.segment]
        np.clip(self.residual, -FARTHEST, FARTHEST, out=self.residual)
        limit = self._oscillators.limit
        modal_force = self._oscillators.shapes.T @ np.clip(moments, -limit, limit)
        eta += per_force * modal_force
        rate += rate_per_force * modal_force
        total += modal_force
        return int((np.abs(moments) > limit).sum())

    def _renew(self, push: Push, place: Floats, x: Floats) -> None:
        """Find the motion of a place (3,) by key rotations x (N,)."""
        branches = self._bank.branches
        # A branch that is cut has one record per piece.
        has_segment = (branches['first'] <= push.segment) & (push.segment < branches['end'])
        branch = int(np.flatnonzero(has_segment)[0])
        keys = list[int]()
        residual = push.residual
        by_branch, modes = self._oscillators.compliance
        while branch >= 0:
            record = branches[branch]
            first = int(record['coordinate'])
            count = int(record['n_coordinates'])
            for i in (own := range(first, first + count)):
                x[i] += _TURN
                self._bank.place(x, self._poses)
                push.lever[:, i] = (push.place(self._poses) - place) / _TURN
                x[i] -= _TURN
            residual[own] = by_branch[own, :count] @ push.lever[:, own].T
            keys += own
            branch = int(record['parent'])
        push.by_mode = push.lever @ (shapes := self._oscillators.shapes)
        # Residual flexibility (MacNeal 1971) of the branches to the root.
        residual[keys] -= shapes[keys] @ (modes @ push.by_mode.T)
        push.renewed_in = _RENEWED
        self._keys = list(dict.fromkeys([*self._keys, *keys]))
