# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Step of a limp tree: one whose twigs turn so far that neither load nor inertia is that of a table.

Its coordinates are those of the model with a table. Their load is found branch by branch
(`setup.branch_loads`), and their inertia and weight at the pose (`pose_inertia`):

    M(q) q'' + C q' + K q = F(wind, q, q') - centrifugal force + weight beyond the linear.

`coupled_step` solves it. **The table takes over** in storms, in long steps, of trees of which
coordinates are hidden, and for a second after a step that would have turned a branch too far: its
step is stable in any wind. Trees of a stand are stepped by the table too.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.model.drag_law import DragLaw, pressure
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.coupled_step import CoupledStep
from tree_sway.core.run.middles import Middles
from tree_sway.core.run.modal_coordinates import FARTHEST
from tree_sway.core.run.numpy_table import NumpyTableBank
from tree_sway.core.run.pose_inertia import PoseInertia
from tree_sway.core.run.table_model import STATE_FIELDS, WindBasisBank
from tree_sway.core.setup.tree_motion import centre_motion

STRONG = 20.0, 25.0
"""
Winds [m/s] between which the step goes over to that of the table: in storms twigs stream along the
wind, and loads found branch by branch rattle.
"""

LONGEST_STEP, MOST_TURN = 0.04, 1.0
"""Longest step [s] at the pose, and the largest rotation of a branch in it [rad]."""

PAUSE = 1.0
"""Time [s] that the table steps after a step that would have turned a branch too far."""

SLACK = 0.05
"""
Share of the energy that the tree may gain of what it has lost: that of a motion without damping
rises and falls by the error of a step.
"""


class LimpStep(WindBasisBank):
    """What a limp tree does in place of the step of a table; a base of a bank."""

    def begin(self, model: SwayModel, bank: Bank) -> None:
        """Prepare the law of a model, by a bank that places it."""
        mass = model.segment_mass
        down = np.multiply.outer(np.sqrt(mass), [0.0, 0.0, -model.settings.gravity]).ravel()
        self._middles = Middles(bank, mass, model.tree.length)
        self.pose = PoseInertia(self._middles, model.shapes, down, model.weight_slopes)
        self._here, self._room = np.zeros((2, len(down)))
        self._by_key = np.ascontiguousarray(model.shapes)
        self._by_coordinate = np.ascontiguousarray(model.shapes.T)
        moved = centre_motion(self.branches, model.shapes).reshape(-1, model.n_coordinates)
        drag = np.repeat(2.0 * self.branches['area'] * self.branches['speed'], 3)
        self._drag = moved.T @ (drag[:, None] * moved)
        """Damping of the coordinates by still air, per drag and speed, (m, m)."""
        self._law: CoupledStep | None = None
        self._stiffness, self._last = np.zeros(0), (np.zeros(0), np.zeros(0))
        self._begin_anew()

    def _begin_anew(self) -> None:
        self._pause, self._is_fresh = 0.0, True
        self._forget()

    def _forget(self) -> None:
        """Bound the energy from the next step on: something else than the wind has changed it."""
        self._allowed = math.inf

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        super().set_step(dt)
        if not np.array_equal(self.modal.stiffness, self._stiffness):
            self._stiffness = self.modal.stiffness.copy()
            self._forget()
        half = self.time_step[0]['half'][:, : len(self._stiffness)]
        self._law = CoupledStep(self.modal, half, len(self.pose.change), dt)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `WindBasisBank.advance`."""
        return self.step_outside() if self._step_once(wx, wy, wz, per_speed_squared) else 0

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
        self._begin_anew()

    def _step_in_wind(
        self, stored: Floats, max_wind: float, law: DragLaw, x: float, y: float, z: float
    ) -> int:
        """Check a wind [m/s] and step, as `table_model.step_in_wind`."""
        is_refused = not math.sqrt(x * x + y * y + z * z) <= max_wind
        if not is_refused:
            stored[:] = x, y, z
        wx, wy, wz = stored.tolist()
        load = pressure(math.sqrt(wx * wx + wy * wy + wz * wz), *law)
        return int(is_refused) + 2 * self._step_once(wx, wy, wz, load)

    def _step_once(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Step; returns 1 where the table's step was clamped to its limit."""
        instance, law = self.instance[0], self._law
        share = self._share_of_table(math.sqrt(wx * wx + wy * wy + wz * wz))
        if share == 1.0 or law is None:
            self._is_fresh = False
            return int(self._step(wx, wy, wz, per_speed_squared))
        state = [instance[name][: len(self._stiffness)] for name in STATE_FIELDS[:3]]
        if not all(map(np.array_equal, state[:2], self._last)):
            self._is_fresh = False
        if not self._is_fresh:
            self._forget()
        at_pose = self._step_at_pose(law, np.array([wx, wy, wz]), per_speed_squared)
        if at_pose is None:
            self._pause, share = PAUSE, 1.0
        outside = 0
        if share > 0.0:
            outside = int(self._step(wx, wy, wz, per_speed_squared))
            self._forget()
        else:
            instance['wind'], instance['pressure'] = (wx, wy, wz), per_speed_squared
            instance['outside'], instance['diagonal'] = 0, 0.0
        if at_pose is not None:
            for now, own in zip(state, at_pose, strict=True):
                now[:] = own + share * (now - own)
        self._last = state[0].copy(), state[1].copy()
        return outside

    def _share_of_table(self, speed: float) -> float:
        """Weight of the table's step in a wind [m/s], 0 to 1."""
        if self.instance['left_out'][0] or self._law is None or self._law.length > LONGEST_STEP:
            return 1.0
        self._pause = max(0.0, self._pause - self._law.length)
        by_wind = (speed - STRONG[0]) / (STRONG[1] - STRONG[0])
        return min(max(by_wind, self._pause / PAUSE, 0.0), 1.0)

    def _step_at_pose(
        self, law: CoupledStep, wind: Floats, per_speed_squared: float
    ) -> tuple[Floats, Floats, Floats] | None:
        """
        Find coordinates, rates and force after a step with the inertia and the loads of the pose.

        None where the step gives more energy than any wind does, or turns a branch too far.
        """
        instance, m, pose = self.instance[0], len(self._stiffness), self.pose
        eta, force = instance['eta'][:m], instance['force'][:m]
        rate = instance['rate'][:m].copy()
        before = self._energy(eta, rate)
        middle, middle_rate = law.middle(eta, rate, force)
        rotations, rotation_rates = self._by_key @ middle, self._by_key @ middle_rate
        here = self._middles.fill(rotations, self._here)
        turned = law.length * _largest(rotation_rates)
        pose.renew(middle, rotations, here, rate, turned if self._is_fresh else math.inf)
        self._is_fresh = True

        moments = self._wind_moments(rotations, rotation_rates, wind)
        by_wind = per_speed_squared * (self._by_coordinate @ moments)
        wanted = instance['wanted'][:m]
        wanted[:] = by_wind
        wanted[: len(pose.change)] += pose.weight
        across = pose.centrifugal(rotations, here, middle_rate, rotation_rates)
        drag = per_speed_squared * math.sqrt(float(wind @ wind)) * self._drag
        found = law.force(wanted, eta, rate, force, pose.change, drag, across)
        moved, faster = law.end(eta, rate, found)

        bent = self._by_key @ moved
        most = max(before, float(self.record[0]['most_energy']))
        is_possible = (
            self._energy(moved, faster) <= most
            and law.length * _largest(self._by_key @ faster) <= MOST_TURN
            and _largest(bent) <= FARTHEST
        )
        if not is_possible:
            return None
        self._bound(moved, faster, bent, float(by_wind @ (moved - eta)))
        return moved, faster, found

    def _bound(self, eta: Floats, rate: Floats, rotations: Floats, work: float) -> None:
        """
        Scale the rates after a step so that it gains no more energy than the work of the wind [J].

        Coordinates and rates are (m,), key rotations (N,). What the tree has lost before it may
        gain again, up to `SLACK`.
        """
        here = self._middles.fill(rotations, self._room)
        moving = 0.5 * self._energy(eta, rate)
        energy = moving + self.pose.potential(eta, here)
        allowed = self._allowed + work
        if energy > allowed:
            kinetic = 0.5 * self.pose.twice_kinetic_energy(rate)
            left = max(kinetic - (energy - allowed), 0.0)
            rate *= math.sqrt(left / kinetic) if kinetic > 0.0 else 0.0
            energy += left - kinetic
        self._allowed = min(allowed, energy + SLACK * moving)

    def _energy(self, eta: Floats, rate: Floats) -> float:
        """Twice the strain and kinetic energy [J]."""
        return float(self.modal.stiffness @ (eta * eta)) + self.pose.twice_kinetic_energy(rate)


class LimpBank(LimpStep, WindBasisBank):
    """A limp tree whose branches are loaded and placed by kernels."""


class NumpyLimpBank(LimpStep, NumpyTableBank):
    """A limp tree in numpy."""


def _largest(values: Floats) -> float:
    return float(np.abs(values).max(initial=0.0))
