# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A simulated anemometer: mean wind and turbulence, sampled tick by tick without end.

The turbulence is one period of a `Turbulence`, repeated without a step.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.wind import along_bearing, SHORTEST_PERIOD, Turbulence

_SAMPLES = 2**15
"""Smallest number of samples after which the turbulence repeats: 27 minutes at 20 Hz."""


class AnemometerModel:
    """
    Wind at an anemometer, a pure function of its parameters, seed and tick.

    Parameters
    ----------
    mean_speed
        Mean wind speed in [m/s], 0 to 40; a mean of 0 has no turbulence.
    bearing_to
        Direction of the mean wind, clockwise from north in [rad]; the default is a westerly.
    height, intensity
        Height and intensity, as in `Turbulence`.
    rate
        Samples per second in [Hz], 1 to 100.
    seed
        Seed of the turbulence. With the same seed the gusts have the same pattern at any speed or
        intensity, so that a live change causes no further jump.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """

    def __init__(
        self, mean_speed: float = 5.0, *, bearing_to: float = 0.5 * np.pi, height: float = 10.0,
        intensity: float | None = None, rate: float = 20.0, seed: int = 0,
    ) -> None:  # fmt: skip
        """Check the parameters."""
        within('mean_speed', mean_speed, 0.0, 40.0, 'm/s')
        within('rate', rate, 1.0, 100.0, 'Hz')
        self._bearing_to = within('bearing_to', bearing_to, -6.3, 6.3, 'rad')
        self._mean = np.array([mean_speed, 0.0, 0.0])
        self._gusts = np.zeros((1, 3))
        turbulence = Turbulence(mean_speed or 1.0, height, intensity)
        rng = np.random.default_rng(int(within('seed', seed, 0, 2**63)))
        if mean_speed > 0.0:
            n_samples = max(_SAMPLES, round(SHORTEST_PERIOD * rate))
            self._gusts = turbulence.record(n_samples, rate, rng)

    def sample(self, tick: int) -> Floats:
        """Wind at a tick of the sample period from 0 on: blowing to, ENU in [m/s], (3,)."""
        within('tick', tick, 0, 2**63)
        wind = self._mean + self._gusts[tick % len(self._gusts)]
        return along_bearing(wind, self._bearing_to)
