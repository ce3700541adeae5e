# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `branch`, the method of Kanda & Ohya: one equation of motion for each branch.

In each branch the paper solves the motion of the segment that plays the central part in its
deformation, and places the others geometrically. With q the position and rotation of this segment,
M its mass, P the force of the wind, K the resistance to bending and R the friction,

    M v' = F - G^T lambda,   v = q',   phi(q) = 0,   G = d phi / d q        (1)
    F = P - K - R,   K = k1 theta,   R = k2 theta'                          (2)

The constraint phi holds the root-side node of the segment in its place. Here q is the rotation
about this node, so that phi holds by itself and lambda is eliminated. A branch has two such key
rotations theta, about two fixed axes across its chord:

    J theta'' = T - k1 theta - k2 theta'

with T the moment of P on the branch, in its bent direction, and J its inertia about the base, with
the branches that it carries (`setup.subtree_inertia`). The other segments follow by its shape
(`placing`). As in the paper each branch moves as if its base were at rest: neither the motion of
its parent nor the wind on the branches that it carries has an effect on it.

k1 and k2 are those of the beam and the damping ratio of the wood, or by the paper's rule
proportional to the volume of the branch and its parent (`Settings.volume_stiffness`).

**A step.** Between two loads the equation is linear, and is solved exactly
(`oscillators.propagator`). The load is found once per step, at the state at the middle of the step
(exponential midpoint rule), and is constant over the step. Its dependence on the angle of the
branch is corrected once within the step (`two_axis.step_branch`).

The paper's own form, with multipliers and a plane that follows the wind, is in the laboratory.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
import math

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, fused, part
from tree_sway.core.model.drag_law import drag_density, DragLaw
from tree_sway.core.model.load_layouts import Banks, OSCILLATORS, Oscillators, WORK, Works
from tree_sway.core.model.load_records import load_records
from tree_sway.core.model.records import Branches, WIDTH
from tree_sway.core.oscillators.propagator import fill_propagator
from tree_sway.core.oscillators.two_axis import (
    fill_guards,
    LOAD_MAX,
    step_branch,
    true_force,
    within_guard,
)
from tree_sway.core.run.bank import Tunable
from tree_sway.core.run.branchwise import Branchwise
from tree_sway.core.setup.branch_loads import own_loads, set_air, wind_forces

NOT_FINITE = -1
"""Result of a step after which the motion is not finite."""


class BranchOscillators(Branchwise):
    """
    Oscillators of all branches.

    Parameters
    ----------
    branches
        Records of `Branch`, (b,).
    inertia, damping, stiffness
        J in [kg m^2], k2 in [N m s/rad] and k1 in [N m/rad] of each branch, (b,).
    weight
        Part of the stiffness by gravity in [N m/rad], (b,).
    drag_law
        Drag of the tree.

    """

    shapes = np.zeros((0, 0))

    def __init__(
        self,
        branches: Records,
        inertia: Floats,
        damping: Floats,
        stiffness: Floats,
        weight: Floats,
        drag_law: DragLaw,
    ) -> None:
        """Make room for the coefficients and the state."""
        self._drag_law = drag_law
        self.branches = branches
        self.inertia = inertia
        self.damping = damping
        self.stiffness = stiffness
        self.work = np.zeros(len(branches), dtype=WORK)
        self.state = np.zeros((2, 2 * len(branches)))
        self.x, self.v = self.state
        self.tunable = Tunable(stiffness, damping, inertia, weight)
        """Arrays that change with stiffness, damping and gravity."""
        self.loads = load_records(branches, OSCILLATORS)
        """Records of `OSCILLATORS`."""

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        count = len(self.branches)
        whole, half = np.zeros((2, count, 8))
        guard = np.zeros((count, 3))
        fill_propagator(self.inertia, self.damping, self.stiffness, dt, whole)
        fill_propagator(self.inertia, self.damping, self.stiffness, 0.5 * dt, half)
        fill_guards(self.inertia, self.stiffness, dt, LOAD_MAX, guard)
        # A constant load is the same at the begin and at the end of the half step.
        constant = half[:, [0, 1, 2, 4, 5, 6]]
        constant[:, [2, 5]] += half[:, [3, 7]]
        damping_square = np.square(self.branches['damping_mode'][:, :2]).sum(axis=(1, 2)) / 2.0
        block, slot = np.divmod(np.arange(count), WIDTH)
        self.loads['whole'][block, :, slot] = whole
        self.loads['half'][block, :, slot] = constant
        self.loads['guard'][block, :, slot] = guard
        self.loads['compliance'][block, slot] = damping_square * constant[:, 5]

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """
        Advance one step under a mean wind [m/s].

        Returns how many loads were clamped to their limit, -1 if the motion is not finite.
        """
        load = drag_density(math.sqrt(wx * wx + wy * wy + wz * wz), *self._drag_law)
        return self.advance_in(wx, wy, wz, load)

    def advance_in(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step in a wind [m/s] of a `drag_law.drag_density` [kg/m^3]."""
        return int(self._compiled(wx, wy, wz, per_speed_squared))

    @cached_property
    def _compiled(self) -> Callable[..., int]:
        arrays = self.branches, self.work, self.loads, self.state
        return partial(entry_of(_advance, *arrays, 0.0, 0.0, 0.0, 0.0), *arrays)

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
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self.loads['drag_impulse'] = self.loads['load'] = 0.0


@fused
def _advance(
    branches: Branches, work: Works, banks: Banks, state: Floats,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    angles = state[0]
    rates = state[1]
    for branch in range(len(branches)):
        bank = banks[branch // WIDTH]
        slot = branch % WIDTH
        for axis in range(2):
            bank.now_x[axis, slot] = angles[2 * branch + axis]
            bank.now_v[axis, slot] = rates[2 * branch + axis]
    # The load P at the middle of the step, then the step.
    for block in range(len(banks)):
        _to_middle(banks[block])
    set_air(work, banks, wx, wy, wz)
    wind_forces(banks, per_speed_squared)
    own_loads(banks)
    clamped = 0
    is_finite = True
    for block in range(len(banks)):
        clamped += _step(banks[block])
    for branch in range(len(branches)):
        bank = banks[branch // WIDTH]
        slot = branch % WIDTH
        for axis in range(3):
            work[branch].force[axis] = bank.force[axis, slot]
        for axis in range(2):
            angle = bank.now_x[axis, slot]
            rate = bank.now_v[axis, slot]
            angles[2 * branch + axis] = angle
            rates[2 * branch + axis] = rate
            if not (math.isfinite(angle) and math.isfinite(rate)):
                is_finite = False
    return clamped if is_finite else NOT_FINITE


@part
def _to_middle(bank: Oscillators) -> None:
    """State of sixteen branches at the middle of the step, under the last step's load."""
    load = bank.load
    half = bank.half
    middle_rate = bank.v
    for slot in range(WIDTH):
        angle_x = bank.now_x[0, slot]
        angle_y = bank.now_x[1, slot]
        rate_x = bank.now_v[0, slot]
        rate_y = bank.now_v[1, slot]
        moment_x, moment_y = true_force(
            angle_x, angle_y, load[0, slot], load[1, slot], load[2, slot]
        )
        by_angle = half[0, slot]
        by_rate = half[1, slot]
        by_moment = half[2, slot]
        middle_x, middle_y, _square = within_guard(
            by_angle * angle_x + by_rate * rate_x + by_moment * moment_x,
            by_angle * angle_y + by_rate * rate_y + by_moment * moment_y,
        )
        bank.x[0, slot] = middle_x
        bank.x[1, slot] = middle_y
        by_angle = half[3, slot]
        by_rate = half[4, slot]
        by_moment = half[5, slot]
        middle_rate[0, slot] = by_angle * angle_x + by_rate * rate_x + by_moment * moment_x
        middle_rate[1, slot] = by_angle * angle_y + by_rate * rate_y + by_moment * moment_y


@part
def _step(bank: Oscillators) -> int:
    """Step sixteen branches; return how many loads were clamped."""
    angle = bank.now_x
    rate = bank.now_v
    load = bank.load
    whole = bank.whole
    guard = bank.guard
    clamped = 0
    for slot in range(WIDTH):
        angle[0, slot], angle[1, slot], rate[0, slot], rate[1, slot], is_over = step_branch(
            angle[0, slot], angle[1, slot], rate[0, slot], rate[1, slot],
            load[0, slot], load[1, slot], load[2, slot],
            whole[0, slot], whole[1, slot], whole[2, slot], whole[3, slot],
            whole[4, slot], whole[5, slot], whole[6, slot], whole[7, slot],
            guard[0, slot], guard[1, slot], guard[2, slot],
        )  # fmt: skip
        clamped += is_over
    return clamped
