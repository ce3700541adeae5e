# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Coordinates of a coupled tree as oscillators: shapes, stiffness, damping, and their propagators.

They are orthogonal in mass and stiffness, and each has unit modal mass, so that each moves as an
oscillator of its own under its share of the load. Where the load comes from is up to the model.

Symbols: Phi shapes (N, m), stored by coordinate, (m, N), w circular frequencies.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import SwayModel
from tree_sway.core.oscillators import fill_propagator
from tree_sway.core.run.bank import Tunable

FARTHEST = 2.0
"""Largest rotation of a branch on its parent in [rad]."""


class Propagators(NamedTuple):
    """
    Damping [1/s] and stiffness [1/s^2] of coordinates, (m,), and their propagators.

    ``whole`` is over a step, ``half`` over half of it, (m, 8).
    """

    damping: Floats
    stiffness: Floats
    whole: Floats
    half: Floats

    def middle_of_step(self, dt: float) -> Floats:
        """
        Return displacement and rate at the middle of a step by those before and force, (6, m).

        The load is taken from there, where the rate of a coordinate that swings nearly once a step
        or more may be opposite to its force. Strong drag, whose implicit part needs a rate that
        follows the force, would then feed the motion. The middle state of such coordinates is that
        of an implicit Euler step, whose rate always follows the force.
        """
        half = self.half.T[[0, 1, 2, 4, 5, 6]]
        half[[2, 5]] += self.half.T[[3, 7]]
        euler = _implicit_euler(self.damping, self.stiffness, 0.5 * dt)
        return np.where(half[5] < euler[5], euler, half)


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
        self.whole, self.half = np.zeros((2, len(self.stiffness), 8))
        """Propagators over the time step and half of it, as `fill_propagator`, (m, 8)."""
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

    @property
    def law(self) -> Propagators:
        """Return the propagators over the time step."""
        return Propagators(self.damping, self.stiffness, self.whole, self.half)

    def propagators(self, dt: float) -> tuple[Floats, Floats]:
        """Return the propagators over a time step [s] and half of it, as `whole` and `half`."""
        one = np.ones(len(self.stiffness))
        whole, half = np.zeros((2, len(one), 8))
        fill_propagator(one, self.damping, self.stiffness, dt, whole)
        fill_propagator(one, self.damping, self.stiffness, 0.5 * dt, half)
        return whole, half

    def set_time_step(self, dt: float) -> None:
        """Refill the propagators for a time step [s]."""
        self.dt = dt
        self.whole[:], self.half[:] = self.propagators(dt)

    def projected(self, x: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Project key rotations and their rates, (N,), on the coordinates, (m,)."""
        return self.momentum @ x, self.momentum @ v


def _implicit_euler(damping: Floats, stiffness: Floats, h: float) -> Floats:
    """Return displacement, then rate, after h [s] by displacement, rate and force, (6, m)."""
    share = 1.0 / (1.0 + h * damping + h * h * stiffness)
    rate = np.stack([-h * stiffness * share, share, h * share])
    displacement = h * rate
    displacement[0] += 1.0
    return np.concatenate([displacement, rate])
