# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Coordinates of a coupled tree as oscillators: shapes, stiffness, damping, and their propagators.

They are orthogonal in mass and stiffness, and each has unit modal mass, so that each moves as an
oscillator of its own under its share of the load. Where the load comes from is up to the model.

Symbols: Phi shapes (N, m), stored by coordinate, (m, N), w circular frequencies.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import SwayModel
from tree_sway.core.oscillators import step_propagators
from tree_sway.core.run.bank import Tunable

FARTHEST = 2.0
"""Largest rotation of a branch on its parent in [rad]."""


class ModalCoordinates:
    """
    Some or all coordinates of a tree; what a tuning changes is copied.

    Parameters
    ----------
    branches
        Records of `Branch`, (b,), of the model.
    model
        Prepared model of the tree.

    """

    def __init__(self, branches: Records, model: SwayModel) -> None:
        self.branches = branches
        self.by_coordinate = np.ascontiguousarray(model.shapes.T)
        """Key rotations per unit of each coordinate, (m, N)."""
        self.shapes = self.by_coordinate.T
        self.stiffness = model.stiffness.copy()
        self.loss = model.relative_damping
        """Damping ratio of each coordinate over that of the tree, (m,)."""
        self.damping = model.own_damping.copy()
        self.limit = model.key_limit.copy()
        """Largest moment on each key rotation in [N m], (N,)."""
        self.weight = model.weight
        """Stiffness by gravity in [1/s^2], (m,); negative where weight softens a coordinate."""
        self.compliance = model.branch_compliance.copy(), model.shape_compliance.copy()
        """
        Compliance of every isolated branch, (N, 9), and of the coordinates of isolated branches,
        (m, m).
        """
        self.momentum = model.projection
        """Coordinates, or their rates, per unit of each key rotation, or its rate, (m, N)."""
        self.inertia_slopes = model.inertia_slopes
        """Slopes of the inertia by leading coordinates, (q, q, q), as `inertia_slopes`."""
        self.participation = model.participation
        """Mean squared motion of each load centre per unit of each coordinate, (b, m)."""
        self.whole, self.half = np.zeros((2, 6, len(self.stiffness)))
        """
        Propagators over the time step and half of it, as `step_propagators`, (6, m).

        Rows are those of the displacement by displacement, rate and force, then of the rate.
        """
        self.dt = 0.0
        """The time step [s]."""

    @property
    def air_damping(self) -> Floats:
        """Damping of each coordinate by the air per drag and speed, at least, (m,)."""
        damping: Floats = 2.0 * (self.branches['area'] * self.branches['speed'])
        return damping @ self.participation

    @property
    def tunable(self) -> Tunable:
        """Return the arrays that change with stiffness, damping and gravity."""
        others = (self.limit, 1.0), *((each, -1.0) for each in self.compliance)
        return Tunable(self.stiffness, self.damping, 1.0, self.weight, others, self.loss)

    def set_time_step(self, dt: float) -> None:
        """Refill the propagators for a time step [s]."""
        self.dt = dt
        whole, half = step_propagators(self.damping, self.stiffness, dt)
        self.whole[:], self.half[:] = whole.reshape(6, -1), half.reshape(6, -1)

    def projected(self, x: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Project key rotations and their rates, (N,), on the coordinates, (m,)."""
        return self.momentum @ x, self.momentum @ v
