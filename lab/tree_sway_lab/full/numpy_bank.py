# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full` in plain numpy, for machines without a compiler: some 100 times slower.

It has the state of `FullBank`, in the same arrays, so that stored states are exchangeable; they
agree to rounding. It is the oracle of the kernels as well.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators.two_axis import LOAD_MAX
from tree_sway.core.run.modal_coordinates import FARTHEST
from tree_sway.core.setup.bent_inertia import inertia_change
from tree_sway.core.setup.numpy_branch_loads import into_slots, NumpyPasses, of_slots
from tree_sway_lab.full.bank import FullBank, MOST_TRIALS, MOST_TURN, SOLVED, TURNS


class NumpyFullBank(FullBank):
    """`FullBank` in numpy."""

    def __init__(self, *arguments: Any) -> None:
        """Lay out as `FullBank`, and sort by levels."""
        super().__init__(*arguments)
        self._passes = NumpyPasses(self.branches)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `FullBank.advance`."""
        passes, n_branches = self._passes, len(self.branches)
        eta, rate, force = self.modal[:3]
        moment, n = self.state[0], self.state.shape[1]
        found = np.empty(n)
        h, c = self.half.T, self.whole.T
        impulse = of_slots(self.loads['drag_impulse'], n_branches).copy()
        wind = np.array([wx, wy, wz]) + of_slots(self.loads['gust'], n_branches)
        compliance = of_slots(self.loads['compliance'], n_branches)
        trials: list[tuple[Floats, Floats]] = []
        for trial in range(MOST_TRIALS):
            middle = h[0] * eta + h[1] * rate + (h[2] + h[3]) * force
            middle_rate = h[4] * eta + h[5] * rate + (h[6] + h[7]) * force
            x, v = _summed(middle, self.by_coordinate), _summed(middle_rate, self.by_coordinate)
            angles, rates = passes.per_branch(x), passes.per_branch(v)
            bases = passes.outward(angles, rates)
            tried = impulse.copy()
            on_branches = passes.wind_forces(
                bases, angles, rates, wind, per_speed_squared, compliance, impulse
            )
            self.work['force'] = passes.bent_loads(bases, angles, on_branches, found)
            turning = LOAD_MAX * (found - moment) / self.limit
            if np.abs(turning).max() <= (SOLVED if trial else 1.0) * self._enough[0]:
                moment[:] = found
                break
            if trial == MOST_TRIALS - 1:
                break
            residual = np.concatenate([turning, (impulse - tried).ravel()])
            change = _next_change(trials, residual, n)
            trials.append((residual, change))
            moment += change[:n] * self.limit / LOAD_MAX
            np.clip(moment, -self.limit, self.limit, out=moment)
            impulse = tried + change[n:].reshape(impulse.shape)
            force[:] = np.einsum('mi,i->m', self.by_coordinate, moment)
        into_slots(impulse, self.loads['drag_impulse'])
        force[:] = np.einsum('mi,i->m', self.by_coordinate, moment)
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
        eta[:] = self.momentum @ np.clip(_summed(eta, self.by_coordinate), -FARTHEST, FARTHEST)
        rate[:] = self.momentum @ np.clip(_summed(rate, self.by_coordinate), -fastest, fastest)
        return over + 1

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        x: Floats = self.state[1]
        x[:] = _summed(self.modal[0], self.by_coordinate)
        return x


def _next_change(trials: list[tuple[Floats, Floats]], residual: Floats, n: int) -> Floats:
    """Find the next change of n moments and the drag impulses, as `bank._try_next`."""
    if trials:
        response, step = residual - trials[-1][0], trials[-1][1]
        for other, by in trials[:-1]:
            share = response[:n] @ other[:n]
            response, step = response - share * other, step - share * by
        scale = 1.0 / max(float(np.linalg.norm(response[:n])), 1e-150)
        trials[-1] = scale * response, scale * step
    left, change = residual, np.zeros_like(residual)
    for other, by in trials:
        share = left[:n] @ other[:n]
        left, change = left - share * other, change - share * by
    change = change + left
    most = float(np.abs(change[:n]).max())
    return np.asarray(change * min(1.0, MOST_TURN / most))


def _summed(amounts: Floats, shapes: Floats) -> Floats:
    """Sum of shapes (m, N) by amounts (m,), (N,), in one order whatever the number of threads."""
    return np.asarray(np.einsum('m,mi->i', amounts, shapes))
