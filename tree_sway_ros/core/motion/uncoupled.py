# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Models 1 and 2 of the ladder: every branch an oscillator of its own, on two axes.

Model 1, `branch`, is the paper's: a branch feels its own wind and its own inertia. Model 2,
`subtree`, gives it the inertia of all it carries and the moment of all the wind on it, and lets it
move with its parent; it still swings at a pace of its own.

The load is found once per step, at the state half a step on (exponential midpoint rule), and held
over the step; what depends on the branch's own angle is corrected once within the step
(`two_axis.step_branch`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Record, Records
from tree_sway_ros.core.kernel import entry_of, fused
from tree_sway_ros.core.motion.fill_records import load_records
from tree_sway_ros.core.motion.records import LANES, OSCILLATORS, WORK
from tree_sway_ros.core.motion.tree_passes import generalised_loads, outward_pass, wind_forces
from tree_sway_ros.core.oscillators.propagator import fill_propagator
from tree_sway_ros.core.oscillators.rule_names import DEFAULT
from tree_sway_ros.core.oscillators.step_rules import fill_steps
from tree_sway_ros.core.oscillators.two_axis import fill_guards, LOAD_MAX, step_branch, true_force


class UncoupledBank:
    """
    Oscillators of all branches, in [kg m^2], [N m s/rad] and [N m/rad], (b,).

    ``carries`` tells whether branches carry their children (model 2) or are alone (model 1); the
    integrator is one of `REAL_TIME`.
    """

    is_tabled = False
    n_outside, table_error = 0, 0.0
    shapes = np.zeros((0, 0))

    def __init__(
        self,
        branches: Records,
        inertia: Floats,
        damping: Floats,
        stiffness: Floats,
        carries: bool,
        integrator: str = DEFAULT,
    ) -> None:
        """Make room for the coefficients and the state."""
        n = len(branches)
        self.branches = branches
        self.inertia, self.damping, self.stiffness = inertia, damping, stiffness
        self.carries, self.integrator = carries, integrator
        self.work = np.zeros(n, dtype=WORK)
        self.state = np.zeros((5, 2 * n))
        self.x, self.v, self.moment, _, _ = self.state
        self._pull = np.zeros(n)
        self._banks = load_records(branches, OSCILLATORS)

    @property
    def loads(self) -> Records:
        """Return the records of `load_fields`, and what the oscillators add."""
        return self._banks

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""
        n = len(self.branches)
        whole, half, guard = np.zeros((n, 8)), np.zeros((n, 8)), np.zeros((n, 3))
        fill_steps(self.integrator, self.inertia, self.damping, self.stiffness, dt, whole)
        fill_propagator(self.inertia, self.damping, self.stiffness, 0.5 * dt, half)
        fill_guards(self.inertia, self.stiffness, dt, LOAD_MAX, guard)
        held = half[:, [0, 1, 2, 4, 5, 6]]
        held[:, [2, 5]] += half[:, [3, 7]]
        block, lane = np.divmod(np.arange(n), LANES)
        flow = np.square(self.branches['flow'][:, :2]).sum(axis=(1, 2)) / 2.0
        for name, rows in (('whole', whole), ('half', held), ('guard', guard)):
            self._banks[name][block, :, lane] = rows
        self._banks['compliance'][block, lane] = flow * held[:, 5]

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Advance one step under a mean wind [m/s], with `drag.pressure` in [kg/m^3].

        Returns how many loads were held at their limit, -1 if the motion is not finite.
        """
        return int(self._compiled(wx, wy, wz, per_speed_squared))

    @cached_property
    def _compiled(self) -> Callable[..., int]:
        arrays = (self.branches, self.work, self._banks, self.state, self._pull, self.carries)
        return partial(entry_of(_advance, *arrays, 0.0, 0.0, 0.0, 0.0), *arrays)

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """Key rotations (N, k, f) at rest under moments (N, k) [N m] that swing at w [rad/s]."""
        impedance = (
            self.stiffness[:, None]
            - self.inertia[:, None] * circular**2
            + 1j * self.damping[:, None] * circular
        )
        flexibility: NDArray[np.complex128] = np.repeat(1.0 / impedance, 2, axis=0)
        return moments[:, :, None] * flexibility[:, None, :]

    def memory(self) -> tuple[Floats, ...]:
        """Return views of what is carried from one step to the next."""
        return self.x, self.v, self._banks['slip'], self._banks['load']

    def rotations(self) -> Floats:
        """Key rotations in [rad], (2 b,)."""
        return self.x

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (2 b,)."""
        return self.x.copy(), self.v.copy()

    def take_over(self, x: Floats, v: Floats) -> None:
        """Go on from key rotations and rates, (2 b,)."""
        self.reset()
        self.x[:], self.v[:] = x, v

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        forces: Floats = self.work['force']
        return forces

    def reset(self) -> None:
        """Go back to rest."""
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self._banks['slip'] = self._banks['load'] = 0.0


@fused
def _advance(
    branches: Records, work: Records, banks: Records, state: Floats, pull: Floats, carries: bool,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    x, v, moment, middle_x, middle_v = state[0], state[1], state[2], state[3], state[4]
    n = len(branches)
    for b in range(n):
        here, j = banks[b // LANES], b % LANES
        for k in range(2):
            here.now_x[k, j], here.now_v[k, j] = x[2 * b + k], v[2 * b + k]
    for block in range(len(banks)):
        _to_middle(banks[block])
    if carries:
        for b in range(n):
            here, j = banks[b // LANES], b % LANES
            for k in range(2):
                middle_x[2 * b + k], middle_v[2 * b + k] = here.x[k, j], here.v[k, j]
        outward_pass(branches, work, middle_x, middle_v)
    wind_forces(branches, work, banks, carries, wx, wy, wz, per_speed_squared)
    generalised_loads(branches, work, banks, carries, moment, pull)
    if carries:
        for b in range(n):
            load, j = banks[b // LANES].load, b % LANES
            load[0, j], load[1, j], load[2, j] = pull[b], moment[2 * b], moment[2 * b + 1]
    held, total = 0, 0.0
    for block in range(len(banks)):
        held += _step(banks[block])
    for b in range(n):
        here, j = banks[b // LANES], b % LANES
        if not here.is_solved[j]:
            here, j = banks[branches[b].source // LANES], branches[b].source % LANES
        for k in range(2):
            x[2 * b + k], v[2 * b + k] = here.now_x[k, j], here.now_v[k, j]
            total += 0.0 * x[2 * b + k] + 0.0 * v[2 * b + k]
    return held if total == 0.0 else -1


@fused
def _to_middle(bank: Record) -> None:
    """State of sixteen branches half a step on, under the last step's load."""
    x, v, load, h = bank.now_x, bank.now_v, bank.load, bank.half
    middle_x, middle_v = bank.x, bank.v
    for j in range(LANES):
        mx, my = true_force(x[0, j], x[1, j], load[0, j], load[1, j], load[2, j])
        middle_x[0, j] = h[0, j] * x[0, j] + h[1, j] * v[0, j] + h[2, j] * mx
        middle_x[1, j] = h[0, j] * x[1, j] + h[1, j] * v[1, j] + h[2, j] * my
        middle_v[0, j] = h[3, j] * x[0, j] + h[4, j] * v[0, j] + h[5, j] * mx
        middle_v[1, j] = h[3, j] * x[1, j] + h[4, j] * v[1, j] + h[5, j] * my


@fused
def _step(bank: Record) -> int:
    """Step sixteen branches; return how many loads were held."""
    x, v, load, c, g = bank.now_x, bank.now_v, bank.load, bank.whole, bank.guard
    is_solved, held = bank.is_solved, 0
    for j in range(LANES):
        x[0, j], x[1, j], v[0, j], v[1, j], over = step_branch(
            x[0, j], x[1, j], v[0, j], v[1, j], load[0, j], load[1, j], load[2, j],
            c[0, j], c[1, j], c[2, j], c[3, j], c[4, j], c[5, j], c[6, j], c[7, j],
            g[0, j], g[1, j], g[2, j],
        )  # fmt: skip
        held += over * is_solved[j]
    return held
