# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Inertia, centrifugal force and weight of a tree at the pose it has, in its own coordinates.

With p the middles of the segments, m their masses and ``J = dp/dq``, Lagrange's equations of the
tree are (Shabana 2020, *Dynamics of Multibody Systems*, chapter 3)

    M q'' + J' m (dJ/dt) q' = forces + J' m g,   M = J' m J.

All three are found by placing the tree: a column of J is the difference of two places of the
segments, and the centrifugal force the second difference along the motion. **Columns are renewed
in turn**, `RENEWED` a step, so that one is at most some tenth of a second old: M is a product of
a matrix with itself, and so is positive definite however old its columns are.

**No energy comes of it.** In truth the change of M and the centrifugal force do no work together.
So the rates are scaled to the kinetic energy that they had before a renewal, and what the
centrifugal force has along the motion is left out.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run.middles import Middles

LEADING = 60
"""Largest number of coordinates whose inertia is that of the pose; others keep that at rest."""

RENEWED, OLDEST = 4, 0.3
"""
Least number of columns that a step renews, and the largest rotation [rad] of a branch between two
renewals of a column.
"""

_COLUMN_TURN, _MOTION_TURN = 1e-5, 1e-2
"""Largest key rotation [rad] of the differences for a column, and along the motion."""


class PoseInertia:
    """
    Inertia of a tree at its pose, relative to that at rest.

    Parameters
    ----------
    middles
        Places the tree.
    shapes
        Key rotations per unit of each coordinate, (N, m), of which the first q are leading.
    gravity
        Gravity on each of the `Middles` over its factor, (3 n,).
    weight_slopes
        Derivative of the weight's force on the coordinates by each of them, at rest, (m, m).

    """

    def __init__(
        self, middles: Middles, shapes: Floats, gravity: Floats, weight_slopes: Floats
    ) -> None:
        self._middles, self._gravity = middles, gravity
        self._room, self._other = np.zeros((2, len(gravity)))
        at_rest = self._columns_at_rest(shapes)
        self._place_at_rest = middles.fill(0.0 * shapes[:, 0], np.zeros(len(gravity)))
        self._force_at_rest, self._slopes = at_rest @ gravity, weight_slopes
        # The model's coordinates have unit mass, that of its points to some percent.
        q = min(LEADING, shapes.shape[1])
        unit = np.linalg.inv(np.linalg.cholesky(at_rest[:q] @ at_rest[:q].T))
        self._directions = np.ascontiguousarray((shapes[:, :q] @ unit.T).T)
        self._step = _COLUMN_TURN / np.maximum(np.abs(self._directions).max(axis=1), 1e-300)
        self._at_rest, self._weight_slopes = unit @ at_rest[:q], unit @ weight_slopes[:q]
        self._weight_at_rest = self._at_rest @ gravity
        self.columns = self._at_rest.copy()
        """J of the leading coordinates, times the square roots of the masses, (q, 3 n)."""
        self.change = np.zeros((q, q))
        """M less that at rest, which is 1, (q, q)."""
        self.weight = np.zeros(q)
        """Force of the weight beyond that which is linear in the coordinates, (q,)."""
        self._next = 0

    def _columns_at_rest(self, shapes: Floats) -> Floats:
        """Find J at rest by central differences, (q, 3 n)."""
        columns = np.zeros((shapes.shape[1], len(self._gravity)))
        for shape, column in zip(shapes.T, columns, strict=True):
            turn = _COLUMN_TURN / max(float(np.abs(shape).max()), 1e-300)
            ahead = self._middles.fill(turn * shape, self._room)
            behind = self._middles.fill(-turn * shape, self._other)
            column[:] = (ahead - behind) / (2.0 * turn)
        return columns

    def reset(self) -> None:
        """Return to rest."""
        self.columns[:] = self._at_rest
        self.change[:] = 0.0
        self.weight[:] = 0.0
        self._next = 0

    def renew(
        self, eta: Floats, rotations: Floats, here: Floats, rate: Floats, turned: float
    ) -> None:
        """
        Renew the next columns at a pose, and keep the kinetic energy of a motion.

        Parameters
        ----------
        eta, rotations, here
            Coordinates (m,) of the pose, its key rotations (N,), and the `Middles` there.
        rate
            Rates of the coordinates, (m,), scaled.
        turned
            Largest rotation of a branch in the step, [rad].

        """
        count = len(self.change)
        if turned < OLDEST:
            count = min(count, max(RENEWED, math.ceil(count * turned / OLDEST)))
        rows = (self._next + np.arange(count)) % len(self.change)
        self._next = int(rows[-1] + 1) % len(self.change)
        before = self.twice_kinetic_energy(rate)
        for row in rows.tolist():
            step = self._step[row]
            column = self.columns[row]
            self._middles.fill(rotations + step * self._directions[row], column)
            column -= here
            column /= step
        renewed = self.columns[rows]
        inertia = renewed @ self.columns.T
        inertia[np.arange(count), rows] -= 1.0
        self.change[rows], self.change[:, rows] = inertia, inertia.T
        weight = renewed @ self._gravity - self._weight_at_rest[rows]
        self.weight[rows] = weight - self._weight_slopes[rows] @ eta
        after = self.twice_kinetic_energy(rate)
        if after > 0.0:
            rate *= np.sqrt(before / after)

    def potential(self, eta: Floats, here: Floats) -> float:
        """Energy [J] of the weight beyond that which the stiffness has, at coordinates (m,)."""
        linear = float(self._force_at_rest @ eta) + 0.5 * float(eta @ (self._slopes @ eta))
        return linear - float(self._gravity @ (here - self._place_at_rest))

    def twice_kinetic_energy(self, rate: Floats) -> float:
        """Twice the kinetic energy of a motion of rates (m,), [J]."""
        leading = rate[: len(self.change)]
        return float(rate @ rate + leading @ (self.change @ leading))

    def centrifugal(
        self, rotations: Floats, here: Floats, rate: Floats, rotation_rates: Floats
    ) -> tuple[Floats, Floats]:
        """
        Find ``-J' m (dJ/dt) q'`` but for what does work on the motion.

        Parameters
        ----------
        rotations, here
            Key rotations (N,), and the `Middles` there.
        rate, rotation_rates
            Rates of the coordinates (m,), and of the key rotations (N,).

        Returns
        -------
        tuple
            The force, and the momentum over twice the kinetic energy, both (q,).

        """
        fastest = float(np.abs(rotation_rates).max(initial=0.0))
        energy = self.twice_kinetic_energy(rate)
        if not (fastest > 0.0 and energy > 0.0):
            still = np.zeros(len(self.change))
            return still, still
        step = _MOTION_TURN / fastest
        along = step * rotation_rates
        bend = self._middles.fill(rotations + along, self._room)
        bend += self._middles.fill(rotations - along, self._other)
        bend -= here
        bend -= here
        force = self.columns @ bend
        force /= -(step**2)
        leading = rate[: len(self.change)]
        momentum = (leading + self.change @ leading) / energy
        force -= (force @ leading) * momentum
        return force, momentum
