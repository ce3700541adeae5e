# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forces that people and machines put on a tree for a while."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.simulator.bank import Bank
from tree_sway.core.simulator.pull import moments_of_force
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError

LONGEST_PUSH = 3600.0
"""A push ends at the latest after this time [s], should nobody end it."""


@dataclass
class _Push:
    """A force [N], where on its segment it acts as a share of the length, and time left [s]."""

    force: Floats
    along: float
    left: float


def force_of(given: ArrayLike) -> Floats | None:
    """Return three finite numbers as an array; None for anything else."""
    try:
        force = np.array(given, dtype=np.float64)
    except (ValueError, TypeError):
        return None
    return force if force.shape == (3,) and np.isfinite(force).all() else None


class Touch:
    """
    Pushes on one tree, one per segment.

    Each acts at a place that moves with the tree, and is found as moments on the key rotations in
    the pose before the step.
    """

    def __init__(self, tree: Tree, bank: Bank) -> None:
        """Begin without a push; a `ParameterError` on a model that cannot be pushed."""
        self._tree, self._bank = tree, bank
        self._pushes: dict[int, _Push] = {}
        self._moments, self._all = np.zeros((2, *bank.oscillators.rotations().shape))
        bank.oscillators.push(self._all)
        self.load = np.zeros(6)
        """Force [N] and moment about the root node [N m] of the last step's pushes."""

    def add(self, segment: int, force: ArrayLike, seconds: float, along: float) -> None:
        """Begin a push, or change that on the same segment; a `ParameterError` as of `push`."""
        given = force_of(force)
        if not (isinstance(segment, int | np.integer) and 0 <= segment < self._tree.n_segments):
            cure = f'name one of 0 .. {self._tree.n_segments - 1}'
            raise ParameterError(f'no segment {segment}', where='push', cure=cure)
        if given is None:
            raise ParameterError(f'a force of {force!r}', where='push', cure='give x, y, z in N')
        if not (0.0 <= along <= 1.0 and 0.0 < seconds <= LONGEST_PUSH):
            raise ParameterError(
                f'{seconds} s at {along} of a segment',
                where='push',
                cure=f'give up to {LONGEST_PUSH:g} s and a share of 0 .. 1',
            )
        self._pushes[int(segment)] = _Push(given, along, seconds)

    def step(self, poses: Floats, origin: Floats, dt: float) -> int:
        """Push for a step [s] in a pose block (n, 7); how many moments were clamped."""
        self._all[:], self.load[:] = 0.0, 0.0
        bank, tree = self._bank, self._tree
        for segment, push in list(self._pushes.items()):
            force = push.force * min(1.0, push.left / dt)
            away = push.along * tree.length[segment]
            place = poses[segment, :3] + Rotation.from_quat(poses[segment, 3:]).apply(
                (away, 0.0, 0.0)
            )
            # A branch that is cut has a record per piece.
            first, end = bank.branches['first'], bank.branches['end']
            branch = int(np.flatnonzero((first <= segment) & (segment < end))[0])
            moments_of_force(
                bank.branches, bank.segments, tree.rest_frame, poses, bank.oscillators.rotations(),
                branch, segment, place, force, self._moments,
            )  # fmt: skip
            self._all += self._moments
            self.load += [*force, *np.cross(place - origin, force)]
            push.left -= dt
            if push.left <= 1e-9 * dt:
                del self._pushes[segment]
        return bank.oscillators.push(self._all)

    @property
    def is_active(self) -> bool:
        """Whether anybody pushes."""
        return bool(self._pushes)

    def clear(self) -> None:
        """End every push."""
        self._pushes.clear()
        self.load[:] = 0.0
