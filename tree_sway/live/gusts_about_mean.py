# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts about the newest mean of a live station, sample by sample.

The laws are those of `about_means`: deviations by the reported gust, or by IEC 61400-1. The
turbulence is one period in units of its deviation, less its own mean over each interval, and is
repeated. A new mean is reached within `PASSING`, so that the wind does not jump.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.wind import FASTEST_WIND, Turbulence
from tree_sway.simulation.wind import usual_deviation, usual_gust

RATE = 10.0
"""Samples per second [Hz]."""
PASSING = 20.0
"""Longest time in which one mean passes into the next [s]."""
_SAMPLES = 2**15
"""Samples of a period: 55 minutes."""
_SLOWEST = 1.0
_FASTEST = 40.0
_NEAR = 1.5
"""Factor of the mean speed from which the turbulence, whose scales follow it, is drawn anew."""


class GustsAboutMean:
    """
    Wind about the newest mean; the same seed gives the same pattern of gusts.

    Parameters
    ----------
    seed
        Seed of the turbulence.

    """

    def __init__(self, seed: int = 0) -> None:
        """Begin without a mean."""
        self._seed = seed
        self._drawn_for = (0.0, 0.0)  # mean speed [m/s] and interval [s] of the turbulence
        self._gusts = np.zeros((1, 3))
        self._largest = 1.0
        self._before = np.zeros(3)
        self._mean = np.zeros(3)
        self._deviation = 0.0
        self._since = -math.inf
        self._passing = PASSING

    def set(  # noqa: A003
        self, time: float, mean: Floats, interval: float, gust: float | None = None
    ) -> None:
        """
        Take a new mean.

        Parameters
        ----------
        time
            Present time in [s].
        mean
            Velocity east, north, up in [m/s], (3,).
        interval
            Length of the mean in [s], above 0.
        gust
            Largest speed in the interval in [m/s], None where it is not reported.

        """
        level = float(np.hypot(mean[0], mean[1]))
        self._draw(min(max(level, _SLOWEST), _FASTEST), interval)
        is_first = self._since == -math.inf
        self._before = np.array(mean) if is_first else self._level(time)
        self._mean = np.array(mean)
        self._since = time
        self._passing = min(interval, PASSING)
        if gust is None:
            self._deviation = float(usual_deviation(np.array(level)))
        else:
            self._deviation = max(gust - level, 0.0) / self._largest

    def sample(self, time: float) -> tuple[float, float, float]:
        """Return the wind at a time in [s], east, north, up in [m/s], the way the air goes."""
        mean = self._level(time)
        along, across, up = self._deviation * self._gusts[int(time * RATE) % len(self._gusts)]
        level = complex(mean[0], mean[1])
        turned = complex(along, across) * (level / abs(level) if level else 1.0)
        wind = mean + np.array((turned.real, turned.imag, up))
        fast = max(float(np.linalg.norm(wind)) / FASTEST_WIND, 1.0)
        x, y, z = (wind / fast).tolist()
        return x, y, z

    def _level(self, time: float) -> Floats:
        """Mean at a time, on the way from the one before to the newest, (3,)."""
        share = min(max((time - self._since) / self._passing, 0.0), 1.0)
        return (1.0 - share) * self._before + share * self._mean

    def _draw(self, speed: float, interval: float) -> None:
        """Draw the turbulence of a mean speed, unless the one there is near enough."""
        drawn, drawn_interval = self._drawn_for
        if drawn / _NEAR < speed < drawn * _NEAR and interval == drawn_interval:
            return
        turbulence = Turbulence(speed, intensity=1.0 / speed)
        gusts = turbulence.record(_SAMPLES, RATE, np.random.default_rng(self._seed))
        length = min(max(round(interval * RATE), 1), _SAMPLES)
        first = np.arange(0, _SAMPLES - length + 1, length)
        count = len(first) * length
        self._gusts = gusts[:count]
        blocks = self._gusts.reshape(len(first), length, 3)
        blocks -= blocks.mean(axis=1, keepdims=True)
        self._largest = usual_gust(self._gusts[:, 0], first, RATE)
        self._drawn_for = speed, interval
