# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A step of a limp tree: one whose twigs turn so far that neither its load nor its inertia is a table.

The coordinates are those of the table's model. Their load is found branch by branch
(`setup.branch_loads`), and their inertia at the pose (`pose_inertia`):

    M(q) q'' + C q' + K q = F(wind, q, q') - centrifugal force + weight beyond the linear.

Each coordinate still moves as an oscillator of its own, exactly, under a force f that is constant
over the step (`ModalCoordinates`). What M has beyond that at rest, 1, is a part of f, by the mean
acceleration over the step:

    f = F - (M - 1) (v1 - v0) / h / T,   v1 = v1(q0, v0, f),   T = tan(w h / 2) / (w h / 2),

which is linear in f. As ``q1 - q0 = h T (v0 + v1) / 2`` for a coordinate of the circular frequency
w, this f does exactly the work that ``v' (M - 1) v / 2`` loses: of a constant M no step of any
length makes energy. The drag is implicit: F is reduced by the damping B of still branches times
what the rate at the middle of the step differs from its prediction.

Coordinates that swing once in less than some two steps keep their inertia at rest. Trees of a
stand, and those of which coordinates are hidden, are stepped by the table.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import math
from typing import Any, NamedTuple, TYPE_CHECKING

import numpy as np
from scipy.linalg import get_lapack_funcs

from tree_sway.core.arrays import Floats
from tree_sway.core.model.drag_law import DragLaw, pressure
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.middles import Middles
from tree_sway.core.run.numpy_table import NumpyTableBank
from tree_sway.core.run.pose_inertia import LEADING, PoseInertia
from tree_sway.core.run.table_model import WindBasisBank
from tree_sway.core.setup.tree_motion import centre_motion

_FASTEST = 2.5
"""Largest angle [rad] that a coordinate swings by in a step with the inertia of the pose."""

(_solve,) = get_lapack_funcs(('posv',), dtype=np.float64)


class StepLaw(NamedTuple):
    """Coefficients of a step of h [s], from those of the oscillators."""

    h: float
    half: Floats
    """Displacement and rate at the middle by displacement, rate and force, (6, m)."""
    whole: Floats
    """The same after the step, (6, m)."""
    coupled: Any
    """Leading coordinates whose inertia is that of the pose."""
    stretch: Floats
    """T of these coordinates."""
    own: Floats
    """Force of each of these per acceleration that it makes, times T."""


class LimpStep(WindBasisBank):
    """What limp trees do in place of the step of a table; a base of a bank."""

    def begin(self, model: SwayModel, bank: Bank) -> None:
        """Prepare the law of a model, by a bank that places it."""
        m, gravity = model.n_coordinates, model.settings.gravity
        mass, shapes = model.segment_mass, model.shapes[:, :LEADING]
        down = np.repeat(np.sqrt(mass), 3) * np.tile([0.0, 0.0, -gravity], len(mass))
        slopes = model.weight_slopes[: shapes.shape[1]]
        self._middles = Middles(bank, model.segment_mass, model.tree.length)
        self.pose = PoseInertia(self._middles, shapes, down, slopes)
        self._here = np.zeros(3 * len(mass))
        self._shapes = np.ascontiguousarray(model.shapes)
        self._by_coordinate = np.ascontiguousarray(model.shapes.T)
        moved = centre_motion(self.branches, model.shapes).reshape(-1, m)
        drag = np.repeat(2.0 * self.branches['area'] * self.branches['speed'], 3)
        self._drag = moved.T @ (drag[:, None] * moved)
        self._law: StepLaw | None = None

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        super().set_step(dt)
        m = self.modal.shapes.shape[1]
        half = self.time_step[0]['half'][:, :m].copy()
        whole = self.modal.whole.T[[0, 1, 2, 4, 5, 6]]
        whole[[2, 5]] += self.modal.whole.T[[3, 7]]
        angle = np.sqrt(self.modal.stiffness[: len(self.pose.change)]) * dt
        coupled: Any = np.flatnonzero(angle < _FASTEST)
        stretch = np.tan(0.5 * angle[coupled]) / np.maximum(0.5 * angle[coupled], 1e-300)
        if len(coupled) == len(angle):
            coupled = slice(0, len(angle))
        own = stretch * dt / whole[5][: len(angle)][coupled]
        self._law = StepLaw(dt, half, whole, coupled, stretch, own)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `WindBasisBank.advance`."""
        return self.step_outside() if self._limp_step(wx, wy, wz, per_speed_squared) else 0

    def stepping(
        self, wind: Floats, max_wind: float, law: DragLaw
    ) -> Callable[[float, float, float], int]:
        """Return a step as one call, as `WindBasisBank.stepping`."""
        return partial(self._step_in_wind, wind, max_wind, law)

    def reset(self) -> None:
        """Return to rest."""
        super().reset()
        self.pose.reset()
        self._wind_moments.reset()

    def _step_in_wind(
        self, stored: Floats, max_wind: float, law: DragLaw, x: float, y: float, z: float
    ) -> int:
        """Check a wind [m/s] and step, as `table_model.step_in_wind`."""
        is_refused = not math.sqrt(x * x + y * y + z * z) <= max_wind
        if not is_refused:
            stored[:] = x, y, z
        wx, wy, wz = stored.tolist()
        load = pressure(math.sqrt(wx * wx + wy * wy + wz * wz), *law)
        return int(is_refused) + 2 * self._limp_step(wx, wy, wz, load)

    def _limp_step(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Step; returns 1 where wind or motion were clamped to the limit of the table."""
        instance, law = self.instance[0], self._law
        if instance['left_out'] or law is None:
            return int(self._step(wx, wy, wz, per_speed_squared))
        m = len(law.half[0])
        eta, rate, force = (instance[name][:m] for name in ('eta', 'rate', 'force'))
        instance['wind'], instance['pressure'] = (wx, wy, wz), per_speed_squared
        speed = math.sqrt(wx * wx + wy * wy + wz * wz)
        most = float(self.record[0]['most_pressure'])
        is_outside = per_speed_squared * speed * speed > most
        if is_outside:
            per_speed_squared = most / (speed * speed)
        energy_before = self._energy(eta, rate)

        half, whole = law.half, law.whole
        middle = half[0] * eta + half[1] * rate + half[2] * force
        middle_rate = half[3] * eta + half[4] * rate + half[5] * force
        rotations, rotation_rates = self._shapes @ middle, self._shapes @ middle_rate
        here = self._middles.fill(rotations, self._here)
        fastest = float(np.abs(rotation_rates).max(initial=0.0))
        self.pose.renew(middle, rotations, here, rate, fastest * law.h)
        moments = self._wind_moments(rotations, rotation_rates, np.array([wx, wy, wz]))
        wanted = per_speed_squared * (self._by_coordinate @ moments)
        n = len(self.pose.change)
        wanted[:n] += self.pose.weight
        wanted[:n] -= self.pose.centrifugal(rotations, here, middle_rate, rotation_rates)

        self._find_force(law, wanted, per_speed_squared * speed)
        eta_now = eta.copy()
        eta[:] = whole[0] * eta_now + whole[1] * rate + whole[2] * force
        rate[:] = whole[3] * eta_now + whole[4] * rate + whole[5] * force
        energy = self._energy(eta, rate)
        most = max(energy_before, float(self.record[0]['most_energy']))
        if not energy <= most:
            share = math.sqrt(most / energy) if energy < math.inf else math.nan
            eta *= share
            rate *= share
            is_outside = True
        instance['outside'] = is_outside
        instance['wanted'][:m] = wanted
        return int(is_outside)

    def _find_force(self, law: StepLaw, wanted: Floats, drag: float) -> None:
        """Find the constant force of a step, with inertia and damping implicit."""
        instance, m = self.instance[0], len(wanted)
        eta, rate, force = (instance[name][:m] for name in ('eta', 'rate', 'force'))
        own_drag = 0.5 * drag * np.diagonal(self._drag) * law.whole[5]
        found = (wanted + own_drag * force) / (1.0 + own_drag)
        c = law.coupled
        n = len(self.pose.change)
        inertia, damping = self.pose.change, (0.5 * drag * law.h) * self._drag[:n, :n]
        if not isinstance(c, slice):
            inertia, damping = inertia[np.ix_(c, c)], damping[np.ix_(c, c)]
        gain = law.whole[5][:n][c] / law.h
        before = gain * force[:n][c]
        free = (law.whole[3] * eta + (law.whole[4] - 1.0) * rate)[:n][c] / law.h
        right = law.stretch * wanted[:n][c] - inertia @ free + damping @ before
        matrix = inertia + damping
        matrix.flat[:: len(matrix) + 1] += law.own
        _, accelerations, failed = _solve(matrix, right, lower=1, overwrite_a=1)
        if not failed:
            found[:n][c] = accelerations / gain
        force[:] = found

    def _energy(self, eta: Floats, rate: Floats) -> float:
        """Twice the strain and kinetic energy [J]."""
        return float(self.modal.stiffness @ (eta * eta)) + self.pose.kinetic_energy(rate)


class LimpBank(LimpStep, WindBasisBank):
    """A limp tree whose branches are loaded and placed by kernels."""


class NumpyLimpBank(LimpStep, NumpyTableBank):
    """A limp tree in numpy."""
