# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Whether a tree still sways as it did, by the spectrum of a sensor against its own past.

Of each block of motion the middle of the spectrum is found, the mean of the logarithms of the
frequencies by their power, less the noise of the sensor. A tree that loses a limb, or whose roots
come loose, sways at other frequencies. So does one in another wind, a little: more wind moves the
slow modes more. The middle of the last blocks is therefore compared with the one that the blocks
before foretell for their wind, by a line over the logarithm of the mean wind whose slope is known
roughly before anything is measured.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.observe.sensor_spectrum import SensorSpectrum

BLOCK = 600.0
"""Motion of a block in [s]."""

_RECENT, _LEAST_PAST = 2, 3
"""Blocks that are compared with those before, and least number of these."""

_SCATTER, _KNOWN_LIKE = 0.02, 6.0
"""
Standard deviation of the middle of a block by chance [-], before anything is measured, which is
known as by that many blocks.
"""

_SLOPE = 0.08
"""Standard deviation of the slope of the middle over the logarithm of the wind [-]."""

_CHANGED = 4.0
"""Difference over its error from which the tree sways differently."""

_LEAST_POWER = 1.0
"""Least power of the sway over that of the noise [-]: with less, a block tells nothing."""


@dataclass(frozen=True)
class SwayChange:
    """
    A difference of the last blocks from those before.

    Parameters
    ----------
    ratio
        Middle of the spectrum over the one foretold [-].
    error
        Standard deviation of its logarithm [-].
    hours
        Length of the motion before in [h].

    """

    ratio: float
    error: float
    hours: float

    @property
    def size(self) -> float:
        """Return the difference over its error [-]."""
        return abs(math.log(self.ratio)) / self.error

    @property
    def is_change(self) -> bool:
        """Whether it is beyond chance and wind."""
        return self.size > _CHANGED

    def __str__(self) -> str:
        """Return it as a sentence."""
        percent, error = 100.0 * (self.ratio - 1.0), 100.0 * self.error
        if self.is_change:
            return (
                f'it sways differently: at frequencies {percent:+.0f} % from those of '
                f'{self.hours:.2g} h before (+- {error:.1f} % by chance and wind), as after the '
                'loss of a limb, with loose roots, ice or other leaves'
            )
        return (
            f'it sways as before: at frequencies {percent:+.1f} % from those of '
            f'{self.hours:.2g} h before (+- {error:.1f} % by chance and wind)'
        )


class _Middle(NamedTuple):
    """Logarithms of the middle of a spectrum [Hz] and of the mean wind [m/s] of a block."""

    frequency: float
    wind: float


class SwayWatch:
    """
    Blocks of the motion of a sensor, the last ones against those before.

    Parameters
    ----------
    spectrum
        Spectrum of the sensor.

    """

    def __init__(self, spectrum: SensorSpectrum) -> None:
        self._spectrum = spectrum
        self._blocks: list[_Middle] = []
        self._wind, self._n_winds = 0.0, 0
        self.change: SwayChange | None = None
        """The first change, else the last comparison; None before any."""

    def note(self, wind: float, noise: float) -> None:
        """Note the mean wind of a step in [m/s] and the noise of the sensor; end a due block."""
        self._wind += wind
        self._n_winds += 1
        if self._spectrum.block_seconds < BLOCK:
            return
        block = self._spectrum.end_block()
        mean = self._wind / self._n_winds
        self._wind, self._n_winds = 0.0, 0
        floor = block.n_stretches * self._spectrum.power_of_noise(noise)
        power = np.maximum(block.power - floor, 0.0)
        if power.sum() > max(_LEAST_POWER * floor * len(power), 1e-300):
            frequency = power @ np.log(self._spectrum.circular / (2.0 * np.pi)) / power.sum()
            self._compare(_Middle(float(frequency), math.log(max(mean, 0.1))))

    def _compare(self, last: _Middle) -> None:
        """Add a block, and compare; once the tree has changed, that stays."""
        self._blocks.append(last)
        past, recent = self._blocks[:-_RECENT], self._blocks[-_RECENT:]
        if len(past) < _LEAST_PAST or self.has_changed:
            return
        found, wind = np.mean(recent, axis=0).tolist()
        foretold, error = _foretold(np.array(past), wind)
        self.change = SwayChange(math.exp(found - foretold), error, len(past) * BLOCK / 3600.0)

    @property
    def has_changed(self) -> bool:
        """Whether the tree sways differently since some block."""
        return self.change is not None and self.change.is_change


def _foretold(past: Floats, wind: float) -> tuple[float, float]:
    """
    Foretell the middle of the last blocks in their wind, by those before, (n, 2).

    Returns
    -------
    tuple[float, float]
        The logarithm, and its standard deviation.

    """
    middle = past.mean(axis=0)
    frequency, winds = (past - middle).T
    known = float(np.square(winds).sum()) / _SCATTER**2
    slope = float(winds @ frequency) / _SCATTER**2 / (known + 1.0 / _SLOPE**2)
    left = frequency - slope * winds
    squares = _KNOWN_LIKE * _SCATTER**2 + float(np.square(left).sum())
    scatter = squares / (_KNOWN_LIKE + max(len(past) - 2, 0))
    apart = wind - float(middle[1])
    of_slope = apart**2 / (known * _SCATTER**2 / scatter + 1.0 / _SLOPE**2)
    variance = scatter * (1.0 / len(past) + 1.0 / _RECENT) + of_slope
    return float(middle[0]) + slope * apart, math.sqrt(variance)
