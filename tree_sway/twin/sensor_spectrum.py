# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Averaged spectrum of the motion of a sensor and of the known forces (Welch 1967).

Stretches overlap by half. While the next half is measured, the last stretch is transformed, a
series at each step.
"""

from __future__ import annotations

from operator import sub
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Complexes, Floats
from tree_sway.core.native import NativeSeries
from tree_sway.twin.spectrum_change import WATCHED_BAND
from tree_sway.twin.waves import power_of

_BAND = (0.5, 2.2)
"""Frequencies over the first one of the tree."""

_CYCLES = 40.0
"""Length of a stretch in periods of the first frequency."""

HALVES = 3
"""
Halves that are kept, ``SWAY_HALVES`` of the native core: the last stretch, and the half that is
being measured.
"""


class SpectrumBlock(NamedTuple):
    """
    Power of east and north together at each frequency, (f,), a sum over ``n_stretches``.

    ``watched`` is that of the watched motion, of east and north, (g, 2), ``noise`` that of the
    noise of one axis of both motions, (2,), and ``seconds`` the length of the motion in [s].
    """

    power: Floats
    watched: Floats
    noise: Floats
    n_stretches: int
    seconds: float


class SensorSpectrum:
    """
    Averaged spectrum of the angular rate or acceleration of a sensor, and of the known forces.

    That of the watched motion, the acceleration where there is one, is over a wider band.

    Parameters
    ----------
    frequency
        First frequency of the model in [Hz].
    dt
        Time step in [s].
    count
        Number of coordinates whose forces are known.
    first, second
        Numbers of the motion, and of the watched one, to east in a sample.

    """

    def __init__(
        self, frequency: float, dt: float, count: int, first: int = 3, second: int = 0
    ) -> None:
        self._dt = dt
        half = self._half = round(0.5 * _CYCLES / (frequency * dt))
        # East, north, the force on each coordinate, and the watched motion to east and north.
        self._n_products = 2 + count
        n_series = self._n_products + 2
        self._series = np.zeros((HALVES, half, n_series))
        self.native = NativeSeries(rows=self._series, half=half, first=first, second=second)
        """Its series in the native core, which adds the samples."""
        self._window = np.hanning(2 * half + 1)[:-1]
        self._stretch = np.zeros(2 * half)
        axis = np.asarray(np.fft.rfftfreq(2 * half, dt), dtype=np.float64)
        self._inside = _within(axis, _BAND, frequency)
        self.circular: Floats = 2.0 * np.pi * axis[self._inside]
        """Circular frequencies in [rad/s], (f,)."""
        n_frequencies = len(self.circular)
        shape = (n_frequencies, self._n_products)
        self._waves = np.zeros(shape, dtype=np.complex128)
        self._products = np.zeros((*shape, self._n_products), dtype=np.complex128)
        self._power = np.zeros(n_frequencies)
        self._is_watched = _within(axis, WATCHED_BAND, frequency)
        self.watched_frequencies: Floats = axis[self._is_watched]
        """Frequencies of the watched motion in [Hz], (g,)."""
        self._watched = np.zeros((len(self.watched_frequencies), 2))
        self._noise = np.zeros(2)
        self._filled = 0
        self._n_series = self._next = n_series
        self.count = 0
        """Number of stretches."""
        self.seconds = 0.0
        """Length of the motion so far in [s]."""
        self._block = self._taken = self._so_far()

    def advance(self) -> bool:
        """Go on by a step; tell whether there is another sample."""
        filled = self.native.filled
        if filled == self._filled:
            return False
        self._filled = filled
        self.seconds += self._dt
        if self._next < self._n_series:
            self._transform_next()
        if filled > self._half and filled % self._half == 0:
            self._next = 0
        return True

    @property
    def until_first(self) -> float:
        """Motion in [s] that is missing to the first stretch."""
        return 0.0 if self.count else max(2 * self._half - self._filled, 0) * self._dt

    def skip(self) -> None:
        """Forget an unfinished stretch: the motion has a gap."""
        self.native.filled = self._filled = 0
        self._next = self._n_series

    def _transform_next(self) -> None:
        """Transform a series of the last stretch, and average after the last one."""
        series, stretch, half = self._series[..., self._next], self._stretch, self._half
        now = self._filled // half % HALVES
        stretch[:half] = series[now - 2]
        stretch[half:] = series[now - 1]
        stretch -= stretch.mean()
        stretch *= self._window
        waves = np.fft.rfft(stretch)
        if self._next < self._n_products:
            self._waves[:, self._next] = waves[self._inside]
        else:
            axis = self._next - self._n_products
            self._watched[:, axis] += power_of(waves[self._is_watched])
        self._next += 1
        if self._next == self._n_series:
            self._products += self._waves[:, :, None] * self._waves[:, None].conj()
            self._power += power_of(self._waves[:, :2]).sum(axis=1)
            self.count += 1

    @property
    def power(self) -> float:
        """Power of east and north at all frequencies, a sum over the stretches."""
        return self._power.sum()

    @property
    def block_seconds(self) -> float:
        """Length of the motion of the present block in [s]."""
        return self.seconds - self._block.seconds

    def end_block(self) -> SpectrumBlock:
        """Begin a block; return the last one."""
        before, self._block = self._block, self._so_far()
        return SpectrumBlock(*map(sub, self._block, before))

    def _so_far(self) -> SpectrumBlock:
        """Return the block of all motion so far."""
        power, watched, noise = self._power.copy(), self._watched.copy(), self._noise.copy()
        return SpectrumBlock(power, watched, noise, self.count, self.seconds)

    def power_of_noise(self, deviation: float) -> float:
        """Power of white noise of a deviation at each frequency of a stretch, of one axis."""
        return deviation**2 * np.square(self._window).sum()

    def note_noise(self, deviation: float, watched: float) -> None:
        """Note the noise in a step of the last stretch of both motions, standard deviations."""
        self._noise += self.power_of_noise(deviation), self.power_of_noise(watched)

    @property
    def noise(self) -> float:
        """Mean power of the noise of the new stretches at each frequency, of one axis."""
        new = self._noise[0] - self._taken.noise[0]
        return new / max(self.new_stretches, 1)

    @property
    def new_stretches(self) -> int:
        """Number of stretches since products were taken last."""
        return self.count - self._taken.n_stretches

    @property
    def new_seconds(self) -> float:
        """Length of the motion since products were taken last [s]."""
        return self.seconds - self._taken.seconds

    def take_products(self) -> None:
        """Begin the products anew."""
        self._products[:] = 0.0
        self._taken = self._so_far()

    @property
    def products(self) -> Complexes:
        """
        Mean products of east, north and each force with the conjugates of all, (f, k, k).

        They are of the new stretches.
        """
        return self._products / max(self.new_stretches, 1)


def _within(axis: Floats, band: tuple[float, float], frequency: float) -> NDArray[np.bool_]:
    """Which frequencies of an axis are within a band over the first one of the tree."""
    low, high = band
    return (axis > low * frequency) & (axis < high * frequency)
