# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a spectrum has peaks, seen with the same relative width at every frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy import signal

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError

Band: TypeAlias = tuple[float, float] | None
"""Lowest and highest frequency to look at in [Hz]; all if None."""

_PROMINENCE = 1.5


@dataclass(frozen=True)
class Spectrum:
    """Power (m,), of any unit, of a record of a duration [s], at even frequencies [Hz] from 0."""

    frequency: Floats
    power: Floats
    duration: float

    def peaks(self, band: Band, width: float, min_bins: int = 0) -> tuple[Floats, Floats]:
        """
        Find the peaks within a band, rising, and the averaged power there.

        Averaged is over a half ``width`` relative to the frequency, of ``min_bins`` at least.
        Within a given band without a peak it is its strongest point; raises a `FormatError` for no
        peak, or a band that the record does not reach.
        """
        low, high = band or (0.0, np.inf)
        low, high = max(low, 0.8 / self.duration), min(high, 0.9 * float(self.frequency[-1]))
        if low >= high:
            raise FormatError(
                f'{self.duration:.3g} s sampled up to {self.frequency[-1]:.3g} Hz hold nothing '
                f'in the band',
                cure='record longer, sample faster, or name another band',
            )
        grid = np.geomspace(low, high, 2 + int(np.log(high / low) / (0.25 * width)))
        level = self._level(grid, width, min_bins)
        at, _ = signal.find_peaks(np.log(level), prominence=np.log(_PROMINENCE))
        if band is not None and not len(at):
            at = np.array([np.argmax(level)])
        if not len(at):
            raise FormatError('no peak in its spectrum', cure='record longer, or in more wind')
        return grid[at], level[at]

    def _level(self, grid: Floats, width: float, min_bins: int) -> Floats:
        """Mean power around each frequency of a grid."""
        half = np.maximum(width * grid, 0.5 * min_bins * self.frequency[1])
        total = np.concatenate([[0.0], np.cumsum(self.power)])
        left = np.searchsorted(self.frequency, grid - half)
        right = np.maximum(np.searchsorted(self.frequency, grid + half), left + 1)
        level: Floats = (total[right] - total[left]) / (right - left) + 1e-300
        return level
