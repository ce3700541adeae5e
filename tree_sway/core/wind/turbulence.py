# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Turbulent wind at one point: records drawn from Kaimal's spectra (IEC 61400-1:2005, annex B.2).

A record is the inverse FFT of the spectrum with fixed amplitudes and random phases (Shinozuka &
Deodatis 1991), the usual practice of wind engineering: every record has the exact spectrum at each
line and the exact variance, and tends to a Gaussian process. Gusts come from above and lulls from
below: u and w are correlated by `_STRESS`, most in slow gusts, as in the cospectrum of Kaimal &
Finnigan; v is independent of both.

A sampled record has no frequencies above half its rate, nor below one over its period. That
variance is not lost: each spectrum is scaled to its full variance, as IEC records are. At 20 Hz,
10 m and 7 m/s this lifts u, v, w by 0.1, 0.2, 0.4 dB; at 1 Hz it lifts w by 3 dB, so do not read
spectra from a slow record.

Symbols: U mean speed [m/s], z height [m], n frequency [Hz], L integral scale [m], s standard
deviation [m/s], Lambda1 turbulence scale of IEC 61400-1 [m]. Axes of a record: u along the mean
wind, v to its left, w up.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.random_source import generator_of

# IEC 61400-1: standard deviations over that of u, for u, v, w.
_DEVIATION_RATIOS = np.array([1.0, 0.8, 0.5])
SCALE_RATIOS = np.array([8.1, 2.7, 0.66])
"""Integral scales of u, v, w over Lambda1 [-]."""

_STRESS = -1.0 / 3.0
"""
Correlation of u and w in [-]: -u*^2 over their deviations, 2.4 and 1.25 times u*, over level
ground (Kaimal & Finnigan 1994, chapter 1).

"""

REFERENCE_INTENSITY = 0.14
"""I_ref of IEC 61400-1 in [-], of its class B."""

SHORTEST_PERIOD = 600.0
"""Shortest period of a record in [s]: the ten minutes over which IEC defines the deviations."""


@dataclass(frozen=True)
class Turbulence:
    """
    The turbulence at one point, and records of it.

    Parameters
    ----------
    mean_speed
        Mean wind speed in [m/s], above 0 and up to 40.
    height
        Height above the ground in [m]; sets the integral scales.
    intensity
        Turbulence intensity s_u/U in [-]; the deviation of IEC's class B if None.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """

    mean_speed: float
    height: float = 10.0
    intensity: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        within('mean_speed', self.mean_speed, 0.0, 40.0, 'm/s', above=True)
        within('height', self.height, 0.0, 1000.0, 'm', above=True)
        if self.intensity is not None:
            within('intensity', self.intensity, 0.0, 2.0)

    @cached_property
    def deviations(self) -> Floats:
        """Return the deviations of u, v, w [m/s], (3,): IEC 61400-1:2005, eq. 11, table B.1."""
        if self.intensity is not None:
            along = self.intensity * self.mean_speed
        else:
            along = REFERENCE_INTENSITY * (0.75 * self.mean_speed + 5.6)
        return along * _DEVIATION_RATIOS

    @cached_property
    def scales(self) -> Floats:
        """Integral scales of u, v, w in [m], (3,)."""
        return turbulence_scale(self.height) * SCALE_RATIOS

    def spectrum(self, frequency: ArrayLike) -> Floats:
        """Return one-sided spectra of u, v, w in [m^2/s^2/Hz] at frequencies in [Hz], (n, 3)."""
        time = self.scales / self.mean_speed
        x = np.asarray(frequency, dtype=np.float64)[..., None] * time
        variance = self.deviations**2
        return np.asarray(variance * 4.0 * time / (1.0 + 6.0 * x) ** (5 / 3))

    def record(self, n_samples: int, rate: float, rng: np.random.Generator) -> Floats:
        """
        Draw one period of the turbulence, which can be repeated without a step.

        It has at least 4 samples at a rate in [Hz], u, v, w with zero mean in [m/s], (n, 3); each
        variance is exactly that of `deviations`.
        """
        n_lines = (n_samples - 1) // 2  # without the mean, nor the line at half the rate
        frequency: Floats = np.arange(1, n_lines + 1, dtype=np.float64) * (rate / n_samples)
        power = self.spectrum(frequency)
        variance = np.maximum(power.sum(axis=0), np.finfo(np.float64).tiny)
        power *= self.deviations**2 / variance
        phase = rng.uniform(0.0, 2.0 * np.pi, size=(3, n_lines)).T
        widest = _widest_phase(self._coherency(frequency, power))
        share = phase[:, 2] / np.pi - 1.0
        phase[:, 2] = phase[:, 0] + np.pi + widest * share
        amplitude = np.sqrt(0.5 * power)
        lines = np.zeros((n_samples // 2 + 1, 3), dtype=np.complex128)
        lines[1 : n_lines + 1] = n_samples * amplitude * np.exp(1j * phase)
        return np.fft.irfft(lines, n=n_samples, axis=0)

    def _coherency(self, frequency: Floats, power: Floats) -> Floats:
        """
        Coherency of u and w on lines of these powers (n, 3), (n,), less its sign.

        It follows the cospectrum ``1 / (1 + 9.6 n z / U)^(7/3)`` (Kaimal & Finnigan 1994, chapter
        2), up to 1, with the sum of `_STRESS`.
        """
        cospectrum = (1.0 + 9.6 * frequency * self.height / self.mean_speed) ** (-7.0 / 3.0)
        both = np.sqrt(power[:, 0] * power[:, 2])
        wanted = -_STRESS * float(np.prod(self.deviations[[0, 2]]))
        if not wanted > 0.0:
            return np.zeros(len(frequency))
        ratio = np.divide(cospectrum, both, out=np.zeros_like(both), where=both > 0.0)
        least_ratio = float(ratio[ratio > 0.0].min(initial=1.0))
        low = 0.0
        high = 1.0 / max(least_ratio, 1e-300)
        for _ in range(60):
            middle = 0.5 * (low + high)
            coherency = np.minimum(middle * ratio, 1.0)
            # Without BLAS, whose threads may wait for each other far longer than the sum takes.
            stress = float((coherency * both).sum())
            if stress < wanted:
                low = middle
            else:
                high = middle
        return np.minimum(high * ratio, 1.0)


def _widest_phase(coherency: Floats) -> Floats:
    """
    Return the phases a [rad] up to which lines are apart from opposite ones, either way.

    Their coherency is the mean of the cosine of such phases, ``sin a / a``.
    """
    angle = np.linspace(0.0, np.pi, 2001)
    return np.interp(-coherency, -np.sinc(angle / np.pi), angle)


def turbulence_scale(height: float) -> float:
    """Return Lambda1 in [m] at a height in [m]: IEC 61400-1:2005, equation 5."""
    return 0.7 * min(height, 60.0)


def along_bearing(record: Floats, bearing_to: float) -> Floats:
    """
    Rotate velocities along a mean wind, to its left and up, (..., 3), to east, north, up.

    The mean wind blows to a bearing clockwise from north in [rad]: a westerly has pi/2.
    """
    sine = np.sin(bearing_to)
    cosine = np.cos(bearing_to)
    enu_from_wind = np.array([[sine, -cosine, 0.0], [cosine, sine, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(record @ enu_from_wind.T)


def simulate_turbulence(
    mean_speed: float, *, rate: float = 60.0, duration: float = 60.0,
    rng: np.random.Generator | int = 0,
    height: float = 10.0, intensity: float | None = None, bearing_to: float = 0.5 * np.pi,
) -> Floats:  # fmt: skip
    """
    Simulate the wind at one point: its mean and its turbulence.

    Parameters
    ----------
    mean_speed, height, intensity
        Height and intensity, as in `Turbulence`.
    rate
        Samples per second in [Hz], up to 1000.
    duration
        Length of the record in [s]; one shorter than `SHORTEST_PERIOD` is cut from a period of
        that length, so that it has the slow part of the spectrum too.
    rng
        Source of the phases, or its seed.
    bearing_to
        Direction of the mean wind, clockwise from north in [rad]; the default is a westerly.

    Returns
    -------
    Floats
        Wind velocity, blowing to, ENU in [m/s], (round(rate * duration), 3), one sample at least.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """
    turbulence = Turbulence(mean_speed, height, intensity)
    within('rate', rate, 0.0, 1000.0, 'Hz', above=True)
    within('duration', duration, 0.0, 1e6, 's', above=True)
    within('bearing_to', bearing_to, -6.3, 6.3, 'rad')
    n_samples = max(round(rate * duration), 1)
    n_period = max(n_samples, int(np.ceil(rate * SHORTEST_PERIOD)), 4)
    wind = turbulence.record(n_period, rate, generator_of(rng))[:n_samples]
    wind[:, 0] += mean_speed
    return along_bearing(wind, bearing_to)
