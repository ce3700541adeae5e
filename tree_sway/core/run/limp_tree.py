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
from tree_sway.core.run.modal_coordinates import FARTHEST
from tree_sway.core.run.numpy_table import NumpyTableBank
from tree_sway.core.run.pose_inertia import PoseInertia
from tree_sway.core.run.table_model import STATE_FIELDS, WindBasisBank
from tree_sway.core.setup.tree_motion import centre_motion

_FASTEST = 2.5
"""Largest angle [rad] that a coordinate swings by in a step with the inertia of the pose."""

STRONG = 20.0, 25.0
"""
Winds [m/s] between which the step goes over from that of the pose to that of the table: in storms
twigs stream along the wind, where loads branch by branch rattle.
"""

LONGEST_STEP, MOST_TURN = 0.04, 1.0
"""
Longest step [s] with the inertia of the pose, and the largest rotation of a branch in one [rad].
After a step that would turn further, the table takes over for a second.
"""

_SLACK = 0.02

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
        mass = model.segment_mass
        down = np.repeat(np.sqrt(mass), 3) * np.tile([0.0, 0.0, -gravity], len(mass))
        self._middles = Middles(bank, model.segment_mass, model.tree.length)
        self.pose = PoseInertia(self._middles, model.shapes, down, model.weight_slopes)
        self._here, self._room = np.zeros((2, 3 * len(mass)))
        self._shapes = np.ascontiguousarray(model.shapes)
        self._by_coordinate = np.ascontiguousarray(model.shapes.T)
        moved = centre_motion(self.branches, model.shapes).reshape(-1, m)
        drag = np.repeat(2.0 * self.branches['area'] * self.branches['speed'], 3)
        self._drag = moved.T @ (drag[:, None] * moved)
        self._law: StepLaw | None = None
        self._last_rate, self._last_stiffness = np.zeros(0), np.zeros(0)
        self._doubt, self._is_fresh = 0.0, True
        self._forget()

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        super().set_step(dt)
        if not np.array_equal(self.modal.stiffness, self._last_stiffness):
            self._last_stiffness = self.modal.stiffness.copy()
            self._forget()
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
        self._doubt, self._is_fresh = 0.0, True
        self._forget()
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

    def _forget(self) -> None:
        """Bound the energy from the next step on: the tree was pushed, tuned or begun anew."""
        self._allowed = math.inf

    def _limp_step(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Step; returns 1 where wind or motion were clamped to the limit of the table."""
        instance, law = self.instance[0], self._law
        share = self._share_of_table(math.sqrt(wx * wx + wy * wy + wz * wz))
        if share == 1.0 or law is None:
            self._is_fresh = False
            self._forget()
            return int(self._step(wx, wy, wz, per_speed_squared))
        m = len(law.half[0])
        state = [instance[name][:m] for name in STATE_FIELDS[:3]]
        if not np.array_equal(state[1], self._last_rate):
            self._forget()
        at_pose = self._step_at_pose(law, np.array([wx, wy, wz]), per_speed_squared)
        if at_pose is None:
            self._doubt, share = 1.0, 1.0
        outside = 0
        if share > 0.0:
            outside = int(self._step(wx, wy, wz, per_speed_squared))
        else:
            instance['wind'], instance['pressure'] = (wx, wy, wz), per_speed_squared
            instance['outside'], instance['diagonal'] = 0, 0.0
        if at_pose is not None:
            for now, own in zip(state, at_pose, strict=True):
                now[:] = own + share * (now - own)
        if share > 0.0:
            self._forget()
        self._last_rate = state[1].copy()
        return outside

    def _share_of_table(self, speed: float) -> float:
        """Weight of the table's step in a wind [m/s], 0 to 1."""
        if self.instance['left_out'][0] or self._law is None or self._law.h > LONGEST_STEP:
            return 1.0
        self._doubt = max(0.0, self._doubt - self._law.h)
        return min(max((speed - STRONG[0]) / (STRONG[1] - STRONG[0]), self._doubt, 0.0), 1.0)

    def _step_at_pose(
        self, law: StepLaw, wind: Floats, per_speed_squared: float
    ) -> tuple[Floats, Floats, Floats] | None:
        """
        Find coordinates, rates and force after a step with the inertia and the loads of the pose.

        None where the step adds more energy than any wind, or turns a branch too far.
        """
        instance, m = self.instance[0], len(law.half[0])
        eta, force = instance['eta'][:m], instance['force'][:m]
        rate = instance['rate'][:m].copy()
        half, whole = law.half, law.whole
        before = self._energy(eta, rate)
        middle = half[0] * eta + half[1] * rate + half[2] * force
        middle_rate = half[3] * eta + half[4] * rate + half[5] * force
        rotations, rotation_rates = self._shapes @ middle, self._shapes @ middle_rate
        here = self._middles.fill(rotations, self._here)
        turned = law.h * float(np.abs(rotation_rates).max(initial=0.0))
        self.pose.renew(middle, rotations, here, rate, turned if self._is_fresh else math.inf)
        self._is_fresh = True
        moments = self._wind_moments(rotations, rotation_rates, wind)
        by_wind = per_speed_squared * (self._by_coordinate @ moments)
        wanted = by_wind.copy()
        n = len(self.pose.change)
        wanted[:n] += self.pose.weight
        wanted[:n] -= self.pose.centrifugal(rotations, here, middle_rate, rotation_rates)
        instance['wanted'][:m] = wanted
        speed = math.sqrt(float(wind @ wind))
        found = self._constant_force(law, wanted, eta, rate, per_speed_squared * speed)
        moved = whole[0] * eta + whole[1] * rate + whole[2] * found
        faster = whole[3] * eta + whole[4] * rate + whole[5] * found
        energy = self._energy(moved, faster)
        turned = law.h * float(np.abs(self._shapes @ faster).max(initial=0.0))
        bent = self._shapes @ moved
        most = max(before, float(self.record[0]['most_energy']))
        if not (energy <= most and turned <= MOST_TURN and np.abs(bent).max() <= FARTHEST):
            return None
        self._bound(moved, faster, bent, float(by_wind @ (moved - eta)))
        return moved, faster, found

    def _bound(self, eta: Floats, rate: Floats, rotations: Floats, work: float) -> None:
        """
        Scale rates so that a step of the wind's work [J] has not made more energy than that.

        What the steps before have lost may be made again, up to a share `_SLACK` of the energy:
        the energy of a motion that is exact but for rounding rises and falls by the step's error.
        """
        pose = self.pose
        here = self._middles.fill(rotations, self._room)
        total = 0.5 * self._energy(eta, rate)
        energy = total + pose.potential(eta, here)
        allowed = self._allowed + work
        if energy > allowed:
            kinetic = 0.5 * pose.kinetic_energy(rate)
            left = max(kinetic - (energy - allowed), 0.0)
            rate *= math.sqrt(left / kinetic) if kinetic > 0.0 else 0.0
            energy += left - kinetic
        self._allowed = min(allowed, energy + _SLACK * total)

    def _constant_force(
        self, law: StepLaw, wanted: Floats, eta: Floats, rate: Floats, drag: float
    ) -> Floats:
        """Find the force of a step, (m,), with inertia and damping implicit."""
        force = self.instance[0]['force'][: len(wanted)]
        own_drag = 0.5 * drag * np.diagonal(self._drag) * law.whole[5]
        found = (wanted + own_drag * force) / (1.0 + own_drag)
        c, n = law.coupled, len(self.pose.change)
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
        return np.asarray(found)

    def _energy(self, eta: Floats, rate: Floats) -> float:
        """Twice the strain and kinetic energy [J]."""
        return float(self.modal.stiffness @ (eta * eta)) + self.pose.kinetic_energy(rate)


class LimpBank(LimpStep, WindBasisBank):
    """A limp tree whose branches are loaded and placed by kernels."""


class NumpyLimpBank(LimpStep, NumpyTableBank):
    """A limp tree in numpy."""
