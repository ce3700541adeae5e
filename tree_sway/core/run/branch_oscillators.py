# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `branch`, the method of Kanda & Ohya: one equation of motion for each branch.

``native/branch.h`` has the equations and steps them; here are its constants. k1 and k2 are those
of the beam and the damping ratio of the wood, or by the paper's rule proportional to the volume of
the branch and its parent (`Settings.volume_stiffness`).

The paper's own form, with multipliers and a plane that follows the wind, is in the laboratory.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import drag_density
from tree_sway.core.model import BranchBlocks, SwayModel
from tree_sway.core.oscillators import fill_propagator, guards
from tree_sway.core.run.bank import Tunable


class BranchOscillators:
    """
    Oscillators of all branches.

    Each has J in [kg m^2], k2 in [N m s/rad] and k1 in [N m/rad], ``inertia``, ``damping`` and
    ``stiffness``, (b,).
    """

    n_outside = 0
    """There is no table, so no step is outside."""
    shapes = np.zeros((0, 0))

    def __init__(self, model: SwayModel) -> None:
        """Make room for coefficients and state; what a tuning changes is copied."""
        self._drag_law = model.drag_law
        self.branches = model.branches
        self.inertia = model.inertia
        self.damping = model.own_damping.copy()
        self.stiffness = model.stiffness.copy()
        self._blocks = BranchBlocks(self.branches)
        self.loads = self._blocks.records
        """Records of `BranchBlock`."""
        self.state = self._blocks.state
        self.x, self.v = self.state
        unknown = np.zeros(len(self.stiffness))
        self.tunable = Tunable(self.stiffness, self.damping, self.inertia, model.weight, unknown)
        """Arrays that change with stiffness, damping and gravity."""

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        whole, half = np.zeros((2, len(self.branches), 8))
        fill_propagator(self.inertia, self.damping, self.stiffness, dt, whole)
        fill_propagator(self.inertia, self.damping, self.stiffness, 0.5 * dt, half)
        # A constant load is the same at the begin and at the end of the half step.
        constant = half[:, [0, 1, 2, 4, 5, 6]]
        constant[:, [2, 5]] += half[:, [3, 7]]
        damping_square = np.square(self.branches['damping_mode'][:, :2]).sum(axis=(1, 2)) / 2.0
        self._blocks.put('whole', whole)
        self._blocks.put('half', constant)
        self._blocks.put('guard', guards(self.inertia, self.stiffness, dt))
        self._blocks.put('compliance', damping_square * constant[:, 5])

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """
        Advance one step under a mean wind [m/s].

        Returns how many loads were clamped to their limit, -1 if the motion is not finite.
        """
        load = drag_density(math.sqrt(wx * wx + wy * wy + wz * wz), *self._drag_law)
        return self.advance_in(wx, wy, wz, load)

    def advance_in(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step in a wind [m/s] of a `drag_law.drag_density` [kg/m^3]."""
        return self._blocks.step(wx, wy, wz, per_speed_squared)

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        return self._blocks.forces()

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return self.x, self.v, self.loads['drag_impulse'], self.loads['load']

    def rotations(self) -> Floats:
        """Key rotations in [rad], (2 b,)."""
        return self.x

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (2 b,)."""
        return self.x.copy(), self.v.copy()

    def take_over(self, x: Floats, v: Floats) -> None:
        """Continue from key rotations and rates, (2 b,)."""
        self.reset()
        self.x[:] = x
        self.v[:] = v

    def reset(self) -> None:
        """Return to rest."""
        self._blocks.reset()
