# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Statistics of the last wind for the choice of a model, spectrum and mean of its load.

A load is proportional to ``|U| U``, also in vertical wind.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np

from tree_sway.core.arrays import Floats


@dataclass(frozen=True)
class WindClimate:
    """
    Statistics of ``|U| U``.

    Parameters
    ----------
    mean
        Mean in [m^2/s^2], (3,).
    covariance
        Covariance in [m^4/s^4], (3, 3).
    speed
        Mean speed in [m/s].
    record, rate
        Measured ``|U| U`` in [m^2/s^2], (n, 3), and its rate in [Hz].

    """

    mean: Floats
    covariance: Floats
    speed: float
    record: Floats
    rate: float

    @staticmethod
    def of_samples(velocity: Floats, rate: float) -> WindClimate:
        """Make the statistics of a known wind in [m/s], (n, 3), at a rate in [Hz]."""
        speed = np.linalg.norm(velocity, axis=1)
        return _of_loads(speed[:, None] * velocity, float(speed.mean()), rate)

    def power(self, frequencies: Floats) -> Floats:
        """
        Spectrum of the load [m^4/s^4], (f, 3, 3), at frequencies [Hz] from 0, (f,).

        A record has calm before and after it, so that transients are included: the response of a
        linear model to this power is at least the mean square of its motion from rest in that time
        (Parseval's theorem).
        """
        n = len(self.record)
        lines = np.fft.rfft(self.record, 2 * n, axis=0)
        lines[1:-1] *= math.sqrt(2.0)
        squares = np.einsum('fi,fj->fij', lines.conj(), lines).real / (2 * n * n)
        at = np.arange(n + 1) * self.rate / (2 * n)
        # Each line is divided between the frequencies next below and above it.
        below = np.searchsorted(frequencies, at, side='right') - 1
        below = np.minimum(below, len(frequencies) - 2)
        low = frequencies[below]
        high = frequencies[below + 1]
        share = np.minimum((at - low) / (high - low), 1.0)
        power = np.zeros((len(frequencies), 3, 3))
        np.add.at(power, below, (1.0 - share)[:, None, None] * squares)
        np.add.at(power, below + 1, share[:, None, None] * squares)
        mean = self.record.mean(axis=0)
        power[0] -= np.outer(mean, mean)
        return power


class ClimateTracker:
    """The wind in cells of equal length, stored for ``memory`` [s]."""

    def __init__(self, memory: float = 60.0) -> None:
        """Start with no wind."""
        self._memory = memory
        self._cells = np.zeros((round(memory * _RATE), 4))
        self._count = 0
        self._sum = np.zeros(4)
        self._open = 0.0

    def add(self, wind: Floats, dt: float) -> None:
        """Add the wind [m/s] of a step of dt [s]."""
        speed = float(np.linalg.norm(wind))
        left = min(dt, self._memory)
        load = speed * np.append(wind, 1.0)
        while left > 0.0:
            part = min(left, 1.0 / _RATE - self._open)
            self._sum += part * load
            self._open += part
            left -= part
            if self._open > (1.0 - 1e-9) / _RATE:
                self._cells[self._count % len(self._cells)] = self._cell
                self._count += 1
                self._sum[:] = 0.0
                self._open = 0.0

    @property
    def climate(self) -> WindClimate:
        """Return the statistics of the stored wind."""
        cells = np.roll(self._cells, -self._count, axis=0)[max(-self._count, -len(self._cells)) :]
        cells = cells if self._count else cells[:0]
        if self._open > 0.0 or not len(cells):
            cells = np.vstack([cells, self._cell])
        return _of_loads(cells[:, :3], float(cells[:, 3].mean()), _RATE)

    @property
    def largest_load(self) -> float:
        """Largest ``|U| U`` of a stored cell in [m^2/s^2]."""
        return float(np.linalg.norm(self._cells[:, :3], axis=1).max())

    @property
    def _cell(self) -> Floats:
        """Means of the current cell, (4,)."""
        return np.asarray(self._sum / max(self._open, 1e-12))


_RATE = 20.0
"""Cells per second in [Hz]."""


def _of_loads(loads: Floats, speed: float, rate: float) -> WindClimate:
    mean = loads.mean(axis=0)
    around = loads - mean
    covariance = around.T @ around / len(loads)
    return WindClimate(mean, covariance, speed, np.ascontiguousarray(loads), rate)
