# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A computed sway against a measured one: correlation, lag, amplitude and spectrum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import correlate, lfilter, welch

from tree_sway.core.arrays import Floats

LONGEST_LAG = 5.0
"""Largest lag that is looked for, to either side [s]."""

BANDS = ((0.0, 0.5), (0.5, 1.5), (1.5, 4.0), (4.0, 10.0))
"""Bands of the spectrum over the first frequency: gusts, the sway, and two above it."""

_SEGMENT = 20.0
"""Length of the segments of the spectrum in periods of the sway."""


@dataclass(frozen=True)
class SwayComparison:
    """
    How a computed sway differs from a measured one, about their means, over both axes.

    Parameters
    ----------
    r
        Correlation at the best lag [-].
    lag
        Time by which the computed sway is behind the measured one at its best [s].
    error
        Root mean square difference without a lag, over the measured motion [-].
    rms
        Root mean square of the computed motion over that of the measured one [-].
    bands
        Power of the computed motion over that of the measured one in each of `BANDS` [-]; not a
        number above the highest measured frequency.

    """

    r: float
    lag: float
    error: float
    rms: float
    bands: tuple[float, ...]


def compare_sway(
    computed: Floats, measured: Floats, rate: float, frequency: float
) -> SwayComparison:
    """
    Compare two sways of the same times.

    Parameters
    ----------
    computed, measured
        Displacement in [m], (n, k), one column per axis.
    rate
        Samples per second in [Hz].
    frequency
        First frequency of the tree in [Hz].

    """
    found = computed - computed.mean(axis=0)
    wanted = measured - measured.mean(axis=0)
    size = float(np.sqrt(np.square(wanted).mean()))
    most = min(round(LONGEST_LAG * rate), len(found) // 4)
    rs = _correlations(found, wanted, most)
    best = int(np.argmax(rs))
    return SwayComparison(
        float(rs[best]),
        (best - most) / rate,
        float(np.sqrt(np.square(found - wanted).mean())) / size,
        float(np.sqrt(np.square(found).mean())) / size,
        _band_ratios(found, wanted, rate, frequency),
    )


def low_passed(wind: Floats, frequency: float, rate: float) -> Floats:
    """
    Low-pass the square of a wind, along it, at a frequency.

    Parameters
    ----------
    wind
        Wind at equal steps in [m/s], (n, 3).
    frequency, rate
        The frequency, and the samples per second, in [Hz].

    Returns
    -------
    Floats
        Wind times its speed, both horizontal, in [m^2/s^2], (n, 2).

    """
    keep = float(np.exp(-2.0 * np.pi * frequency / rate))
    squared = np.linalg.norm(wind, axis=1, keepdims=True) * wind[:, :2]
    return np.asarray(lfilter([1.0 - keep], [1.0, -keep], squared, axis=0))


def _correlations(found: Floats, wanted: Floats, most: int) -> Floats:
    """Correlation of a motion with another one that is earlier by -most to most samples."""
    n = len(found)
    lags = np.arange(-most, most + 1)
    axes = zip(found.T, wanted.T, strict=True)
    products = np.sum([correlate(late, early, method='fft') for late, early in axes], axis=0)
    late_power = _power_until(found)
    early_power = _power_until(wanted)
    power = (late_power[n + np.minimum(lags, 0)] - late_power[np.maximum(lags, 0)]) * (
        early_power[n - np.maximum(lags, 0)] - early_power[np.maximum(-lags, 0)]
    )
    return np.asarray(products[n - 1 + lags] / np.sqrt(np.maximum(power, 1e-300)))


def _power_until(motion: Floats) -> Floats:
    """Sum of the squares before each sample of a motion, and of all of them, (n + 1,)."""
    return np.append(0.0, np.square(motion).sum(axis=1).cumsum())


def _band_ratios(
    found: Floats, wanted: Floats, rate: float, frequency: float
) -> tuple[float, ...]:
    length = min(len(found), max(round(_SEGMENT * rate / frequency), 8))
    at, computed = welch(found, rate, nperseg=length, axis=0)
    _, measured = welch(wanted, rate, nperseg=length, axis=0)
    ratios = []
    for low, high in BANDS:
        rows = (at > low * frequency) & (at <= high * frequency)
        is_measured = high * frequency <= 0.5 * rate and rows.any()
        power = float(measured[rows].sum()) if is_measured else 0.0
        ratios.append(float(computed[rows].sum()) / power if power > 0.0 else float('nan'))
    return tuple(ratios)
