# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full`: all coordinates of a tree, under the load on every branch.

It is the reference of the table models: its load is found branch by branch, in the wind and at the
motion of each, at the state in the middle of the step, and is constant over the step.

**Implicit load.** The motion in a step changes the load itself: twigs in a storm point along the
wind within a fraction of a step. So the load is iterated until it is that of the resulting state;
in light wind, where the last step's load is close enough, once. Rotations beyond the limit of a
step are clamped and counted.

Symbols: Phi mode shapes (N, m), stored by mode, (m, N), eta modal coordinates, Q moments
on the key rotations, w circular frequencies.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
import math

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, fused, part
from tree_sway.core.model.fill_records import load_records
from tree_sway.core.model.records import Branches, Loads, WIDTH, WORK, Works
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.oscillators.two_axis import LOAD_MAX
from tree_sway.core.run.branchwise import Branchwise
from tree_sway.core.run.modal_coordinates import FARTHEST, ModalCoordinates
from tree_sway.core.setup.bent_inertia import MOST_CHANGE
from tree_sway.core.setup.branch_loads import wind_moments

MOST_TRIALS = 12
"""Largest number of iterations for the load of a step."""

ENOUGH = 0.02
"""Tolerance of the load, as the rotation that it makes [rad]."""


TURNS = 10
"""Iterations for the accelerations of the bent tree: each leaves `MOST_CHANGE` of the error."""

MOST_TURN = 1.0
"""Largest rotation of a branch on its parent in a step, in [rad]."""


class FullBank(Branchwise, ModalCoordinates):
    """Oscillators of the coordinates of a tree, loaded branch by branch."""

    def __init__(self, branches: Records, model: SwayModel) -> None:
        """Make room for the state."""
        super().__init__(branches, model)
        m, n = self.by_coordinate.shape
        self._springs = np.zeros((5 + len(self.inertia_slopes), m))
        self.work = np.zeros(len(branches), dtype=WORK)
        self.loads = load_records(branches)
        """Records of `load_layout`."""
        self.modal = np.zeros((5, m))
        self.swing = tuple(self.modal[:3])
        """Displacement, rate and force of each mode, (m,)."""
        self.state = np.zeros((3, n))
        self._fastest = np.zeros(1)
        self._tried = np.zeros((2 + 2 * MOST_TRIALS, n))

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        self.set_time_step(dt)
        self._fastest[0] = MOST_TURN / dt
        self._springs[0], self._springs[1] = self.stiffness, self.damping
        block, slot = np.divmod(np.arange(len(self.branches)), WIDTH)
        velocity = self.half[:, 6] + self.half[:, 7]
        compliance = np.einsum('bm,m->b', self.participation, velocity)  # not by threads
        self.loads['compliance'][block, slot] = compliance

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Advance one step under a mean wind [m/s], with `drag_law.pressure` in [kg/m^3].

        Returns how many loads were clamped to their limit, -1 if the motion is not finite.
        """
        return int(self._compiled(wx, wy, wz, per_speed_squared))

    @cached_property
    def _compiled(self) -> Callable[..., int]:
        arrays = (
            self.branches, self.work, self.loads, self.modal, self.state, self.by_coordinate,
            self.limit, self.whole, self.half, self._tried, self.momentum, self._fastest,
            self.inertia_slopes, self._springs,
        )  # fmt: skip
        return partial(entry_of(_advance, *arrays, 0.0, 0.0, 0.0, 0.0), *arrays)

    @cached_property
    def _compiled_expand(self) -> Callable[[], None]:
        arrays = self.by_coordinate, self.modal, self.state
        return partial(entry_of(_expand, *arrays), *arrays)

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return self.modal[:3], self.state[0], self.loads['drag_impulse']

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        self._compiled_expand()
        return np.asarray(self.state[1])

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""
        return self.rotations().copy(), self.shapes @ self.modal[1]

    def take_over(self, x: Floats, v: Floats) -> None:
        """Continue from key rotations and rates, (N,), projected on the modes."""
        self.reset()
        self.modal[0], self.modal[1] = self.projected(x, v)

    def reset(self) -> None:
        """Return to rest."""
        self.modal[:] = 0.0
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self.loads['drag_impulse'] = 0.0


@fused
def _expand(shapes: Floats, modal: Floats, state: Floats) -> None:
    """Expand modes to key rotations."""
    eta, x = modal[0], state[1]
    for i in range(len(x)):
        x[i] = 0.0
    for k in range(len(eta)):
        for i in range(len(x)):
            x[i] += shapes[k, i] * eta[k]


@part
def _to_middle(modal: Floats, state: Floats, shapes: Floats, half: Floats) -> None:
    """Key rotations and rates at the middle of the step, under the last step's load."""
    eta, rate, force = modal[0], modal[1], modal[2]
    middle_eta, middle_rate, x, v = modal[3], modal[4], state[1], state[2]
    for k in range(len(eta)):
        h = half[k]
        middle_eta[k] = h[0] * eta[k] + h[1] * rate[k] + (h[2] + h[3]) * force[k]
        middle_rate[k] = h[4] * eta[k] + h[5] * rate[k] + (h[6] + h[7]) * force[k]
    _expand_both(shapes, middle_eta, middle_rate, x, v)


@part
def _expand_both(shapes: Floats, eta: Floats, rate: Floats, x: Floats, v: Floats) -> None:
    """Expand modes and their rates to key rotations and their rates."""
    for i in range(len(x)):
        x[i], v[i] = 0.0, 0.0
    for k in range(len(eta)):
        for i in range(len(x)):
            x[i] += shapes[k, i] * eta[k]
            v[i] += shapes[k, i] * rate[k]


@fused
def _advance(
    branches: Branches, work: Works, loads: Loads, modal: Floats, state: Floats, shapes: Floats,
    limit: Floats, whole: Floats, half: Floats, trials: Floats, momentum: Floats, fastest: Floats,
    inertia_slopes: Floats, springs: Floats,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    eta, rate, force = modal[0], modal[1], modal[2]
    moment, x, v = state[0], state[1], state[2]
    residual, found = trials[0], trials[3]
    trial, clamped, total = 0, 0, 0.0
    while True:
        _to_middle(modal, state, shapes, half)
        wind_moments(branches, work, loads, x, v, found, wx, wy, wz, per_speed_squared)
        most = 0.0
        for i in range(len(moment)):
            residual[i] = LOAD_MAX * (found[i] - moment[i]) / limit[i]
            most = max(most, abs(residual[i]))
        trial += 1
        if most <= ENOUGH or trial == MOST_TRIALS:
            break
        _try_next(trials, trial)
        for i in range(len(moment)):
            moment[i] += trials[2, i] * limit[i] / LOAD_MAX
            moment[i] = min(max(moment[i], -limit[i]), limit[i])
        for k in range(len(eta)):
            force[k] = 0.0
            for i in range(len(moment)):
                force[k] += shapes[k, i] * moment[i]
    for i in range(len(moment)):
        if most <= ENOUGH:
            moment[i] = found[i]
        clamped += not abs(found[i]) <= limit[i]
    for k in range(len(eta)):
        load = 0.0
        for i in range(len(moment)):
            load += shapes[k, i] * moment[i]
        force[k] = load
    _add_inertia(modal, inertia_slopes, springs)
    for k in range(len(eta)):
        c, old, load = whole[k], eta[k], force[k]
        eta[k] = c[0] * old + c[1] * rate[k] + (c[2] + c[3]) * load
        rate[k] = c[4] * old + c[5] * rate[k] + (c[6] + c[7]) * load
        total += 0.0 * eta[k] + 0.0 * rate[k]
    if total != 0.0:
        return -1
    for i in range(len(x)):
        if not (abs(x[i]) <= FARTHEST and abs(v[i]) <= fastest[0]):
            _clamp(modal, state, shapes, momentum, fastest[0])
            return clamped + 1
    return clamped


@part
def _add_inertia(modal: Floats, slopes: Floats, springs: Floats) -> None:
    """
    Add to the forces on leading coordinates what the inertia of the bent tree changes.

    It is that of the middle of the step.

    Rows of ``springs`` are stiffness and damping; accelerations and the change of the inertia are
    written.
    """
    eta, rate, force, q, square = modal[3], modal[4], modal[2], len(slopes), 0.0
    free, new, before, change = springs[2], springs[3], springs[4], springs[5:]
    for i in range(q):
        free[i] = force[i] - springs[0, i] * eta[i] - springs[1, i] * rate[i]
        new[i] = free[i]
        for j in range(q):
            change[i, j] = 0.0
            for k in range(q):
                change[i, j] += slopes[i, j, k] * eta[k]
            square += change[i, j] * change[i, j]
    scale = min(1.0, MOST_CHANGE / math.sqrt(max(square, 1e-300)))
    for _ in range(TURNS):
        for i in range(q):
            before[i] = new[i]
        for i in range(q):
            new[i] = free[i]
            for j in range(q):
                new[i] -= scale * change[i, j] * before[j]
    for i in range(q):
        force[i] += new[i] - free[i]


@part
def _clamp(modal: Floats, state: Floats, shapes: Floats, momentum: Floats, fastest: float) -> None:
    """Clamp rotations and rates of branches to the limits of a step."""
    eta, rate, x, v = modal[0], modal[1], state[1], state[2]
    _expand_both(shapes, eta, rate, x, v)
    for i in range(len(x)):
        x[i] = min(max(x[i], -FARTHEST), FARTHEST)
        v[i] = min(max(v[i], -fastest), fastest)
    for k in range(len(eta)):
        eta[k], rate[k] = 0.0, 0.0
        for i in range(len(x)):
            eta[k] += momentum[k, i] * x[i]
            rate[k] += momentum[k, i] * v[i]


@part
def _try_next(trials: Floats, trial: int) -> None:
    """
    Find the change of the moments that should make the residual zero, in [rad].

    Rows of ``trials`` are the residual, the one before, and the last change, which is written;
    after the next row, pairs of an orthonormal response and the change that causes it (Anderson's
    mixing; Walker & Ni 2011, SIAM Journal on Numerical Analysis 49, 1715-1735).
    """
    residual, before, change = trials[0], trials[1], trials[2]
    if trial > 1:
        response, step = trials[2 * trial], trials[2 * trial + 1]
        for i in range(len(residual)):
            response[i], step[i] = residual[i] - before[i], change[i]
        for other in range(2, trial):
            _project_out(response, step, trials[2 * other], trials[2 * other + 1])
        square = 0.0
        for i in range(len(residual)):
            square += response[i] * response[i]
        scale = 1.0 / math.sqrt(max(square, 1e-300))
        for i in range(len(residual)):
            response[i], step[i] = scale * response[i], scale * step[i]
    for i in range(len(residual)):
        before[i], change[i] = residual[i], 0.0
    for other in range(2, trial + 1):
        _project_out(residual, change, trials[2 * other], trials[2 * other + 1])
    most = 0.0
    for i in range(len(residual)):
        change[i] += residual[i]
        most = max(most, abs(change[i]))
    for i in range(len(residual)):
        change[i] *= min(1.0, MOST_TURN / most)


@part
def _project_out(response: Floats, step: Floats, other: Floats, by: Floats) -> None:
    """Project a response orthogonal to a previous one, and its change with it."""
    share = 0.0
    for i in range(len(response)):
        share += response[i] * other[i]
    for i in range(len(response)):
        response[i] -= share * other[i]
        step[i] -= share * by[i]
