# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Coordinates of a coupled tree as oscillators: shapes, stiffness and damping.

They are orthogonal in mass and stiffness, and each has unit modal mass, so that each moves as an
oscillator of its own under its share of the load. Where the load comes from is up to the model.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import SwayModel
from tree_sway.core.run.bank import Tunable

FARTHEST = 2.0
"""Largest rotation of a branch on its parent in [rad]."""


class ModalCoordinates:
    """Some or all coordinates of a tree; what a tuning changes is copied."""

    def __init__(self, model: SwayModel) -> None:
        self.model = model
        """Prepared model of the tree."""
        # One coordinate after the other in memory.
        self.shapes = np.ascontiguousarray(model.shapes.T).T
        """Key rotations per unit of each coordinate, (N, m)."""
        self.stiffness = model.stiffness.copy()
        self.damping = model.own_damping.copy()
        self.limit = model.key_limit.copy()
        """Largest moment on each key rotation in [N m], (N,)."""
        self.compliance = model.branch_compliance.copy(), model.shape_compliance.copy()
        """
        Compliance of every isolated branch, (N, 9), and of the coordinates of isolated branches,
        (m, m).
        """
        self.tunable = Tunable(
            self.stiffness,
            self.damping,
            1.0,
            model.weight,
            np.zeros(len(self.stiffness)),
            ((self.limit, 1.0), *((each, -1.0) for each in self.compliance)),
            model.relative_damping,
        )
        """Arrays that change with stiffness, damping and gravity."""
        self.dt = 0.0
        """The time step [s]."""

    @property
    def branches(self) -> Records:
        """Records of the branches, (b,)."""
        return self.model.branches

    def per_force(self, slope: Floats | float = 0.0) -> Floats:
        """
        Displacement and rate that a force which is added to a step gives, per unit of it, (2, m).

        The slope is that of the other force by the own rate, in which the step was implicit.
        """
        from tree_sway.core.oscillators import step_propagators

        whole, half = step_propagators(self.damping, self.stiffness, self.dt)
        return np.asarray(whole[:, 2] / (1.0 - slope * half[1, 2]))

    def projected(self, x: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Project key rotations and their rates, (N,), on the coordinates, (m,)."""
        return self.model.projection @ x, self.model.projection @ v
