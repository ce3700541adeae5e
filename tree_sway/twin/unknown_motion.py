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

_STEADY = 0.5
"""Mean of the wind over its mean speed above which it has a direction."""

COMPARED = 120.0
"""Time in [s] over which the power of the forces is compared with the usual one."""

_SLOWEST_WIND = 0.4
"""
Least mean wind in [m/s] for which a law is found: by that of a stronger wind, a tree in a calm
follows the noise of its sensors.
"""

_OTHER_WIND, _SAME_WAY = 1.6, 0.85
"""
Ratio of mean winds from which another law is found, and the cosine between them below which it is.
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
        self._simulator, self.dt, self.count = simulator, dt, count
        self.frequency = float(simulator.frequencies(1)[0])
        """First frequency of the model [Hz]."""
        self._steps = 0
        self.mean_speed = 0.0
        """Mean speed of the wind in [m/s]."""
        self._east = self._north = self._fourth = 0.0
        self._found_for = 0.0
        self._way = 0.0, 0.0
        self.forces: Disturbance | None = None
        """What the wind does not tell, in the wind of the last law; None before any."""
        self._law: SwayLaw | None = None
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
        self.all_damping = tunable.of_wood / tunable.inertia
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

    def note_wind(self, east: float, north: float, up: float = 0.0) -> None:
        """Follow the mean wind [m/s]."""
        self._steps += 1
        recent, longer = (
            max(self.dt / each, 1.0 / self._steps) for each in (_RECENT, 0.5 * COMPARED)
        )
        speed = math.sqrt(east * east + north * north + up * up)
        self.mean_speed += recent * (speed - self.mean_speed)
        self._fourth += longer * (self.mean_speed**4 - self._fourth)
        self._east += recent * (east - self._east)
        self._north += recent * (north - self._north)

    @property
    def is_outdated(self) -> bool:
        """Whether the law was found for another wind, or for another tree."""
        speed = max(self.mean_speed, _SLOWEST_WIND)
        size = math.hypot(self._east, self._north)
        along = self._east * self._way[0] + self._north * self._way[1]
        if self._is_steady and along < _SAME_WAY * size:
            return True
        return not 1.0 / _OTHER_WIND < speed / max(self._found_for, 1e-9) < _OTHER_WIND

    @property
    def _is_steady(self) -> bool:
        """Whether the wind keeps to one direction."""
        return math.hypot(self._east, self._north) > _STEADY * self.mean_speed

    @property
    def usual_before(self) -> float:
        """Power of the forces in the wind of `COMPARED` over that in the wind of the law."""
        return max(self._fourth, _SLOWEST_WIND**4) / self._found_for**4

    def find(self) -> tuple[SwayLaw, SwayLaw]:
        """Find the law in the present wind, and what it were if each limb had gusts of its own."""
        speed = max(self.mean_speed, _SLOWEST_WIND)
        self._found_for, n = speed, self.count
        heading = None
        if self._is_steady:
            heading = math.atan2(self._north, self._east)
            self._way = math.cos(heading), math.sin(heading)
        found = self.forces = disturbance(self._simulator, speed, n, heading)
        self._found_with = (self.all_stiffness, self.all_damping)
        self.air_damping[:] = found.air_damping
        self.damped = self.all_damping[:n] + found.air_damping
        self._law, apart = (
            sway_law(self.stiffness, self.damped, each, found.time_constant, self.dt)
            for each in (found.covariance, found.apart)
        )
        self._variance = None
        return self._law, apart

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
