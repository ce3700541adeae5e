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

A change is told until the tree sways as before again, as when wet leaves have dried: as surely
otherwise than with the change when it was largest. Blocks of a changed tree foretell nothing.

The loss of a small limb moves the middle by less than chance does. It changes the power in narrow
bands, which `spectrum_change` compares.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.twin.later_work import LaterWork
from tree_sway.twin.sensor_spectrum import SensorSpectrum
from tree_sway.twin.spectrum_change import BandChange, CHANGED, SpectrumChange

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

_COMPARED_AFTER = 10
"""Steps after which the bands of a block are compared."""

_CAUSES = 'as after the loss of a limb, with loose roots, ice or other leaves'


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
    band
        Largest change of the power in a band; None before any was looked for.

    """

    ratio: float
    error: float
    hours: float
    band: BandChange | None = None

    @property
    def size(self) -> float:
        """Return the larger difference over the least one that counts [-]."""
        of_band = 0.0 if self.band is None else self.band.size / CHANGED
        return max(self.of_middle, of_band)

    @property
    def of_middle(self) -> float:
        """Return the difference of the middle over the least one that counts [-]."""
        return abs(math.log(self.ratio)) / self.error / _CHANGED

    @property
    def is_change(self) -> bool:
        """Whether it is beyond chance and wind."""
        return self.size > 1.0

    @property
    def changed_band(self) -> BandChange | None:
        """The band whose power has changed, where the middle of the spectrum does not tell it."""
        return self.band if self.is_change and self.of_middle <= 1.0 else None

    def __str__(self) -> str:
        """Return it as a sentence."""
        percent, error = 100.0 * (self.ratio - 1.0), 100.0 * self.error
        if (band := self.changed_band) is not None:
            return (
                f'it sways differently: {band.power:.2g} times the power of {self.hours:.2g} h '
                f'before at {band.low:.2f} to {band.high:.2f} Hz, {_CAUSES}'
            )
        if self.is_change:
            return (
                f'it sways differently: at frequencies {percent:+.0f} % from those of '
                f'{self.hours:.2g} h before (+- {error:.1f} % by chance and wind), {_CAUSES}'
            )
        return (
            f'it sways as before: at frequencies {percent:+.1f} % from those of '
            f'{self.hours:.2g} h before (+- {error:.1f} % by chance and wind)'
        )


class SwayWatch:
    """
    Blocks of the motion of a sensor, the last ones against those before.

    Parameters
    ----------
    spectrum
        Spectrum of the sensor.
    frequency
        First frequency of the model in [Hz].

    """

    def __init__(self, spectrum: SensorSpectrum, frequency: float) -> None:
        self._spectrum = spectrum
        self._bands = SpectrumChange(spectrum.watched_frequencies, frequency)
        self._work: LaterWork[BandChange] | None = None
        # Logarithms of the middle of the spectrum [Hz] and of the mean wind [m/s].
        self._blocks: list[tuple[float, float]] = []
        self._n_past = 0
        self._began = (0.0, 0.0, 0)
        self._told = 1.0  # the largest ratio since a change is told
        self.change: SwayChange | None = None
        """The change that lasts, else the last comparison; None before any."""

    def advance(self, winds: tuple[float, float, int]) -> None:
        """
        End a block that is full, and go on with comparing the bands of the one before.

        Parameters
        ----------
        winds
            Sums of the winds so far to east and north [m/s], and their number.

        """
        if self._work is not None and (found := self._work.advance()) is not None:
            self._work = None
            if self.change is not None:
                self.change = replace(self.change, band=found)
        if self._spectrum.block_seconds < BLOCK:
            return
        block = self._spectrum.end_block()
        east, north, count = (now - then for now, then in zip(winds, self._began, strict=True))
        wind = east / count, north / count
        self._began = winds
        floor = 2.0 * block.noise[0]
        power = np.maximum(block.power - floor, 0.0)
        if power.sum() > max(_LEAST_POWER * floor * len(power), 1e-300):
            frequency = power @ np.log(self._spectrum.circular / (2.0 * np.pi)) / power.sum()
            self._compare((float(frequency), math.log(max(math.hypot(*wind), 0.1))))
        if block.n_stretches:
            find = partial(
                self._bands.add,
                block.watched / block.n_stretches,
                float(block.noise[1]) / block.n_stretches,
                block.seconds,
                wind,
            )
            self._work = LaterWork(find, _COMPARED_AFTER)

    def _compare(self, last: tuple[float, float]) -> None:
        """Add a block, and compare the last ones with those before any change."""
        self._blocks.append(last)
        before = self.change
        is_changed = before is not None and before.of_middle > 1.0
        if not is_changed:
            self._n_past = len(self._blocks) - _RECENT
        past, recent = self._blocks[: self._n_past], self._blocks[-_RECENT:]
        if len(past) < _LEAST_PAST:
            return
        found, wind = np.mean(recent, axis=0).tolist()
        foretold, error = _foretold(np.array(past), wind)
        hours = len(past) * BLOCK / 3600.0
        band = None if before is None else before.band
        now = SwayChange(math.exp(found - foretold), error, hours, band)
        if is_changed and before is not None and now.of_middle <= 1.0:
            apart = abs(math.log(now.ratio / self._told))
            if apart <= _CHANGED * error:  # in this wind the change would not be seen
                return
            del self._blocks[self._n_past : -_RECENT]
        if not is_changed or abs(math.log(now.ratio)) > abs(math.log(self._told)):
            self._told = now.ratio
        self.change = now


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
    known = np.square(winds).sum() / _SCATTER**2
    slope = (winds @ frequency) / _SCATTER**2 / (known + 1.0 / _SLOPE**2)
    left = frequency - slope * winds
    squares = _KNOWN_LIKE * _SCATTER**2 + np.square(left).sum()
    scatter = squares / (_KNOWN_LIKE + max(len(past) - 2, 0))
    apart = wind - middle[1]
    of_slope = apart**2 / (known * _SCATTER**2 / scatter + 1.0 / _SLOPE**2)
    variance = scatter * (1.0 / len(past) + 1.0 / _RECENT) + of_slope
    return middle[0] + slope * apart, math.sqrt(variance)
