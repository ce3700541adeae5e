# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Dynamics of the motion beyond that of the model, in the present wind."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.twin.disturbance import Disturbance, disturbance
from tree_sway.twin.steady_filter import stationary_covariance, sway_law, SwayLaw

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

_RECENT = 30.0
"""Time constant of the mean wind in [s]."""

_SLOWEST_WIND = 0.5
"""
Least mean wind in [m/s] for which a law is found: by that of a stronger wind, a tree in a calm
follows the noise of its sensors.
"""

_OTHER_WIND = 1.6
"""Ratio of mean winds from which another law is found."""

_OTHER_SIZE, _SIZES = 1.5, (0.2, 1.5)
"""
Ratio of sizes from which another law is found, and the least and the largest one: with a larger
one a tree in a calm after gusts follows the noise of its sensors.
"""

_STIFFER, _MORE_DAMPED = 0.03, 0.2
"""Changes of the logarithms of stiffness and damping from which another law is found."""


class UnknownMotion:
    """
    The law of what is unknown on the first coordinates of a model.

    Parameters
    ----------
    simulator
        The model.
    count
        Number of coordinates.
    dt
        Time step in [s].

    """

    def __init__(self, simulator: SwaySimulator, count: int, dt: float) -> None:
        self._simulator, self._dt, self.count = simulator, dt, count
        self._steps = 0
        self.mean_speed = 0.0
        """Mean speed of the wind in [m/s]."""
        self._found_for, self._found_size = 0.0, 1.0
        self.size = 1.0
        """Variance of the unknown forces over that of usual gusts [-]."""
        self.forces: Disturbance | None = None
        """What the wind does not tell, in the wind of the last law; None before any."""
        self._law: SwayLaw | None = None
        self.apart: SwayLaw | None = None
        """The last law, had each limb gusts of its own; None before any."""
        self._variance: Floats | None = None
        self.air_damping = np.zeros(count)
        """Damping of each by the mean wind [1/s], (count,)."""
        self.read_model()
        self._found_with = (0.0 * self.all_stiffness, 0.0 * self.all_damping)
        self.damped = np.zeros(count)
        """Damping of each by wood and air [1/s], (count,)."""

    def read_model(self) -> None:
        """Read stiffness and damping of the model."""
        tunable = self._simulator.banks[0].oscillators.tunable
        self.all_stiffness = np.array(tunable.stiffness) / tunable.inertia
        """Stiffness of every coordinate of the model [1/s^2], (m,)."""
        self.all_damping = np.array(tunable.damping) / tunable.inertia
        """Damping of every coordinate of the model by its wood [1/s], (m,)."""
        self.stiffness = self.all_stiffness[: self.count].copy()
        """Stiffness of each [1/s^2], (count,)."""

    def forget_changed_model(self) -> None:
        """Find another law where the model has changed since the last one."""
        stiffness, damping = self._found_with
        if stiffness.all() and damping.all():
            stiffer = np.abs(np.log(self.all_stiffness / stiffness)).max()
            more_damped = np.abs(np.log(self.all_damping / damping)).max()
            if stiffer <= _STIFFER and more_damped <= _MORE_DAMPED:
                return
        self._found_for = 0.0

    def note_wind(self, speed: float) -> None:
        """Follow the mean speed of the wind [m/s]."""
        self._steps += 1
        share = self._dt / _RECENT
        if self._steps * self._dt < _RECENT:
            share = 1.0 / self._steps
        self.mean_speed += share * (speed - self.mean_speed)

    @property
    def is_outdated(self) -> bool:
        """Whether the law was found for another wind, another tree, or forces of other size."""
        speed = max(self.mean_speed, _SLOWEST_WIND)
        if not 1.0 / _OTHER_SIZE < self.size / self._found_size < _OTHER_SIZE:
            return True
        return not 1.0 / _OTHER_WIND < speed / max(self._found_for, 1e-9) < _OTHER_WIND

    def told_size(self, variance: float, felt: Floats) -> float:
        """
        Return the size of the forces by which a sensor differs from the model in this wind.

        Gusts, drag and damping of a real tree are its own: the variance of measurements, a sum, by
        the state, (p, 3 count), was 0.06 to 2 of the expected one on trees that were drawn. Of
        slow gusts, which are the most of the motion, it tells less, hence the root.
        """
        if self._law is None:
            self.find()
        expected = float(np.einsum('ij,jk,ik->', felt, self.variance, felt)) / self._found_size
        return min(max(math.sqrt(variance / max(expected, 1e-300)), _SIZES[0]), _SIZES[1])

    def find(self) -> SwayLaw:
        """Find the law in the present wind."""
        speed = max(self.mean_speed, _SLOWEST_WIND)
        self._found_for, self._found_size, n = speed, self.size, self.count
        found = self.forces = disturbance(self._simulator, speed, n)
        self._found_with = (self.all_stiffness, self.all_damping)
        self.air_damping[:] = found.air_damping
        self.damped = self.all_damping[:n] + found.air_damping
        self._law, self.apart = (
            sway_law(self.stiffness, self.damped, self.size * each, found.time_constant, self._dt)
            for each in (found.covariance, found.apart)
        )
        self._variance = None
        return self._law

    def present_forces(self, *, keeps_old: bool) -> Disturbance:
        """Return the unknown forces, those of an outdated law only if it is to be kept."""
        if self.forces is None or (not keeps_old and self.is_outdated):
            self.find()
        assert self.forces is not None
        return self.forces

    @property
    def variance(self) -> Floats:
        """Covariance of the unknown motion without any sensor, (3 count, 3 count)."""
        if self._variance is None:
            assert self._law is not None
            self._variance = stationary_covariance(self._law)
        return self._variance
