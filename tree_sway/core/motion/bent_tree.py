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
from functools import cached_property
from typing import TypeVar

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.segment_frame import ends_of_poses

_Found = TypeVar('_Found')

_LEADING = 12
"""
Number of coordinates whose inertia and weight change: those that do most of the motion.

The others are fast, and follow the load. Errors of trees of nine kinds are least with 6 to 14.
"""

_STEP = 2e-3
"""Largest rotation by which a pose is moved [rad]."""

_FAR = 10.0
"""Steps by which the tree is bent to find how its inertia changes."""

_UNTURNED = np.deg2rad(1.0)
"""Rotation of a branch up to which the force of the weight is not found again [rad]."""

MOST_CHANGE = 0.5
"""Largest change of the inertia of any motion, over that at rest."""


class BentTree:
    """
    A tree that is placed by its coordinates.

    Parameters
    ----------
    place
        Function that places segments by key rotations, as `Bank.place`.
    shapes
        Key rotations per unit of each coordinate, (N, m).
    mass, length
        Mass [kg] and length [m] of each segment, (n,).
    gravity
        Gravity in [m/s^2].

    """

    def __init__(
        self, place: Callable[[Floats, Floats, Floats], None], shapes: Floats, mass: Floats,
        length: Floats, gravity: float,
    ) -> None:  # fmt: skip
        """Begin at rest."""
        self._place, self._shapes, self._mass, self._half = place, shapes, mass, 0.5 * length
        self._gravity, self._origin, self._poses = gravity, np.zeros(3), np.zeros((len(mass), 7))
        self._count = min(_LEADING, shapes.shape[1])
        self._steps = _STEP / np.maximum(np.abs(shapes).max(axis=0), 1e-12)
        self._force, self._turned = np.zeros(shapes.shape[1]), np.zeros(len(shapes))

    @cached_property
    def inertia_slopes(self) -> Floats:
        """Slopes of the inertia of leading coordinates, by each as the last axis, (q, q, q)."""
        bent = np.diag(_FAR * self._steps)[: self._count]
        changes = [self._inertia_at(one) - self._inertia_at(-one) for one in bent]
        return np.stack(changes, axis=-1) / (2.0 * _FAR * self._steps[: self._count])

    def weight(self, at: Floats) -> Floats:
        """
        Force of the weight on all coordinates at a pose, beyond the linear one, both (m,).

        It is that of the last pose where no branch has rotated by more than `_UNTURNED` since.
        """
        x = self._shapes @ at
        if self._gravity > 0.0 and np.abs(x - self._turned).max() > _UNTURNED:
            lift, linear = self._at_rest
            self._force[: self._count] = lift + linear @ at - self._lift_at(at)
            self._turned = x
        return self._force

    @cached_property
    def _at_rest(self) -> tuple[Floats, Floats]:
        """Lift at rest, (q,), and its slopes by all coordinates, (q, m)."""
        rest = self._lift_at(np.zeros(len(self._steps)))
        moved = [self._lift_at(step) - rest for step in np.diag(self._steps)]
        return rest, np.stack(moved, axis=1) / self._steps

    def _inertia_at(self, at: Floats) -> Floats:
        here, ahead = self._around(at, self._middles)
        moved = (np.array(ahead) - here) / self._steps[: self._count, None, None]
        flat = moved.reshape(self._count, -1)
        return np.asarray((flat * np.repeat(self._mass, 3)) @ flat.T)

    def _lift_at(self, at: Floats) -> Floats:
        """Potential of the weight per unit of each leading coordinate, (q,)."""
        here, ahead = self._around(at, self._potential)
        return np.asarray((np.array(ahead) - here) / self._steps[: self._count])

    def _around(
        self, at: Floats, found: Callable[[Floats], _Found]
    ) -> tuple[_Found, list[_Found]]:
        """Return what is found at a pose, and as each leading coordinate is moved by its step."""
        x = self._shapes @ at
        moves = self._shapes[:, : self._count] * self._steps[: self._count]
        return found(x), [found(x + move) for move in moves.T]

    def _potential(self, x: Floats) -> float:
        self._place(x, self._origin, self._poses)
        qx, qy, qz, qw = self._poses[:, 3:].T
        risen = self._poses[:, 2] @ self._mass
        risen += 2.0 * ((qx * qz - qw * qy) @ (self._half * self._mass))
        return self._gravity * float(risen)

    def _middles(self, x: Floats) -> Floats:
        self._place(x, self._origin, self._poses)
        return ends_of_poses(self._poses, self._half)[1]


def inertia_change(slopes: Floats, at: Floats) -> Floats:
    """Change of the inertia of the leading coordinates at a pose (m,), bounded, (q, q)."""
    change: Floats = slopes @ at[: len(slopes)]
    return change * min(1.0, MOST_CHANGE / max(float(np.linalg.norm(change)), 1e-300))
