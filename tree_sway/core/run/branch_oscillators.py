# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `branch`, the paper's: every branch a separate oscillator on two axes.

A branch meets its own wind with its own inertia, as if its base were at rest.

The load is found once per step, at the state at the middle of the step (exponential midpoint
rule), and is constant over the step; its dependence on the branch's own angle is corrected once
within the step (`two_axis.step_branch`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, fused, part
from tree_sway.core.model.fill_records import load_records
from tree_sway.core.model.records import (
    Banks,
    Branches,
    OSCILLATORS,
    Oscillators,
    WIDTH,
    WORK,
    Works,
)
from tree_sway.core.oscillators.propagator import fill_propagator
from tree_sway.core.oscillators.two_axis import (
    fill_guards,
    LOAD_MAX,
    step_branch,
    true_force,
    within_guard,
)
from tree_sway.core.run.branchwise import Branchwise, Tunable
from tree_sway.core.setup.branch_loads import own_loads, set_air, wind_forces


class UncoupledBank(Branchwise):
    """Oscillators of all branches, in [kg m^2], [N m s/rad] and [N m/rad], (b,)."""

    shapes = np.zeros((0, 0))

    def __init__(
        self, branches: Records, inertia: Floats, damping: Floats, stiffness: Floats,
        weight: Floats,
    ) -> None:  # fmt: skip
        """Make room for the coefficients and the state."""
        n = len(branches)
        self.branches = branches
        self.inertia, self.damping, self.stiffness = inertia, damping, stiffness
        self.work = np.zeros(n, dtype=WORK)
        self.state = np.zeros((2, 2 * n))
        self.x, self.v = self.state
        self.tunable = Tunable(stiffness, damping, inertia, weight)
        """Arrays that change with stiffness, damping and gravity."""
        self.loads = load_records(branches, OSCILLATORS)
        """Records of `OSCILLATORS`."""

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        n = len(self.branches)
        whole, half, guard = np.zeros((n, 8)), np.zeros((n, 8)), np.zeros((n, 3))
        fill_propagator(self.inertia, self.damping, self.stiffness, dt, whole)
        fill_propagator(self.inertia, self.damping, self.stiffness, 0.5 * dt, half)
        fill_guards(self.inertia, self.stiffness, dt, LOAD_MAX, guard)
        constant = half[:, [0, 1, 2, 4, 5, 6]]
        constant[:, [2, 5]] += half[:, [3, 7]]
        block, slot = np.divmod(np.arange(n), WIDTH)
        damping_square = np.square(self.branches['damping_mode'][:, :2]).sum(axis=(1, 2)) / 2.0
        for name, rows in (('whole', whole), ('half', constant), ('guard', guard)):
            self.loads[name][block, :, slot] = rows
        self.loads['compliance'][block, slot] = damping_square * constant[:, 5]

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Advance one step under a mean wind [m/s], with `drag_law.pressure` in [kg/m^3].

        Returns how many loads were clamped to their limit, -1 if the motion is not finite.
        """
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
        self.x[:], self.v[:] = x, v

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
    x, v = state[0], state[1]
    n = len(branches)
    for b in range(n):
        group, j = banks[b // WIDTH], b % WIDTH
        for k in range(2):
            group.now_x[k, j], group.now_v[k, j] = x[2 * b + k], v[2 * b + k]
    for block in range(len(banks)):
        _to_middle(banks[block])
    set_air(work, banks, wx, wy, wz)
    wind_forces(banks, per_speed_squared)
    own_loads(banks)
    clamped, total = 0, 0.0
    for block in range(len(banks)):
        clamped += _step(banks[block])
    for b in range(n):
        group, j = banks[b // WIDTH], b % WIDTH
        for k in range(3):
            work[b].force[k] = group.force[k, j]
        for k in range(2):
            x[2 * b + k], v[2 * b + k] = group.now_x[k, j], group.now_v[k, j]
            total += 0.0 * x[2 * b + k] + 0.0 * v[2 * b + k]
    return clamped if total == 0.0 else -1


@part
def _to_middle(bank: Oscillators) -> None:
    """State of sixteen branches at the middle of the step, under the last step's load."""
    x, v, load, h = bank.now_x, bank.now_v, bank.load, bank.half
    middle_x, middle_v = bank.x, bank.v
    for j in range(WIDTH):
        mx, my = true_force(x[0, j], x[1, j], load[0, j], load[1, j], load[2, j])
        middle_x[0, j], middle_x[1, j], _ = within_guard(
            h[0, j] * x[0, j] + h[1, j] * v[0, j] + h[2, j] * mx,
            h[0, j] * x[1, j] + h[1, j] * v[1, j] + h[2, j] * my,
        )
        middle_v[0, j] = h[3, j] * x[0, j] + h[4, j] * v[0, j] + h[5, j] * mx
        middle_v[1, j] = h[3, j] * x[1, j] + h[4, j] * v[1, j] + h[5, j] * my


@part
def _step(bank: Oscillators) -> int:
    """Step sixteen branches; return how many loads were clamped."""
    x, v, load, c, g = bank.now_x, bank.now_v, bank.load, bank.whole, bank.guard
    clamped = 0
    for j in range(WIDTH):
        x[0, j], x[1, j], v[0, j], v[1, j], over = step_branch(
            x[0, j], x[1, j], v[0, j], v[1, j], load[0, j], load[1, j], load[2, j],
            c[0, j], c[1, j], c[2, j], c[3, j], c[4, j], c[5, j], c[6, j], c[7, j],
            g[0, j], g[1, j], g[2, j],
        )  # fmt: skip
        clamped += over
    return clamped
