# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full`: all coordinates of a tree, under the load on every branch.

It is the reference of the table models: its load is found branch by branch, in the wind and at the
motion of each, at the state in the middle of the step, and is constant over the step.

**Implicit load.** The motion in a step changes the load itself: twigs in a storm point along the
wind within a fraction of a step. The drag of a bent tree may stop a coordinate within a hundredth
of a step: its inertia is that at rest, where a stem that twists moves no crown. So the load is
iterated until it is that of the resulting state; in light wind, where the last step's load is
close enough, once. The best of `MOST_TRIALS` is taken where none is close, and the step is counted
as clamped. Moments and drag impulses of the branches, by which the load of each is implicit in its
own motion, are mixed alike, for the load depends on both. Rotations beyond the limit of a step are
clamped and counted.

Symbols: Phi mode shapes (N, m), stored by mode, (m, N), eta modal coordinates, Q moments
on the key rotations, w circular frequencies.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.drag import drag_density
from tree_sway.core.model import SwayModel, WIDTH
from tree_sway.core.oscillators import LOAD_MAX, step_propagators
from tree_sway.core.run import FARTHEST, ModalCoordinates
from tree_sway.core.setup import MOST_CHANGE
from tree_sway_lab.full.branch_loads import wind_moments
from tree_sway_lab.full.load_layouts import Branches, Loads, WORK, Works
from tree_sway_lab.full.load_records import load_records
from tree_sway_lab.kernel import entry_of, fused, part

MOST_TRIALS = 60
"""Largest number of iterations for the load of a step."""

ENOUGH, WITHIN = 0.02, 1.0 / 60.0
"""
Largest change of the load, as the rotation that it makes [rad], with which a step follows the last
one without iteration, and the length [s] of the shortest such step; less in shorter ones.
"""

SOLVED = 0.05
"""Tolerance of an iterated load, over the change with which no step is iterated."""

DEPENDENT = 1e-3
"""
Share of a trial's response that newer ones must leave unexplained, or it is forgotten.

First trials of a step may miss by 100 rad: what they tell of the load is wrong near the solution.
"""

TURNS = 10
"""Iterations for the accelerations of the bent tree: each leaves `MOST_CHANGE` of the error."""

MOST_TURN = 1.0
"""Largest rotation of a branch on its parent in a step, in [rad]."""

NOT_FINITE = -1
"""Result of a step after which the motion is not finite."""


class Motion(NamedTuple):
    """The state of all coordinates; views of the memory of a `FullBank`."""

    eta: Floats
    """Modal coordinates, (m,)."""
    rate: Floats
    force: Floats
    """Force on each in the last step, (m,)."""
    middle: Floats
    """Coordinates in the middle of the step, (m,)."""
    middle_rate: Floats


class Keys(NamedTuple):
    """Key rotations of the branches; views of the memory of a `FullBank`."""

    moment: Floats
    """Moment on each in the last step in [N m], (N,)."""
    rotation: Floats
    """In [rad], (N,)."""
    rate: Floats


class Law(NamedTuple):
    """Constants of a step."""

    shapes: Floats
    """Key rotations per unit of each coordinate, (m, N)."""
    momentum: Floats
    """Coordinates by key rotations, (m, N)."""
    limit: Floats
    """Moment at which the load on each key rotation is clamped in [N m], (N,)."""
    whole: Floats
    """Propagator of a step under a constant force, (6, m)."""
    half: Floats
    """Propagator to the middle of a step, (6, m)."""
    springs: Floats
    """Stiffness and damping of the coordinates, then memory of `_add_inertia`, (5 + q, m)."""
    inertia_slopes: Floats
    """Change of the mass matrix by the first coordinates, (q, q, q)."""
    fastest: Floats
    """Largest rate of a branch on its parent in [rad/s], (1,)."""
    enough: Floats
    """Largest change of the load with which no step is iterated [rad], (1,)."""


class Air(NamedTuple):
    """The mean wind of a step in [m/s], and its `drag_law.drag_density` in [kg/m^3]."""

    x: float
    y: float
    z: float
    per_speed_squared: float


class FullBank(ModalCoordinates):
    """Oscillators of the coordinates of a tree, loaded branch by branch."""

    n_outside = 0
    """There is no table, so no step is outside."""

    def __init__(self, branches: Records, model: SwayModel) -> None:
        """Make room for the state."""
        super().__init__(model)
        self.drag_law = model.drag_law
        self.by_coordinate = self.shapes.T
        self.momentum = model.projection
        self.participation = model.participation
        self.inertia_slopes = model.inertia_slopes
        m, n = self.by_coordinate.shape
        self.whole, self.half = np.zeros((2, 6, m))
        self._springs = np.zeros((5 + len(self.inertia_slopes), m))
        self.work = np.zeros(len(branches), dtype=WORK)
        self.loads = load_records(branches)
        """Records of `load_layout`."""
        self.modal = np.zeros((5, m))
        self._motion = Motion(*self.modal)
        self.swing = tuple(self.modal[:3])
        """Displacement, rate and force of each mode, (m,)."""
        self.state = np.zeros((3, n))
        self._keys = Keys(*self.state)
        self._fastest, self._enough = np.zeros((2, 1))
        self._tried = np.zeros((2 + 4 * MOST_TRIALS, n + self.loads['drag_impulse'].size))

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        self.dt = dt
        whole, half = step_propagators(self.damping, self.stiffness, dt)
        self.whole[:] = whole.reshape(6, -1)
        self.half[:] = half.reshape(6, -1)
        self._fastest[0] = MOST_TURN / dt
        self._enough[0] = ENOUGH * min(1.0, dt / WITHIN)
        self._springs[0], self._springs[1] = self.stiffness, self.damping
        block, slot = np.divmod(np.arange(len(self.branches)), WIDTH)
        compliance = np.einsum('bm,m->b', self.participation, self.half[5])  # not by threads
        self.loads['compliance'][block, slot] = compliance

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """
        Advance one step under a mean wind [m/s].

        Returns how many loads were clamped to their limit, one more if no trial of the load was
        close enough; `NOT_FINITE` if the motion is not finite.
        """
        return self.advance_in(Air(wx, wy, wz, self.density(wx, wy, wz)))

    def density(self, wx: float, wy: float, wz: float) -> float:
        """Drag density in a wind [m/s], in [kg/m^3]."""
        return drag_density(math.hypot(wx, wy, wz), *self.drag_law)

    def advance_in(self, air: Air) -> int:
        """Advance one step in a wind of a given drag density, as `advance`."""
        return int(self._compiled(air))

    @cached_property
    def _compiled(self) -> Callable[[Air], int]:
        law = Law(
            self.by_coordinate, self.momentum, self.limit, self.whole, self.half, self._springs,
            self.inertia_slopes, self._fastest, self._enough,
        )  # fmt: skip
        records = self.branches, self.work, self.loads
        arrays = *records, self._motion, self._keys, law, self._tried
        return partial(entry_of(_advance, *arrays, Air(0.0, 0.0, 0.0, 0.0)), *arrays)

    @cached_property
    def _compiled_expand(self) -> Callable[[], None]:
        arrays = self.by_coordinate, self._motion.eta, self._keys.rotation
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

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        forces: Floats = self.work['force']
        return forces

    def reset(self) -> None:
        """Return to rest."""
        self.modal[:] = 0.0
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self.loads['drag_impulse'] = 0.0


@fused
def _expand(shapes: Floats, amounts: Floats, rotations: Floats) -> None:
    """Sum shapes by amounts, (m,), to key rotations or their rates, (N,)."""
    for i in range(len(rotations)):
        rotations[i] = 0.0
    for k in range(len(amounts)):
        for i in range(len(rotations)):
            rotations[i] += shapes[k, i] * amounts[k]


@part
def _to_middle(motion: Motion, keys: Keys, law: Law) -> None:
    """Find key rotations and rates at the middle of the step, under the last step's load."""
    eta, rate, force = motion.eta, motion.rate, motion.force
    for k in range(len(eta)):
        c = law.half[:, k]
        motion.middle[k] = c[0] * eta[k] + c[1] * rate[k] + c[2] * force[k]
        motion.middle_rate[k] = c[3] * eta[k] + c[4] * rate[k] + c[5] * force[k]
    _expand_both(law.shapes, motion.middle, motion.middle_rate, keys)


@part
def _expand_both(shapes: Floats, eta: Floats, rate: Floats, keys: Keys) -> None:
    """Expand modes and their rates to key rotations and their rates."""
    for i in range(len(keys.rotation)):
        keys.rotation[i], keys.rate[i] = 0.0, 0.0
    for k in range(len(eta)):
        for i in range(len(keys.rotation)):
            keys.rotation[i] += shapes[k, i] * eta[k]
            keys.rate[i] += shapes[k, i] * rate[k]


@fused
def _advance(
    branches: Branches,
    work: Works,
    loads: Loads,
    motion: Motion,
    keys: Keys,
    law: Law,
    trials: Floats,
    air: Air,
) -> int:
    """
    Advance one step; returns how many loads were clamped, or were not found, or `NOT_FINITE`.

    The load is iterated until it is that of the motion which it makes: rows of ``trials`` are
    those of `_try_next`, and the one that is left has moments and drag impulses of a trial.
    """
    moment, limit = keys.moment, law.limit
    n = len(moment)
    change, found, impulse = trials[2], trials[3, :n], trials[3, n:]
    _read_impulses(loads, impulse)
    best, least, trial = trials[-1], math.inf, 0
    while True:
        _to_middle(motion, keys, law)
        wind_moments(
            branches, work, loads, keys.rotation, keys.rate, found,
            air.x, air.y, air.z, air.per_speed_squared,
        )  # fmt: skip
        most = _find_residual(loads, moment, limit, trials)
        trial += 1
        if most < least:
            least = most
            _copy(moment, best[:n])
            _copy(impulse, best[n:])
        enough = law.enough[0] if trial == 1 else SOLVED * law.enough[0]
        if most <= enough or trial == MOST_TRIALS:
            break
        if trial == MOST_TRIALS - 1:
            _copy(best[:n], moment)
            _copy(best[n:], impulse)
        else:
            _try_next(trials, trial, n)
            for i in range(n):
                moment[i] += change[i] * limit[i] / LOAD_MAX
                moment[i] = min(max(moment[i], -limit[i]), limit[i])
            for i in range(len(impulse)):
                impulse[i] += change[n + i]
        _write_impulses(impulse, loads)
        _project_load(motion, keys, law)
    n_clamped = 1 if most > enough else 0
    for i in range(n):
        if most <= enough:
            moment[i] = found[i]
        n_clamped += not abs(found[i]) <= limit[i]
    _project_load(motion, keys, law)
    _add_inertia(motion, law)
    _to_end(motion, law)
    if not _is_finite(motion):
        return NOT_FINITE
    for i in range(len(keys.rotation)):
        is_near = abs(keys.rotation[i]) <= FARTHEST
        if not (is_near and abs(keys.rate[i]) <= law.fastest[0]):
            _clamp(motion, keys, law)
            return n_clamped + 1
    return n_clamped


@part
def _copy(values: Floats, into: Floats) -> None:
    """Write values into memory of the same length."""
    for i in range(len(values)):
        into[i] = values[i]


@part
def _read_impulses(loads: Loads, impulse: Floats) -> None:
    """Write the drag impulses of all branches, one after another."""
    for block in range(len(loads)):
        of_block = loads[block].drag_impulse
        for k in range(3):
            for j in range(WIDTH):
                impulse[(3 * block + k) * WIDTH + j] = of_block[k, j]


@part
def _write_impulses(impulse: Floats, loads: Loads) -> None:
    """Write drag impulses, one after another, into the records of all branches."""
    for block in range(len(loads)):
        of_block = loads[block].drag_impulse
        for k in range(3):
            for j in range(WIDTH):
                of_block[k, j] = impulse[(3 * block + k) * WIDTH + j]


@part
def _find_residual(loads: Loads, moment: Floats, limit: Floats, trials: Floats) -> float:
    """
    Write what a trial's load lacks to that of its motion; return the largest rotation [rad].

    Moments are as the rotation that they make, drag impulses after them as they are.
    """
    n = len(moment)
    residual, tried = trials[0], trials[3]
    most = 0.0
    for i in range(n):
        residual[i] = LOAD_MAX * (tried[i] - moment[i]) / limit[i]
        most = max(most, abs(residual[i]))
    _read_impulses(loads, residual[n:])
    for i in range(n, len(residual)):
        residual[i] -= tried[i]
    return most


@part
def _project_load(motion: Motion, keys: Keys, law: Law) -> None:
    """Project the moments on key rotations on the coordinates: ``f = Phi^T Q``."""
    for k in range(len(motion.force)):
        load = 0.0
        for i in range(len(keys.moment)):
            load += law.shapes[k, i] * keys.moment[i]
        motion.force[k] = load


@part
def _to_end(motion: Motion, law: Law) -> None:
    """Move every coordinate exactly, over a step under its force."""
    eta, rate = motion.eta, motion.rate
    for k in range(len(eta)):
        c, before, load = law.whole[:, k], eta[k], motion.force[k]
        eta[k] = c[0] * before + c[1] * rate[k] + c[2] * load
        rate[k] = c[3] * before + c[4] * rate[k] + c[5] * load


@part
def _is_finite(motion: Motion) -> bool:
    """Whether all coordinates and rates are finite."""
    n_finite = 0
    for k in range(len(motion.eta)):
        n_finite += math.isfinite(motion.eta[k]) and math.isfinite(motion.rate[k])
    return n_finite == len(motion.eta)


@part
def _add_inertia(motion: Motion, law: Law) -> None:
    """
    Add to the forces on leading coordinates what the inertia of the bent tree changes.

    It is that of the middle of the step. Of the accelerations a, free ones a0 and the change C of
    the mass matrix, ``a = a0 - C a`` is iterated.
    """
    slopes, force = law.inertia_slopes, motion.force
    stiffness, damping = law.springs[0], law.springs[1]
    free, new, before, change = law.springs[2], law.springs[3], law.springs[4], law.springs[5:]
    count, square = len(slopes), 0.0
    for i in range(count):
        free[i] = force[i] - stiffness[i] * motion.middle[i] - damping[i] * motion.middle_rate[i]
        new[i] = free[i]
        for j in range(count):
            change[i, j] = 0.0
            for k in range(count):
                change[i, j] += slopes[i, j, k] * motion.middle[k]
            square += change[i, j] * change[i, j]
    scale = min(1.0, MOST_CHANGE / math.sqrt(max(square, 1e-300)))
    for _ in range(TURNS):
        for i in range(count):
            before[i] = new[i]
        for i in range(count):
            new[i] = free[i]
            for j in range(count):
                new[i] -= scale * change[i, j] * before[j]
    for i in range(count):
        force[i] += new[i] - free[i]


@part
def _clamp(motion: Motion, keys: Keys, law: Law) -> None:
    """Clamp rotations and rates of branches to the limits of a step."""
    fastest = law.fastest[0]
    eta, rate, x, v = motion.eta, motion.rate, keys.rotation, keys.rate
    _expand_both(law.shapes, eta, rate, keys)
    for i in range(len(x)):
        x[i] = min(max(x[i], -FARTHEST), FARTHEST)
        v[i] = min(max(v[i], -fastest), fastest)
    for k in range(len(eta)):
        eta[k], rate[k] = 0.0, 0.0
        for i in range(len(x)):
            eta[k] += law.momentum[k, i] * x[i]
            rate[k] += law.momentum[k, i] * v[i]


@part
def _try_next(trials: Floats, trial: int, n: int) -> None:
    """
    Find the change of moments and drag impulses that should make the residual zero.

    Rows of ``trials`` are the residual, the one before, and the last change, which is written;
    after the next row, pairs of a response and the change that causes it; in the second half, the
    same pairs, orthonormal in their n moments from the newest on, and zero where newer ones leave
    no more than `DEPENDENT` of it; last, the best trial (Anderson's mixing; Walker & Ni 2011, SIAM
    Journal on Numerical Analysis 49, 1715-1735).
    """
    residual, before, change = trials[0], trials[1], trials[2]
    for i in range(len(residual)):
        if trial > 1:
            trials[2 * trial, i] = residual[i] - before[i]
            trials[2 * trial + 1, i] = change[i]
        before[i], change[i] = residual[i], 0.0
    for of in range(trial, 1, -1):
        at = 2 * MOST_TRIALS + 2 * of
        response, step = trials[at], trials[at + 1]
        _copy(trials[2 * of], response)
        _copy(trials[2 * of + 1], step)
        square = _square(response[:n])
        for newer in range(trial, of, -1):
            other = 2 * MOST_TRIALS + 2 * newer
            _project_out(response, step, trials[other], trials[other + 1], n)
        left, scale = _square(response[:n]), 0.0
        if left > DEPENDENT * DEPENDENT * square:
            scale = 1.0 / math.sqrt(left)
        for i in range(len(residual)):
            response[i], step[i] = scale * response[i], scale * step[i]
        _project_out(residual, change, response, step, n)
    most = 0.0
    for i in range(len(residual)):
        change[i] += residual[i]
    for i in range(n):
        most = max(most, abs(change[i]))
    for i in range(len(residual)):
        change[i] *= min(1.0, MOST_TURN / most)


@part
def _square(values: Floats) -> float:
    """Sum the squares of values."""
    total = 0.0
    for i in range(len(values)):
        total += values[i] * values[i]
    return total


@part
def _project_out(response: Floats, step: Floats, other: Floats, by: Floats, n: int) -> None:
    """Project n moments of a response orthogonal to a previous one, and its change with it."""
    share = 0.0
    for i in range(n):
        share += response[i] * other[i]
    for i in range(len(response)):
        response[i] -= share * other[i]
        step[i] -= share * by[i]
