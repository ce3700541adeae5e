# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Banks of oscillators in plain numpy, for machines without a compiler: some 100 times slower.

Each has the state of its compiled counterpart, in the same arrays, so that stored states are
exchangeable; they agree to rounding. They are the oracle of the kernels as well.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.numpy_rotation import two_axis_moment, within_guard
from tree_sway.core.oscillators.two_axis import LOAD_MAX
from tree_sway.core.run.branch_oscillators import UncoupledBank
from tree_sway.core.run.modal import (
    ENOUGH,
    FARTHEST,
    ModalBank,
    MOST_TRIALS,
    MOST_TURN,
    TURNS,
)
from tree_sway.core.setup.bent_inertia import inertia_change
from tree_sway.core.setup.numpy_branch_loads import Bases, into_slots, NumpyPasses, of_slots


class NumpyUncoupledBank(UncoupledBank):
    """`UncoupledBank` in numpy."""

    def __init__(self, *arguments: Any) -> None:
        """Lay out as `UncoupledBank`, and sort by levels."""
        super().__init__(*arguments)
        self._passes = NumpyPasses(self.branches)

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        super().set_step(dt)
        n = len(self.branches)
        names = ('whole', 'half', 'guard', 'compliance')
        self._whole, self._half, self._guard, self._compliance = (
            of_slots(self.loads[name], n) for name in names
        )

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `UncoupledBank.advance`."""
        passes, n = self._passes, len(self.branches)
        x, v = self.x.reshape(-1, 2), self.v.reshape(-1, 2)
        load, impulse = (
            of_slots(self.loads['load'], n),
            of_slots(self.loads['drag_impulse'], n).copy(),
        )
        none = np.zeros(n)
        moment = two_axis_moment(x, v, load, none, np.inf)
        h = self._half[:, :, None]
        middle_x = within_guard(h[:, 0] * x + h[:, 1] * v + h[:, 2] * moment)
        middle_v = h[:, 3] * x + h[:, 4] * v + h[:, 5] * moment
        base = Bases.at_rest(n)
        wind = np.array([wx, wy, wz]) + of_slots(self.loads['gust'], n)
        force = passes.wind_forces(
            base, middle_x, middle_v, wind, per_speed_squared, self._compliance, impulse
        )
        force = passes.at_bases(middle_x, force)
        load = passes.own_loads(force)
        self.work['force'] = force
        into_slots(impulse, self.loads['drag_impulse'])
        into_slots(load, self.loads['load'])
        return self._step(x, v, load)

    def _step(self, x: Floats, v: Floats, load: Floats) -> int:
        """Step every oscillator, predictor and corrector; returns how many loads were clamped."""
        gyro, load_limit, moment_limit = self._guard.T
        with np.errstate(all='ignore'):
            size = np.sqrt(np.einsum('bk,bk->b', load, load))
            clamped = ~(size <= load_limit)
            load = load.copy()
            load[clamped] *= np.where(
                np.isfinite(size[clamped]), load_limit[clamped] / size[clamped], 0.0
            )[:, None]
        load[~np.isfinite(load).all(axis=1)] = 0.0
        c = self._whole[:, :, None]
        now = two_axis_moment(x, v, load, gyro, moment_limit)
        ahead_x = c[:, 0] * x + c[:, 1] * v + c[:, 2] * now
        ahead_v = c[:, 4] * x + c[:, 5] * v + c[:, 6] * now
        then = two_axis_moment(
            ahead_x + c[:, 3] * now, ahead_v + c[:, 7] * now, load, gyro, moment_limit
        )
        x[:], v[:] = ahead_x + c[:, 3] * then, ahead_v + c[:, 7] * then
        if not (np.isfinite(x).all() and np.isfinite(v).all()):
            return -1
        return int(clamped.sum())


class NumpyModalBank(ModalBank):
    """`ModalBank` in numpy."""

    def __init__(self, *arguments: Any) -> None:
        """Lay out as `ModalBank`, and sort by levels."""
        super().__init__(*arguments)
        self._passes = NumpyPasses(self.branches)
        self._hidden, self._count = np.zeros(len(self.stiffness)), len(self.stiffness)

    def show(self, hidden: Floats, count: int) -> None:
        """Show the first coordinates only, without a hidden part of each, (m,)."""
        self._hidden, self._count = hidden.copy(), count

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `ModalBank.advance`."""
        passes, n = self._passes, len(self.branches)
        eta, rate, force = self.modal[:3]
        moment, found = self.state[0], np.empty(self.state.shape[1])
        h, c = self.half.T, self.whole.T
        impulse = of_slots(self.loads['drag_impulse'], n).copy()
        wind = np.array([wx, wy, wz]) + of_slots(self.loads['gust'], n)
        compliance = of_slots(self.loads['compliance'], n)
        trials: list[tuple[Floats, Floats]] = []
        for trial in range(MOST_TRIALS):
            middle = h[0] * eta + h[1] * rate + (h[2] + h[3]) * force
            middle_rate = h[4] * eta + h[5] * rate + (h[6] + h[7]) * force
            x, v = _summed(middle, self._shapes), _summed(middle_rate, self._shapes)
            angles, rates = passes.per_branch(x), passes.per_branch(v)
            bases = passes.outward(angles, rates)
            on_branches = passes.wind_forces(
                bases, angles, rates, wind, per_speed_squared, compliance, impulse
            )
            self.work['force'] = passes.bent_loads(bases, angles, on_branches, found)
            residual = LOAD_MAX * (found - moment) / self.limit
            if np.abs(residual).max() <= ENOUGH:
                moment[:] = found
                break
            if trial == MOST_TRIALS - 1:
                break
            if trials:
                response, step = residual - trials[-1][0], trials[-1][1]
                for other, by in trials[:-1]:
                    share = response @ other
                    response, step = response - share * other, step - share * by
                scale = 1.0 / max(float(np.linalg.norm(response)), 1e-150)
                trials[-1] = scale * response, scale * step
            left, change = residual, np.zeros_like(residual)
            for other, by in trials:
                share = left @ other
                left, change = left - share * other, change - share * by
            change = change + left
            most = float(np.abs(change).max())
            if most > MOST_TURN:
                change *= MOST_TURN / most
            trials.append((residual, change))
            moment[:] = np.clip(moment + change * self.limit / LOAD_MAX, -self.limit, self.limit)
            force[:] = np.einsum('mi,i->m', self._shapes, moment)
        into_slots(impulse, self.loads['drag_impulse'])
        force[:] = np.einsum('mi,i->m', self._shapes, moment)
        change = inertia_change(self.inertia_slopes, middle)
        free = (force - self.stiffness * middle - self.damping * middle_rate)[: len(change)]
        new = free
        for _ in range(TURNS):
            new = free - change @ new
        force[: len(change)] += new - free
        new_eta = c[0] * eta + c[1] * rate + (c[2] + c[3]) * force
        rate[:] = c[4] * eta + c[5] * rate + (c[6] + c[7]) * force
        eta[:] = new_eta
        if not np.isfinite(self.modal[:2]).all():
            return -1
        over = int((~(np.abs(found) <= self.limit)).sum())
        fastest = self._fastest[0]
        if (np.abs(x) <= FARTHEST).all() and (np.abs(v) <= fastest).all():
            return over
        eta[:] = self._momentum @ np.clip(_summed(eta, self._shapes), -FARTHEST, FARTHEST)
        rate[:] = self._momentum @ np.clip(_summed(rate, self._shapes), -fastest, fastest)
        return over + 1

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        x: Floats = self.state[1]
        shown = (self.modal[0] - self._hidden)[: self._count]
        x[:] = _summed(shown, self._shapes[: self._count])
        return x


def _summed(amounts: Floats, shapes: Floats) -> Floats:
    """Sum of shapes (m, N) by amounts (m,), (N,), in one order whatever the number of threads."""
    return np.asarray(np.einsum('m,mi->i', amounts, shapes))
