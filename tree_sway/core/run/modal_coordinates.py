# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Coordinates of a coupled tree as oscillators: shapes, stiffness, damping, and their propagators.

They are orthogonal in mass and stiffness, and each has unit modal mass, so that each moves as an
oscillator of its own under its share of the load. Where the load comes from is up to the model.

Symbols: Phi shapes (N, m), stored by coordinate, (m, N), w circular frequencies.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.oscillators.propagator import fill_propagator
from tree_sway.core.oscillators.two_axis import LOAD_MAX
from tree_sway.core.run.branchwise import Tunable

FARTHEST = 2.0
"""Largest rotation of a branch on its parent in [rad]."""


class ModalCoordinates:
    """
    Some or all coordinates of a tree, of one damping ratio.

    Parameters
    ----------
    branches
        Records of `Branch`, (b,).
    made_of
        Arrays of `setup.modal_arrays`.
    damping_ratio
        Damping ratio of the tree in [-].

    """

    def __init__(
        self, branches: Records, made_of: Mapping[str, Floats], damping_ratio: float
    ) -> None:
        self.branches = branches
        self.by_coordinate = made_of['shapes']
        """Key rotations per unit of each coordinate, (m, N)."""
        self.shapes = self.by_coordinate.T
        self.stiffness = made_of['circular'] ** 2
        self.loss = made_of['loss']
        """Damping ratio of each coordinate over that of the tree, (m,)."""
        self.damping = 2.0 * damping_ratio * self.loss * made_of['circular']
        self.limit = LOAD_MAX * made_of['diagonal']
        """Largest moment on each key rotation in [N m], (N,)."""
        self.weight = made_of['weight']
        """Stiffness by gravity in [1/s^2], (m,); negative where weight softens a coordinate."""
        self.compliance = made_of['branch_compliance'], made_of['mode_compliance']
        """
        Compliance of every isolated branch, (N, 9), and of the coordinates of isolated branches,
        (m, m).
        """
        self.momentum = made_of['momentum'].T
        """Coordinates, or their rates, per unit of each key rotation, or its rate, (m, N)."""
        self.inertia_slopes = made_of['inertia_slopes']
        """Slopes of the inertia by leading coordinates, (q, q, q), as `inertia_slopes`."""
        self.participation = made_of['participation']
        """Mean squared motion of each load centre per unit of each coordinate, (b, m)."""
        self.whole, self.half = np.zeros((2, len(self.stiffness), 8))
        """Propagators over the time step and half of it, as `fill_propagator`, (m, 8)."""

    @property
    def mean_square_motion(self) -> Floats:
        """Mean square motion of the loaded pieces, per unit of each coordinate, (m,)."""
        area = self.branches['area']
        return np.asarray(2.0 * area @ self.participation / max(float(area.sum()), 1e-300))

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
        one = np.ones(len(self.stiffness))
        fill_propagator(one, self.damping, self.stiffness, dt, self.whole)
        fill_propagator(one, self.damping, self.stiffness, 0.5 * dt, self.half)

    def projected(self, x: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Project key rotations and their rates, (N,), on the coordinates, (m,)."""
        return self.momentum @ x, self.momentum @ v
