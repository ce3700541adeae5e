# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Inertia and weight of a tree as it is bent, from the poses of its segments.

The reduced equations have mass and weight of the tree at rest. A tree that leans has others: the
crown of a bent stem swings sideways as the stem twists, and the weight of a limp twig loses its
lever as the twig hangs down. Both are found by moving the placed tree along each coordinate.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of
from tree_sway.core.motion.fill_records import block_records
from tree_sway.core.motion.modal import ModalBank
from tree_sway.core.motion.placing import GIVEN, place, room_for
from tree_sway.core.tree.segment_frame import ends_of_poses

_Found = TypeVar('_Found')

_LEADING = 12
"""
Number of coordinates whose inertia and weight change: those that do most of the motion.

The others are fast, and follow the load. Errors of trees of nine kinds are least with 8 to 14.
"""

_STEP = 2e-3
"""Largest rotation by which a pose is moved [rad]."""

_UNTURNED = np.deg2rad(1.0)
"""Rotation of a branch up to which the force of the weight is not found again [rad]."""

_LIGHTER, _HEAVIER = 0.5, 2.0
"""Range of the inertia of any motion, over that at rest."""


class BentTree:
    """
    A tree that is placed by its coordinates.

    Parameters
    ----------
    bank
        Bank of the coordinates.
    segments, instance
        Records of `segment_layout`; an instance, by which `place` is compiled once.
    mass, length
        Mass [kg] and length [m] of each segment, (n,).
    gravity
        Gravity in [m/s^2].

    Attributes
    ----------
    count
        Number of leading coordinates, q.

    """

    def __init__(
        self, bank: ModalBank, segments: Records, instance: Records, mass: Floats, length: Floats,
        gravity: float,
    ) -> None:  # fmt: skip
        """Find inertia and weight at rest."""
        self._shapes = bank.shapes
        n, m = bank.shapes.shape
        self.count = min(_LEADING, m)
        self._mass, self._half, self._gravity = mass, 0.5 * length, gravity
        blocks, bases = block_records(bank.branches, segments), np.zeros((len(bank.branches), 8))
        origin, self._poses = np.zeros(3), np.zeros((len(mass), 7))
        first = instance, GIVEN[1], segments, blocks, bases, 1.0, 0.0, 1.0, room_for(n)
        compiled = entry_of(place, *first, np.zeros(1), origin, self._poses)
        self._place = lambda x: compiled(*first, x, origin, self._poses)
        self._steps = _STEP / np.maximum(np.abs(bank.shapes).max(axis=0), 1e-12)
        at_rest = np.zeros(m)
        self._inertia = self._inertia_at(at_rest)
        self._force, self._turned = np.zeros(m), np.zeros(n)
        self._lift, self._linear = self._lift_at(at_rest), np.zeros((self.count, m))
        for k, step in enumerate(self._steps if gravity > 0.0 else ()):
            self._linear[:, k] = (self._lift_at(step * np.eye(m)[k]) - self._lift) / step

    def inverse_inertia(self, at: Floats) -> Floats:
        """Return the inverse inertia of the leading coordinates at a pose (m,), (q, q)."""
        change = self._inertia_at(at) - self._inertia
        inertias, motions = np.linalg.eigh(np.eye(self.count) + change)
        return np.asarray((motions / np.clip(inertias, _LIGHTER, _HEAVIER)) @ motions.T)

    def weight(self, at: Floats) -> Floats:
        """
        Force of the weight on all coordinates at a pose, beyond the linear one, both (m,).

        It is that of the last pose where no branch has rotated by more than `_UNTURNED` since.
        """
        x = self._shapes @ at
        if self._gravity > 0.0 and np.abs(x - self._turned).max() > _UNTURNED:
            self._force[: self.count] = self._lift + self._linear @ at - self._lift_at(at)
            self._turned = x
        return self._force

    def _inertia_at(self, at: Floats) -> Floats:
        here, ahead = self._around(at, self._middles)
        moved = (np.array(ahead) - here) / self._steps[: self.count, None, None]
        flat = moved.reshape(self.count, -1)
        return np.asarray((flat * np.repeat(self._mass, 3)) @ flat.T)

    def _lift_at(self, at: Floats) -> Floats:
        """Potential of the weight per unit of each leading coordinate, (q,)."""
        here, ahead = self._around(at, self._potential)
        return np.asarray((np.array(ahead) - here) / self._steps[: self.count])

    def _around(self, at: Floats, found: Callable[[Floats], _Found]) -> tuple[_Found, list[_Found]]:
        """Return what is found at a pose, and as each leading coordinate is moved by its step."""
        x = self._shapes @ at
        moves = self._shapes[:, : self.count] * self._steps[: self.count]
        return found(x), [found(x + move) for move in moves.T]

    def _potential(self, x: Floats) -> float:
        self._place(x)
        qx, qy, qz, qw = self._poses[:, 3:].T
        risen = self._poses[:, 2] @ self._mass
        risen += 2.0 * ((qx * qz - qw * qy) @ (self._half * self._mass))
        return self._gravity * float(risen)

    def _middles(self, x: Floats) -> Floats:
        self._place(x)
        return ends_of_poses(self._poses, self._half)[1]
