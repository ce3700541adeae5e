# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Forces that people and machines put on a tree for a while.

A force f at a place p does ``J^T f`` to the key rotations x, ``J = dp/dx`` as the tree is bent
now. Only the branches between the place and the root move it, so that J is found by placing the
tree once for each of their coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_read, within
from tree_sway.core.simulator.bank import Bank
from tree_sway.core.simulator.settings import STIFFEST
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError

LONGEST_PUSH = 3600.0
"""Longest time in [s] that a push may be asked to last."""

MOST_PUSHES = 64
"""Segments of a tree that are pushed at once, at most."""

_RENEWED = 0.1
"""Time in [s] after which the lever of a push is found again, as the tree has moved."""

_TURN = 1e-6
"""Turn in [rad] by which derivatives are found."""

_LITTLE = 1e-3
"""Force in [N] by which a step's compliance is found."""


def row_of(segment: int, count: int) -> int:
    """Return a segment, if it is a whole number below a count; else a `ParameterError`."""
    if not (isinstance(segment, int | np.integer) and 0 <= segment < count):
        cure = f'name one of 0 .. {count - 1}'
        raise ParameterError(f'no segment {segment}', where='push', cure=cure)
    return int(segment)


class Spring(NamedTuple):
    """
    A spring from a segment to a place ``to`` [m], (3,), of a stiffness [N/m].

    It pulls no more stiffly than a time step can follow, as a hand at a branch does.
    """

    to: ArrayLike
    stiffness: float


@dataclass
class Push:
    """
    A force [N] on a segment at a distance from its root side [m], for a time left [s].

    ``lever`` is J, (3, N), found again after the time ``renewed_in``. With a ``stiffness`` [N/m]
    it is a spring to the place ``force`` [m], and ``compliance`` [m/N] how far a force moves the
    segment within a step, (3, 3).
    """

    segment: int
    away: float
    force: Floats
    left: float
    lever: Floats
    renewed_in: float = 0.0
    stiffness: float = 0.0
    compliance: Floats = field(default_factory=lambda: np.eye(3))

    def at(self, place: Floats, share: float) -> Floats:
        """Return the force [N], (3,), at a place, for a share of the step."""
        if not self.stiffness:
            return share * self.force
        # Implicit, by the force at the end of the step, and no stiffer than a step can follow.
        k = share * min(self.stiffness, 0.5 / float(np.trace(self.compliance)))
        matrix = np.eye(3) + k * self.compliance
        pull: Floats = np.linalg.solve(matrix, k * (self.force - place)).astype(np.float64)
        return pull

    def place(self, poses: Floats) -> Floats:
        """Return where it acts in a pose block (n, 7), in [m], (3,)."""
        on = slice(self.segment, self.segment + 1)
        return ends_of_poses(poses[on], [self.away])[1][0]


class Touch:
    """Pushes on one tree, one per segment."""

    def __init__(self, tree: Tree, bank: Bank) -> None:
        """Begin without a push; a `ParameterError` on a model that cannot be pushed."""
        self._tree, self._bank = tree, bank
        self._pushes: dict[int, Push] = {}
        self._poses = np.zeros((tree.n_segments, 7))
        self._n_rotations = len(bank.oscillators.rotations())
        bank.oscillators.push(np.zeros(self._n_rotations))
        self.load = np.zeros(6)
        """Force [N] and moment about the root node [N m] of the last step's pushes."""

    @property
    def is_active(self) -> bool:
        """Whether anybody pushes."""
        return bool(self._pushes)

    def add(self, segment: int, force: ArrayLike | Spring, seconds: float, along: float) -> None:
        """Begin a push, or change that on the same segment; a `ParameterError` as of `push`."""
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
        push = Push(row, away, given, left, np.zeros((3, self._n_rotations)))
        push.stiffness = stiffness
        before = self._pushes.get(push.segment)
        if before is None and len(self._pushes) >= MOST_PUSHES:
            raise ParameterError(f'more than {MOST_PUSHES} pushes at once', where='push')
        is_spring = stiffness > 0.0
        if before is not None and (before.away, before.stiffness > 0.0) == (away, is_spring):
            push.lever, push.renewed_in = before.lever, before.renewed_in
            push.compliance = before.compliance
        self._pushes[push.segment] = push

    def step(self, poses: Floats, origin: Floats, dt: float) -> int:
        """Push for a step [s] in a pose block (n, 7); how many moments were clamped."""
        moments = np.zeros(self._n_rotations)
        self.load[:] = 0.0
        for push in list(self._pushes.values()):
            place = push.place(poses)
            if push.renewed_in <= 0.0:
                self._renew(push, place, origin, self._bank.oscillators.rotations().copy())
            force = push.at(place, min(1.0, push.left / dt))
            moments += force @ push.lever
            self.load += [*force, *np.cross(place - origin, force)]
            push.left -= dt
            push.renewed_in -= dt
            if push.left <= 1e-9 * dt:
                del self._pushes[push.segment]
        return self._bank.oscillators.push(moments)

    def _renew(self, push: Push, place: Floats, origin: Floats, x: Floats) -> None:
        """Find how a place (3,) of the tree moves as it is bent, by key rotations x (N,)."""
        branches = self._bank.branches
        # A branch that is cut has a record per piece.
        holds = (branches['first'] <= push.segment) & (push.segment < branches['end'])
        branch = int(np.flatnonzero(holds)[0])
        while branch >= 0:
            first = int(branches['coordinate'][branch])
            for i in range(first, first + int(branches['n_coordinates'][branch])):
                x[i] += _TURN
                self._bank.place(x, origin, self._poses)
                push.lever[:, i] = (push.place(self._poses) - place) / _TURN
                x[i] -= _TURN
            branch = int(branches['parent'][branch])
        push.renewed_in = _RENEWED
        if push.stiffness:
            self._find_compliance(push)

    def _find_compliance(self, push: Push) -> None:
        """Find how far a force moves the segment within a step, by trying it in each direction."""
        oscillators = self._bank.oscillators
        memory, before = oscillators.memory(), oscillators.rotations().copy()
        kept = [each.copy() for each in memory]
        for axis, moments in enumerate(push.lever):
            oscillators.push(_LITTLE * moments)
            moved = push.lever @ (oscillators.rotations() - before)
            push.compliance[:, axis] = moved / _LITTLE
            for each, value in zip(memory, kept, strict=True):
                each[...] = value
