# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `branch` in plain numpy, for machines without a compiler.

It has the state of `BranchOscillators`, in the same arrays, so that stored states are
exchangeable; they agree to rounding. It is the oracle of the kernels as well.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators.numpy_two_axis import two_axis_moment, within_guard
from tree_sway.core.run.branch_oscillators import BranchOscillators, NOT_FINITE
from tree_sway.core.setup.numpy_branch_loads import Bases, into_slots, NumpyPasses, of_slots


class NumpyBranchOscillators(BranchOscillators):
    """`BranchOscillators` in numpy."""

    def __init__(self, *arguments: Any) -> None:
        """Lay out as `BranchOscillators`, and sort by levels."""
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

    def advance_in(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `BranchOscillators.advance_in`."""
        passes = self._passes
        n = len(self.branches)
        x = self.x.reshape(-1, 2)
        v = self.v.reshape(-1, 2)
        load = of_slots(self.loads['load'], n)
        impulse = of_slots(self.loads['drag_impulse'], n).copy()
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
            return NOT_FINITE
        return int(clamped.sum())
