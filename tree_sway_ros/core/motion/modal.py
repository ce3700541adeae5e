# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Models 3 and 4 of the ladder: natural modes of the coupled tree on the same oscillators.

Model 3, `modes`, steps the m slowest modes and takes what is left of the motion as static,
``x = D Q + Phi (eta - E^T Q)``: D is the diagonal of the flexibility, and E takes out of it what
the modes already hold. Model 4, `coupled`, steps all modes and leaves nothing. As in models 1 and
2 the load is found once per step, at the state half a step on.

Symbols: Phi mode shapes (N, m), held and passed by mode, (m, N), eta modal coordinates, Q moments
on the key rotations, w circular frequencies.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Records
from tree_sway_ros.core.branch.beam import cross_matrix
from tree_sway_ros.core.kernel import entry_of, fused
from tree_sway_ros.core.motion.fill_records import load_records
from tree_sway_ros.core.motion.records import LANES, WORK
from tree_sway_ros.core.motion.tree_passes import bent_loads, outward_pass, wind_forces
from tree_sway_ros.core.oscillators.propagator import fill_propagator
from tree_sway_ros.core.oscillators.rule_names import DEFAULT
from tree_sway_ros.core.oscillators.step_rules import fill_steps
from tree_sway_ros.core.oscillators.two_axis import LOAD_MAX
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.reduction.modes import Modes


class ModalBank:
    """
    Oscillators of natural modes of a tree, its slowest or all, of one damping ratio.

    ``made_of`` are the arrays of `modal_arrays`; the integrator is one of `REAL_TIME`.
    """

    carries = True
    is_tabled = False
    n_outside, table_error = 0, 0.0

    def __init__(
        self,
        branches: Records,
        made_of: Mapping[str, Floats],
        damping_ratio: float,
        integrator: str = DEFAULT,
    ) -> None:
        """Make room for the coefficients and the state."""
        self._shapes, self.integrator = made_of['shapes'], integrator
        m, n = self._shapes.shape
        self.branches, self.shapes = branches, self._shapes.T
        self.stiffness = made_of['circular'] ** 2
        self.damping = 2.0 * damping_ratio * made_of['circular']
        self.flexibility, self.held = made_of['flexibility'].copy(), made_of['held'].copy()
        self.limit = LOAD_MAX * made_of['diagonal']
        self.weight = made_of['weight']
        """Stiffness by gravity of each mode in [1/s^2], (m,); below 0 where weight softens it."""
        self._momentum = made_of['momentum'].T
        self._participation = made_of['participation']
        self.work = np.zeros(len(branches), dtype=WORK)
        self._loads = load_records(branches)
        self.modal = np.zeros((6, m))
        self.state = np.zeros((4, n))
        self.whole, self.half = np.zeros((2, m, 8))

    @property
    def loads(self) -> Records:
        """Return the records of `load_fields`."""
        return self._loads

    def set_pace(self, dt: float) -> None:
        """Refill how the modes go on in a time step [s]."""
        one = np.ones(len(self.stiffness))
        fill_steps(self.integrator, one, self.damping, self.stiffness, dt, self.whole)
        fill_propagator(one, self.damping, self.stiffness, 0.5 * dt, self.half)

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""
        self.set_pace(dt)
        block, lane = np.divmod(np.arange(len(self.branches)), LANES)
        velocity = self.half[:, 6] + self.half[:, 7]
        compliance = np.einsum('bm,m->b', self._participation, velocity)  # not by threads
        self._loads['compliance'][block, lane] = compliance

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Advance one step under a mean wind [m/s], with `drag.pressure` in [kg/m^3].

        Returns how many loads were held at their limit, -1 if the motion is not finite.
        """
        return int(self._compiled(wx, wy, wz, per_speed_squared))

    @cached_property
    def _compiled(self) -> Callable[..., int]:
        arrays = (
            self.branches, self.work, self._loads, self.modal, self.state, self._shapes, self.held,
            self.flexibility, self.limit, self.whole, self.half,
        )  # fmt: skip
        return partial(entry_of(_advance, *arrays, 0.0, 0.0, 0.0, 0.0), *arrays)

    @cached_property
    def _compiled_expand(self) -> Callable[[], None]:
        arrays = (self._shapes, self.flexibility, self.modal, self.state)
        return partial(entry_of(_expand, *arrays), *arrays)

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """Key rotations (N, k, f) at rest under moments (N, k) [N m] that swing at w [rad/s]."""
        impedance = self.stiffness[:, None] - circular**2 + 1j * self.damping[:, None] * circular
        dynamic = (self.shapes.T @ moments)[:, :, None] / impedance[:, None, :]
        eta = dynamic - (self.held @ moments)[:, :, None]
        rest = self.flexibility[:, None, None] * moments[:, :, None]
        swinging: NDArray[np.complex128] = np.einsum('im,mkf->ikf', self.shapes, eta) + rest
        return np.asarray(swinging, dtype=np.complex128)

    def memory(self) -> tuple[Floats, ...]:
        """Return views of what is carried from one step to the next."""
        return self.modal[:4], self.state[0], self._loads['slip']

    def take(self, eta: Floats, rate: Floats, force: Floats, rotations: Floats) -> None:
        """Go on from modes, rates and forces (m,) and key rotations (N,), static rest included."""
        self.modal[0], self.modal[1], self.modal[2], self.modal[3] = eta, rate, 0.0, force
        rest = rotations - self.shapes @ eta
        bends = self.flexibility > 0.0
        self.state[0] = np.where(bends, rest, 0.0) / np.where(bends, self.flexibility, 1.0)
        self._loads['slip'] = 0.0

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        self._compiled_expand()
        rotations: Floats = self.state[3]
        return rotations

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""
        return self.rotations().copy(), self.shapes @ self.modal[1]

    def take_over(self, x: Floats, v: Floats) -> None:
        """Go on from key rotations and rates, (N,), as far as the modes can follow them."""
        self.reset()
        self.modal[0], self.modal[1] = self._momentum @ x, self._momentum @ v

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""
        forces: Floats = self.work['force']
        return forces

    def reset(self) -> None:
        """Go back to rest."""
        self.modal[:] = 0.0
        self.state[:] = 0.0
        self.work[:] = np.zeros((), dtype=WORK)
        self._loads['slip'] = 0.0


def modal_arrays(branches: Records, reduction: Reduction, modes: Modes) -> dict[str, Floats]:
    """Find what a `ModalBank` is made of, all of it arrays that can be kept."""
    n, m = modes.shapes.shape
    # One mode after another, so that a loop over coordinates is one of vectors.
    shapes = np.ascontiguousarray(modes.shapes.T)
    flexibility = reduction.flexibility if m < n else np.zeros(n)
    held = reduction.stiffness @ modes.shapes * flexibility[:, None] / modes.circular**2
    return {
        'circular': modes.circular,
        'shapes': shapes,
        'flexibility': flexibility,
        'held': np.ascontiguousarray(held.T),
        'diagonal': np.asarray(reduction.stiffness.diagonal()),
        'weight': np.einsum('im,im->m', shapes.T, reduction.gravity @ shapes.T),
        'momentum': reduction.mass @ modes.shapes,
        'participation': _participation(branches, modes.shapes),
    }


def _participation(branches: Records, shapes: Floats) -> Floats:
    """Mean squared motion of each load centre in each mode, over three directions, (b, m)."""
    m = shapes.shape[1]
    motion = np.zeros((len(branches), 6, m))
    out = np.zeros((len(branches), m))
    for b, branch in enumerate(branches):
        own = slice(branch['coordinate'], branch['coordinate'] + branch['n_coordinates'])
        if b > 0:
            parent = branches[branch['parent']]
            k = parent['n_coordinates']
            moved = shapes[parent['coordinate'] : parent['coordinate'] + k]
            motion[b] = motion[branch['parent']] + branch['twist'][:k].T @ moved
        at = motion[b, :3] - cross_matrix(branch['centre']) @ motion[b, 3:]
        at += branch['flow'][: branch['n_coordinates']].T @ shapes[own]
        out[b] = np.square(at).sum(axis=0) / 2.0
    return out


@fused
def _expand(shapes: Floats, flexibility: Floats, modal: Floats, state: Floats) -> None:
    """Modes and static rest to key rotations."""
    eta, rest, moment, x = modal[0], modal[2], state[0], state[3]
    for i in range(len(x)):
        x[i] = flexibility[i] * moment[i]
    for k in range(len(eta)):
        amount = eta[k] - rest[k]
        for i in range(len(x)):
            x[i] += shapes[k, i] * amount


@fused
def _to_middle(
    modal: Floats, state: Floats, shapes: Floats, half: Floats, flexibility: Floats
) -> None:
    """Key rotations and rates half a step on, under the last step's load."""
    eta, rate, rest, force, middle_eta, middle_rate = (
        modal[0], modal[1], modal[2], modal[3], modal[4], modal[5],
    )  # fmt: skip
    moment, x, v = state[0], state[1], state[2]
    for k in range(len(eta)):
        h = half[k]
        middle_eta[k] = h[0] * eta[k] + h[1] * rate[k] + (h[2] + h[3]) * force[k] - rest[k]
        middle_rate[k] = h[4] * eta[k] + h[5] * rate[k] + (h[6] + h[7]) * force[k]
    for i in range(len(x)):
        x[i], v[i] = flexibility[i] * moment[i], 0.0
    for k in range(len(eta)):
        amount, pace = middle_eta[k], middle_rate[k]
        for i in range(len(x)):
            x[i] += shapes[k, i] * amount
            v[i] += shapes[k, i] * pace


@fused
def wind_moments(
    branches: Records, work: Records, loads: Records, x: Floats, v: Floats, moment: Floats,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> None:  # fmt: skip
    """
    Find the moments of a wind on the key rotations of a tree that bends and moves.

    They are written as by `bent_loads`; key rotations are in [rad], their rates in [rad/s], (N,).
    """
    outward_pass(branches, work, x, v)
    for b in range(len(branches)):
        here, j, i = loads[b // LANES], b % LANES, branches[b].coordinate
        for c in range(branches[b].n_coordinates):
            here.x[c, j], here.v[c, j] = x[i + c], v[i + c]
    wind_forces(branches, work, loads, True, wx, wy, wz, per_speed_squared)
    bent_loads(branches, work, loads, moment)


@fused
def _advance(
    branches: Records, work: Records, loads: Records, modal: Floats, state: Floats, shapes: Floats,
    held: Floats, flexibility: Floats, limit: Floats, whole: Floats, half: Floats,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    _to_middle(modal, state, shapes, half, flexibility)
    eta, rate, rest, force = modal[0], modal[1], modal[2], modal[3]
    moment, x, v = state[0], state[1], state[2]
    wind_moments(branches, work, loads, x, v, moment, wx, wy, wz, per_speed_squared)
    over, total = 0, 0.0
    for i in range(len(moment)):
        if not abs(moment[i]) <= limit[i]:
            moment[i] = limit[i] if moment[i] > 0.0 else -limit[i]
            over += 1
    for k in range(len(eta)):
        pushed, resting = 0.0, 0.0
        for i in range(len(moment)):
            pushed += shapes[k, i] * moment[i]
            resting += held[k, i] * moment[i]
        force[k], rest[k] = pushed, resting
        c, old = whole[k], eta[k]
        eta[k] = c[0] * old + c[1] * rate[k] + (c[2] + c[3]) * force[k]
        rate[k] = c[4] * old + c[5] * rate[k] + (c[6] + c[7]) * force[k]
        total += 0.0 * eta[k] + 0.0 * rate[k] + 0.0 * rest[k]
    return over if total == 0.0 else -1
