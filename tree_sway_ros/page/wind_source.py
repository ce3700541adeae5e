# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind of a live tree without ROS: simulated, or a record that is played over and over."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.wind.simulated.anemometer import AnemometerModel

_RATE = 20.0


class WindSource(Protocol):
    """Wind as a function of time."""

    def mean(self, start: float, end: float) -> Floats:
        """Mean wind over a step [s], blowing to, in [m/s], (3,)."""


class SimulatedWind:
    """
    Turbulent wind whose mean can be changed while it blows; the gusts keep their pattern.

    Parameters
    ----------
    speed
        Mean in [m/s].
    intensity
        Standard deviation along the wind over the mean.
    bearing_to
        Where it blows to, clockwise from north in [rad].
    seed
        Of the turbulence.

    """

    def __init__(
        self,
        speed: float = 6.0,
        intensity: float = 0.2,
        bearing_to: float = 0.5 * math.pi,
        seed: int = 0,
    ) -> None:
        self.values = {'mean_speed': speed, 'intensity': intensity, 'bearing_to': bearing_to}
        self._seed = seed
        self._model = self._made()

    def set(self, name: str, value: float) -> None:  # noqa: A003
        """Change ``mean_speed`` [m/s], ``intensity`` or ``bearing_to`` [rad]."""
        self.values[name] = value
        self._model = self._made()

    def mean(self, start: float, end: float) -> Floats:
        """Wind half way through a step, on straight lines between samples."""
        at = 0.5 * (start + end) * _RATE
        tick = max(math.floor(at), 0)
        model, share = self._model, min(max(at - tick, 0.0), 1.0)
        return np.asarray((1.0 - share) * model.sample(tick) + share * model.sample(tick + 1))

    def _made(self) -> AnemometerModel:
        values = self.values
        return AnemometerModel(
            values['mean_speed'],
            bearing_to=values['bearing_to'],
            intensity=values['intensity'],
            rate=_RATE,
            seed=self._seed,
        )


class RecordedWind:
    """
    A record, again from its beginning after its end.

    Parameters
    ----------
    time
        Of each sample in [s], increasing, (n,).
    velocity
        Blowing to, in [m/s], (n, 3).

    """

    def __init__(self, time: Floats, velocity: Floats) -> None:
        self._time, self._velocity = time - time[0], velocity
        self._length = max(float(self._time[-1]), 1e-6)

    def mean(self, start: float, end: float) -> Floats:
        """Wind half way through a step, on straight lines between samples."""
        at = (0.5 * (start + end)) % self._length
        return np.array([np.interp(at, self._time, column) for column in self._velocity.T])
