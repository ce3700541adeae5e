# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A step of oscillators that an inertia beyond their own couples.

Each coordinate has the mass 1 and moves exactly, as an oscillator of its own, under a force f that
is constant over the step of length h (`ModalCoordinates`). What the inertia M has beyond 1 is a
part of that force, by the mean acceleration over the step:

    f = F - (M - 1) (v1 - v0) / (h T),   v1 = v1(q0, v0, f),   T = tan(w h / 2) / (w h / 2),

which is linear in f. As ``q1 - q0 = h T (v0 + v1) / 2`` for a coordinate of the circular frequency
w, this f does exactly the work that ``v' (M - 1) v / 2`` loses: with a constant M, no step of any
length makes energy. With the acceleration u that f makes, as unknown, the matrix is symmetric and
positive definite:

    (k + M - 1 + D) u = T F - (M - 1) a + D u0,   k = T f / u >= 1,   D = h B / 2

with a the mean acceleration without f, and u0 that of the last step: the drag is implicit by the
damping B of the air, for F was found at the rates which the last step's force predicts.

A force s that is at right angles to the motion v in the middle, as the centrifugal, would lengthen
v if it were constant. It turns with the motion instead, as ``G (v0 + v1) / 2`` with the
antisymmetric ``G = s r' - r s'``, ``r = M v / (v' M v)``, so that ``G v = s``, and does no work.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import get_lapack_funcs

from tree_sway.core.arrays import Floats
from tree_sway.core.run.modal_coordinates import ModalCoordinates

FASTEST = 2.5
"""
Largest angle [rad] by which a coordinate swings in a step with more inertia than its own: T is
infinite at half a turn.
"""

(_solve,) = get_lapack_funcs(('posv',), dtype=np.float64)


class CoupledStep:
    """
    Coefficients of a step.

    Parameters
    ----------
    modal
        Coordinates, with the propagators of this step.
    half
        Coefficients of half a step, as in `table_model.fill_time_step`, (6, m).
    leading
        Number of coordinates that may be coupled.
    length
        Length of the step, h, in [s].

    """

    def __init__(self, modal: ModalCoordinates, half: Floats, leading: int, length: float) -> None:
        self.length = length
        self._half, self._whole = half.copy(), modal.whole.T[[0, 1, 2, 4, 5, 6]]
        self._whole[[2, 5]] += modal.whole.T[[3, 7]]
        angle = np.sqrt(modal.stiffness[:leading]) * length
        coupled = np.flatnonzero(angle < FASTEST)
        is_all = len(coupled) == leading
        self._rows: Any = slice(0, leading) if is_all else coupled
        self._block: Any = (self._rows, self._rows) if is_all else np.ix_(coupled, coupled)
        half_angle = np.maximum(0.5 * angle[self._rows], 1e-12)
        self._stretch = np.tan(half_angle) / half_angle
        self._per_force = self._whole[5][self._rows] / length
        """Acceleration of the coupled coordinates by a force."""
        self._own = self._stretch / self._per_force

    def middle(self, eta: Floats, rate: Floats, force: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates at the middle of the step under a force, all (m,)."""
        return _moved(self._half, eta, rate, force)

    def end(self, eta: Floats, rate: Floats, force: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates at the end of the step under a force, all (m,)."""
        return _moved(self._whole, eta, rate, force)

    def force(
        self, wanted: Floats, eta: Floats, rate: Floats, last: Floats, change: Floats,
        drag: Floats, across: tuple[Floats, Floats],
    ) -> Floats:  # fmt: skip
        """
        Find the constant force of the step, (m,).

        Parameters
        ----------
        wanted
            Force F at the middle of the step, (m,).
        eta, rate, last
            Coordinates and rates before the step, and the force of the last one, (m,).
        change
            Inertia of the leading coordinates beyond their own, M - 1, (q, q).
        drag
            Damping B by the air [1/s], (m, m).
        across
            Force s at right angles to the motion, and r, (q,) both.

        """
        whole, rows = self._whole, self._rows
        own_drag = 0.5 * np.diagonal(drag) * whole[5]
        found = (wanted + own_drag * last) / (1.0 + own_drag)
        inertia, damping = change[self._block], (0.5 * self.length) * drag[self._block]
        free = (whole[3] * eta + (whole[4] - 1.0) * rate)[rows] / self.length
        right = self._stretch * wanted[rows] - inertia @ free
        right += damping @ (self._per_force * last[rows])
        steered = rate[rows] + 0.5 * self.length * free
        turning, along = (each[rows] for each in across)
        right += turning * (along @ steered) - along * (turning @ steered)
        matrix = inertia + damping
        matrix.flat[:: len(matrix) + 1] += self._own
        _, solved, failed = _solve(matrix, np.stack([right, turning, along], 1), lower=1)
        if not failed:
            # Woodbury's formula for the matrix less h G / 2, of rank two.
            h, sides = 0.5 * self.length, np.stack([along, turning])
            by_turning, by_along = solved[:, 1], solved[:, 2]
            columns = np.stack([-h * by_turning, h * by_along], 1)
            share = np.linalg.solve(np.eye(2) + sides @ columns, sides @ solved[:, 0])
            found[rows] = (solved[:, 0] - columns @ share) / self._per_force
        return np.asarray(found)


def _moved(c: Floats, eta: Floats, rate: Floats, force: Floats) -> tuple[Floats, Floats]:
    place = c[0] * eta + c[1] * rate + c[2] * force
    return place, c[3] * eta + c[4] * rate + c[5] * force
