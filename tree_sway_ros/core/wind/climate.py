# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind of the last while in a few numbers: what a choice of model needs to know of it.

A load goes with ``|U| U``. Its mean and covariance are taken in the plane; how it is spread over
frequencies is von Karman's longitudinal spectrum (von Karman, 1948) of the wind's integral time.

"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.wind.simulated.spectra import von_karman_spectrum


@dataclass(frozen=True)
class WindClimate:
    """
    Statistics of ``|U| U`` in the plane.

    Parameters
    ----------
    mean
        Along x and y in [m^2/s^2], (2,).
    covariance
        In [m^4/s^4], (2, 2).
    speed
        Mean speed in [m/s].
    integral_time
        How long a gust lasts in [s].
    beat, beat_share
        Frequency in [Hz] at which the load swings most, and the share of the variance that does so;
        no share in turbulence.

    """

    mean: Floats
    covariance: Floats
    speed: float
    integral_time: float = 5.0
    beat: float = 1.0
    beat_share: float = 0.0

    @staticmethod
    def steady(
        mean_speed: float, intensity: float, bearing: float = 0.0, integral_time: float = 5.0
    ) -> WindClimate:
        """
        Take a wind that is only described.

        Parameters
        ----------
        mean_speed
            In [m/s].
        intensity
            Standard deviation over mean of the along-wind speed in [-]; across it 0.8 of that (IEC
            61400-1).
        bearing
            Angle of the mean from x towards y in [rad].
        integral_time
            How long a gust lasts in [s].

        """
        along = np.array([math.cos(bearing), math.sin(bearing)])
        across = np.array([-along[1], along[0]])
        square, sigma = mean_speed**2, intensity * mean_speed
        covariance = (2.0 * mean_speed * sigma) ** 2 * np.outer(along, along)
        covariance += (0.8 * mean_speed * sigma) ** 2 * np.outer(across, across)
        return WindClimate(
            square * (1.0 + intensity**2) * along, covariance, mean_speed, integral_time
        )

    def spectrum(self, frequencies: Floats) -> Floats:
        """
        Share of the variance per frequency in [1/Hz], of integral 1; (f,) for frequencies (f,) in
        [Hz].

        """
        share = von_karman_spectrum(frequencies, 1.0, 1.0, self.integral_time)
        if self.beat_share > 0.0:
            width = _BEAT_WIDTH * self.beat
            swing = np.exp(-0.5 * np.square((frequencies - self.beat) / width))
            swing *= self.beat_share / (math.sqrt(2.0 * math.pi) * width)
            share = (1.0 - self.beat_share) * share + swing
        return share


class ClimateTracker:
    """
    Statistics of the wind as it comes, the older the fainter.

    Parameters
    ----------
    memory
        Time after which a sample counts 1/e in [s].

    """

    def __init__(self, memory: float = 60.0) -> None:
        """Start with no wind."""
        self.memory = memory
        self._weight = self._speed = 0.0
        self._x = self._y = self._xx = self._xy = self._yy = 0.0

    def add(self, wind: Floats, dt: float) -> None:
        """
        Take in the wind (3,) in [m/s] of a step of dt [s]; plain numbers, as it is done every step.

        """
        u, v, w = wind.tolist()
        speed = math.sqrt(u * u + v * v + w * w)
        x, y = speed * u, speed * v
        keep = math.exp(-dt / self.memory)
        self._weight = keep * self._weight + (1.0 - keep)
        new = (1.0 - keep) / self._weight
        self._speed += new * (speed - self._speed)
        self._x += new * (x - self._x)
        self._y += new * (y - self._y)
        self._xx += new * (x * x - self._xx)
        self._xy += new * (x * y - self._xy)
        self._yy += new * (y * y - self._yy)

    @property
    def climate(self) -> WindClimate:
        """Statistics so far."""
        mean = np.array([self._x, self._y])
        square = np.array([[self._xx, self._xy], [self._xy, self._yy]])
        return WindClimate(mean, square - np.outer(mean, mean), self._speed)


_BEAT_WIDTH = 0.04
"""Width of a beat over its frequency in [-]."""
