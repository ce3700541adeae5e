# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Peaks of a spectrum, smoothed with the same relative width at every frequency."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from scipy import signal

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError

Band: TypeAlias = tuple[float, float] | None
"""Lowest and highest frequency to consider in [Hz]; all if None."""

WIDTH = 0.06
"""Half width of the average of the power, over the frequency [-]."""

_PROMINENCE = 1.5


def spectral_peaks(
    frequency: Floats, power: Floats, duration: float, band: Band
) -> tuple[Floats, Floats]:
    """
    Find the peaks of a spectrum within a band, rising, and the averaged power there.

    Power (m,), of any unit, is that of a record of a duration [s], at even frequencies [Hz] from
    0; it is averaged over `WIDTH` relative to the frequency on either side. In a given band
    without a peak the strongest point is returned. Raises a `FormatError` for no peak, or a band
    that the record does not reach.
    """
    low, high = band or (0.0, np.inf)
    low = max(low, 0.8 / duration)
    high = min(high, 0.9 * float(frequency[-1]))
    if low >= high:
        what = f'{duration:.3g} s sampled up to {frequency[-1]:.3g} Hz have no content in the band'
        raise FormatError(what, cure='record longer, sample faster, or name another band')
    grid = np.geomspace(low, high, 2 + int(np.log(high / low) / (0.25 * WIDTH)))
    total = np.concatenate([[0.0], np.cumsum(power)])
    left = np.searchsorted(frequency, grid - WIDTH * grid)
    right = np.maximum(np.searchsorted(frequency, grid + WIDTH * grid), left + 1)
    level = (total[right] - total[left]) / (right - left) + 1e-300
    at, _ = signal.find_peaks(np.log(level), prominence=np.log(_PROMINENCE))
    if band is not None and not len(at):
        at = np.array([np.argmax(level)])
    if not len(at):
        raise FormatError('no peak in its spectrum', cure='record longer, or pull farther')
    return grid[at], level[at]
