# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stiffness and damping of the real tree, from the wind and the motion of its sensors.

A candidate is the model with other stiffness and damping. The force of the known wind on it gives
a motion Y0 of each sensor, up to a factor a for its drag; what is beyond has the spectrum S of the
candidate under unknown forces, up to its level and to how fast gusts weaken with the frequency.
The most likely candidate has the largest p (Whittle 1953, Arkiv för Matematik 2, 423-434)::

    -ln p = sum over frequencies of  ln S(f) + |Y(f) - a Y0(f)|^2 / S(f)

with the mean over stretches of the record (Welch 1967, IEEE Transactions on Audio and
Electroacoustics 15, 70-73). Level and a are those of highest likelihood. Stiffness and damping
have spreads of their own before anything is measured: those of wood within a species, and of
damping among trees. The result is a mean over a grid of both, weighted by the likelihood.

The phase between wind and motion tells a frequency far better than the height of a spectrum. Where
the anemometer is so far away that its wind explains nothing, a is zero and the spectrum remains.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.one_thread import one_thread

Waves = NDArray[np.complex128]
"""Complex amplitudes."""

STIFFNESS_SPREAD, DAMPING_SPREAD = 0.2, 0.5
"""Standard deviations of the logarithms of stiffness and damping, before any measurement."""

_STIFFNESSES = np.geomspace(0.5, 1.8, 53)
_DAMPINGS = np.geomspace(0.35, 3.0, 9)
_SLOPES = np.array([0.0, 1.0, 2.0, 3.0])
_BAND = (0.5, 2.2)
_CYCLES = 40.0
_MOST_DRAG = 2.0
_INDEPENDENT = 0.1
"""
Independent values in an averaged periodogram over all.

Hann windows that overlap by half have 0.6. The rest is for what the spectrum of a candidate lacks:
with 0.6, fits missed the known stiffness of made-up trees by 2.4 of their stated errors (root mean
square over 22 fits of six kinds of tree).
"""


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
    Averaged spectrum of the angular rate or acceleration of a sensor, and of the known forces.

    Parameters
    ----------
    frequency
        First frequency of the model in [Hz].
    dt
        Time step in [s].
    count
        Number of coordinates whose forces are known.

    """

    def __init__(self, frequency: float, dt: float, count: int) -> None:
        self._dt = dt
        self._length = 2 * round(0.5 * _CYCLES / (frequency * dt))
        # East, north and the force on each coordinate.
        self._rows = np.zeros((self._length, 2 + count))
        self._window = np.hanning(self._length + 1)[:-1, None]
        self._filled = self.count = 0
        axis = np.fft.rfftfreq(self._length, dt)
        self._inside = (axis > _BAND[0] * frequency) & (axis < _BAND[1] * frequency)
        self.circular: Floats = 2.0 * np.pi * np.asarray(axis[self._inside], dtype=np.float64)
        """Circular frequencies in [rad/s], (f,)."""
        n_rows = 2 + count
        self._products = np.zeros((len(self.circular), n_rows, n_rows), dtype=np.complex128)
        self.seconds = 0.0
        """Length of the motion so far in [s]."""

    def add(self, motion: Floats, force: Floats) -> None:
        """Add motion, (3,), and forces of the known wind, (count,), of a step."""
        row = self._rows[self._filled]
        row[:2], row[2:] = motion[:2], force
        self._filled += 1
        self.seconds += self._dt
        if self._filled < self._length:
            return
        with one_thread():
            moved = self._window * (self._rows - self._rows.mean(axis=0))
            waves = np.fft.rfft(moved, axis=0)[self._inside]
            self._products += waves[:, :, None] * waves[:, None].conj()
        self.count += 1
        self._filled = self._length // 2
        self._rows[: self._filled] = self._rows[self._filled :].copy()

    def skip(self) -> None:
        """Forget an unfinished stretch: the motion has a gap."""
        self._filled = 0

    @property
    def products(self) -> Waves:
        """Mean products of east, north and each force with the conjugates of all, (f, k, k)."""
        return self._products / max(self.count, 1)


class Spectrum(NamedTuple):
    """
    A measured spectrum, and the sensor's rows on displacement, rate and force, (3, 3 m).

    ``products`` are those of `SensorSpectrum` at circular frequencies (f,), averaged over a
    ``count`` of stretches, from an amount of motion in [s].
    """

    rows: Floats
    products: Waves
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
                    table[i, j] += _misfit(each, *law, forces, (stiff - 1.0) * stiffness)
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


def _misfit(
    of: Spectrum, stiffness: Floats, damping: Floats, forces: Floats, stiffer: Floats
) -> Floats:
    """
    Return -ln p of a spectrum for each slope of the gusts, (s,).

    Parameters
    ----------
    of
        The measured spectrum.
    stiffness, damping
        Those of the candidate, (m,).
    forces
        A root of the covariance of the unknown forces, (k, m).
    stiffer
        Stiffness of the candidate less that of the sensor's rows, (m,).

    """
    w = of.circular
    response = 1.0 / (stiffness[:, None] - w * w + 1j * w * damping[:, None])
    low = np.log(w / w[0])
    weaker = np.exp(-_SLOPES[:, None] * low)
    told, known, moved = (np.zeros((2, len(_SLOPES))) for _ in range(3))
    logs = np.zeros(len(_SLOPES))
    for axis in (0, 1):
        by_eta, by_rate, by_force = of.rows[axis].reshape(3, -1)
        by_eta = by_eta - stiffer * by_force
        motion = (by_eta[:, None] + 1j * w * by_rate[:, None]) * response
        motion += by_force[:, None]
        level = np.square(np.abs(forces @ motion)).sum(axis=0)
        # The window spreads the power of a frequency to its neighbours.
        level[1:-1] = (level[:-2] + 4.0 * level[1:-1] + level[2:]) / 6.0
        shaped = np.maximum(level * weaker, 1e-300)
        # Power of the measured and of the expected motion, and what both have in common.
        products, by_mode = of.products, motion.T[:, None]
        expected = by_mode @ products[:, 2:, 2:] @ by_mode.conj().swapaxes(1, 2)
        shared = by_mode @ products[:, 2:, axis, None]
        told[axis] = (products[:, axis, axis].real / shaped).mean(axis=1)
        known[axis] = (expected[:, 0, 0].real / shaped).mean(axis=1)
        moved[axis] = (shared[:, 0, 0].real / shaped).mean(axis=1)
        logs += np.log(shaped).sum(axis=1)
    # The factor of the drag, and the level of what it leaves.
    drag = np.clip(moved.sum(axis=0) / np.maximum(known.sum(axis=0), 1e-300), 0.0, _MOST_DRAG)
    left = told - 2.0 * drag * moved + drag * drag * known
    logs += len(w) * np.log(np.maximum(left, 1e-300)).sum(axis=0)
    return np.asarray(_INDEPENDENT * of.n_stretches * logs)
