# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stiffness and damping of the real tree, from the spectra of its sensors.

The law of the model gives the spectrum of each sensor under unknown forces, up to its level and to
how fast gusts weaken with the frequency. The stiffness and the damping are those by which the
spectra that sensors measured are most likely (Whittle 1953, Arkiv för Matematik 2, 423-434)::

    -ln p = sum over frequencies of  ln S(f) + P(f) / S(f)

with P the averaged periodogram (Welch 1967, IEEE Transactions on Audio and Electroacoustics 15,
70-73). The level is that of highest likelihood; stiffness and damping have spreads of their own
before anything is measured: those of wood within a species, and of damping among trees. The
result is a mean over a grid of both, weighted by the likelihood. The wind takes no part in it, so
neither its place nor its calibration matters.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.one_thread import one_thread

STIFFNESS_SPREAD, DAMPING_SPREAD = 0.2, 0.5
"""Standard deviations of the logarithms of stiffness and damping, before any measurement."""

_STIFFNESSES = np.geomspace(0.5, 1.8, 53)
_DAMPINGS = np.geomspace(0.35, 3.0, 9)
_SLOPES = np.array([0.0, 1.0, 2.0, 3.0])
_BAND = (0.5, 2.2)
_CYCLES = 40.0
_INDEPENDENT = 0.6
"""Independent values in an averaged periodogram of Hann windows that overlap by half, over all."""


class TreeFit(NamedTuple):
    """
    Factors on stiffness and damping of the model, their relative errors, and the hours behind.

    The errors are standard deviations; ``hours`` the length of the motion.
    """

    stiffness: float
    damping: float
    stiffness_error: float
    damping_error: float
    hours: float


class SensorSpectrum:
    """
    Averaged spectrum of the angular rate or acceleration of a sensor.

    Parameters
    ----------
    frequency
        First frequency of the model in [Hz].
    dt
        Time step in [s].

    """

    def __init__(self, frequency: float, dt: float) -> None:
        self._dt = dt
        self._length = 2 * round(0.5 * _CYCLES / (frequency * dt))
        self._rows = np.zeros((self._length, 3))
        self._filled = self.count = 0
        axis = np.fft.rfftfreq(self._length, dt)
        self._inside = (axis > _BAND[0] * frequency) & (axis < _BAND[1] * frequency)
        self.circular: Floats = 2.0 * np.pi * np.asarray(axis[self._inside], dtype=np.float64)
        """Circular frequencies in [rad/s], (f,)."""
        self._power = np.zeros((3, len(self.circular)))
        self.seconds = 0.0
        """Length of the motion so far in [s]."""

    def add(self, motion: Floats) -> None:
        """Add three components of a step, (3,)."""
        self._rows[self._filled] = motion
        self._filled += 1
        self.seconds += self._dt
        if self._filled == self._length:
            rows = self._rows - self._rows.mean(axis=0)
            window = np.hanning(self._length + 1)[:-1, None]
            waves = np.fft.rfft(window * rows, axis=0)[self._inside]
            self._power += np.square(np.abs(waves)).T
            self.count += 1
            self._filled = self._length // 2
            self._rows[: self._filled] = self._rows[self._filled :].copy()

    def skip(self) -> None:
        """Forget an unfinished stretch: the motion has a gap."""
        self._filled = 0

    @property
    def power(self) -> Floats:
        """Averaged power of each component, (3, f)."""
        return np.asarray(self._power / max(self.count, 1))


class Spectrum(NamedTuple):
    """
    A measured spectrum, and the sensor's rows on displacement, rate and force, (3, 3 m).

    ``power`` is of the horizontal components, (2, f), at circular frequencies (f,), averaged over
    a ``count`` of stretches, from an amount of motion in [s].
    """

    rows: Floats
    power: Floats
    circular: Floats
    n_stretches: int
    seconds: float


def fits(
    spectra: Sequence[Spectrum],
    stiffness: Floats,
    damping: Floats,
    air_damping: Floats,
    covariance: Floats,
) -> Iterator[TreeFit | None]:
    """
    Try one candidate after the other, a sensor at a time; the fit is yielded last, before it None.

    Parameters
    ----------
    spectra
        Spectra of the sensors.
    stiffness, damping, air_damping
        Stiffness [1/s^2] and damping [1/s] of wood and air of the coordinates, (m,).
    covariance
        Covariance of the unknown forces, (m, m).

    """
    values, vectors = np.linalg.eigh(covariance)
    kept = values > 1e-6 * values[-1]
    forces = (vectors[:, kept] * np.sqrt(values[kept])).T
    table = np.zeros((len(_STIFFNESSES), len(_DAMPINGS), len(_SLOPES)))
    for i, stiff in enumerate(_STIFFNESSES.tolist()):
        for j, damped in enumerate(_DAMPINGS.tolist()):
            law = stiff * stiffness, damped * damping + air_damping
            for each in spectra:
                with one_thread():
                    table[i, j] += _misfit(each, *law, forces)
                yield None
            prior = (math.log(stiff) / STIFFNESS_SPREAD) ** 2
            table[i, j] += 0.5 * (prior + (math.log(damped) / DAMPING_SPREAD) ** 2)
    weight = np.exp(table.min() - table).sum(axis=2)
    weight /= weight.sum()
    hours = max(each.seconds for each in spectra) / 3600.0
    first = _mean(np.log(_STIFFNESSES), weight.sum(axis=1))
    second = _mean(np.log(_DAMPINGS), weight.sum(axis=0))
    yield TreeFit(math.exp(first[0]), math.exp(second[0]), first[1], second[1], hours)


def _mean(values: Floats, weight: Floats) -> tuple[float, float]:
    mean = float(weight @ values)
    step = float(values[1] - values[0])
    return mean, math.sqrt(float(weight @ np.square(values - mean)) + step * step / 12.0)


def _misfit(of: Spectrum, stiffness: Floats, damping: Floats, forces: Floats) -> Floats:
    """Return -ln p of a spectrum for each slope of the gusts, (s,)."""
    w = of.circular
    response = 1.0 / (stiffness[:, None] - w * w + 1j * w * damping[:, None])
    m = len(stiffness)
    low = np.log(w / w[0])
    total = np.zeros(len(_SLOPES))
    for axis in (0, 1):
        by_eta, by_rate, by_force = of.rows[axis].reshape(3, m)
        # What a force does to the sensor by itself is that of the oscillators it moves.
        motion = (by_eta[:, None] + 1j * w * by_rate[:, None]) * response
        motion += by_force[:, None]
        level = np.square(np.abs(forces @ motion)).sum(axis=0)
        # The window spreads the power of a frequency to its neighbours.
        level[1:-1] = (level[:-2] + 4.0 * level[1:-1] + level[2:]) / 6.0
        shaped = level * np.exp(-_SLOPES[:, None] * low)
        over = of.power[axis] / np.maximum(shaped, 1e-300)
        scale = np.maximum(over.mean(axis=1, keepdims=True), 1e-300)
        terms = np.log(np.maximum(scale * shaped, 1e-300)) + over / scale
        total += terms.sum(axis=1)
    return np.asarray(_INDEPENDENT * of.n_stretches * total)
