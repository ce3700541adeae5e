# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Turbulence about means of the wind over a minute or an hour.

A station reports means over an interval and the largest gust in it, a mean over 3 s (WMO Guide to
Instruments, 5.8). The turbulence is scaled so that its own largest 3 s of intervals are, on
average, as far above the mean as the reported gusts; without gusts its deviation is that of IEC
61400-1. It does not change the means: its own are subtracted.
"""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.wind import REFERENCE_INTENSITY, Turbulence

_RATE = 10.0
"""Largest rate of the wind in [Hz]."""
LEAST_INTERVAL = 20.0
"""Interval [s] from which samples are means; at shorter ones they are the wind itself."""
_MOST = 4_000_000
_LEAST_RATE = 2.0
_BLOCK, _FADE = 131_072, 8_192
"""Samples of turbulence that are drawn at a time, and those over which one passes to the next."""
_GUST = 3.0


def can_be_filled(duration: float) -> bool:
    """Whether a record of a duration [s] has room for turbulence."""
    return duration * _LEAST_RATE <= _MOST


def usual_deviation(level: Floats) -> Floats:
    """Return the deviation of IEC 61400-1 about a mean speed [m/s]; less in a calm."""
    return np.asarray(REFERENCE_INTENSITY * (0.75 * level + 5.6) * np.minimum(level, 1.0))


def usual_gust(along: Floats, first: Ints, rate: float) -> float:
    """
    Return the mean of the largest gusts of some intervals, gusts being means over 3 s.

    Parameters
    ----------
    along
        Turbulence along the wind in its own deviation, (n,).
    first
        First sample of each interval, (m,).
    rate
        Samples per second [Hz].

    """
    within = max(round(_GUST * rate), 1)
    smooth = np.convolve(along, np.full(within, 1.0 / within), 'same')
    return max(float(np.maximum.reduceat(smooth, first).mean()), 0.5)


def turbulence_about_means(
    time: Floats, mean: Floats, gust: Floats | None, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """
    Draw turbulence about means of the wind.

    Parameters
    ----------
    time, mean
        Time of each mean [s], increasing, (n,), and velocity east, north, up [m/s], (n, 3), n at
        least 2.
    gust
        Largest speed in each interval [m/s], (n,), NaN where none is reported; or None.
    rng
        Source of the turbulence.

    Returns
    -------
    tuple
        Times [s], (m,), and velocities [m/s], (m, 3).

    """
    duration = float(time[-1] - time[0])
    rate = min(_RATE, _MOST / duration)
    fine = time[0] + np.arange(math.floor(duration * rate) + 1) / rate
    level = np.hypot(mean[:, 0], mean[:, 1])
    deviation = usual_deviation(level)
    between = np.stack([np.interp(fine, time, column) for column in mean.T], axis=1)
    typical = min(max(float(level.mean()), 1.0), 40.0)
    whole = max(len(fine), math.ceil(600.0 * rate))
    turbulence = Turbulence(typical, intensity=1.0 / typical)
    drawn = _long_record(turbulence, whole, rate, rng)[: len(fine)]
    # Means of the turbulence over the interval about each sample, which are subtracted.
    nearest = np.searchsorted(0.5 * (time[1:] + time[:-1]), fine)
    count = np.maximum(np.bincount(nearest, minlength=len(time)), 1)
    for column in drawn.T:
        about = np.bincount(nearest, weights=column, minlength=len(time)) / count
        column -= np.interp(fine, time, about)
    if gust is not None:
        largest = usual_gust(drawn[:, 0], np.unique(nearest, return_index=True)[1], rate)
        above = np.maximum(gust - level, 0.0) / largest
        deviation = np.where(np.isfinite(gust), above, deviation)
    drawn *= np.interp(fine, time, deviation)[:, None]
    heading = np.arctan2(between[:, 1], between[:, 0])
    cosine = np.cos(heading)
    sine = np.sin(heading)
    between[:, 0] += cosine * drawn[:, 0] - sine * drawn[:, 1]
    between[:, 1] += sine * drawn[:, 0] + cosine * drawn[:, 1]
    between[:, 2] += drawn[:, 2]
    return fine, between


def _long_record(
    turbulence: Turbulence, count: int, rate: float, rng: np.random.Generator
) -> Floats:
    """
    Draw turbulence of any length, (count, 3), in blocks, with the memory of one block.

    A block of hours has all of the spectrum. Where one passes to the next, the weights of the two
    are sine and cosine, which keeps the variance, as they are independent.
    """
    if count <= _BLOCK:
        return turbulence.record(count, rate, rng)
    drawn = np.zeros((count, 3))
    rising = np.sin(np.linspace(0.0, 0.5 * math.pi, _FADE))[:, None]
    for first in range(0, count - _FADE, _BLOCK - _FADE):
        block = turbulence.record(_BLOCK, rate, rng)
        if first > 0:
            block[:_FADE] *= rising
        block[-_FADE:] *= rising[::-1]
        part = drawn[first : first + _BLOCK]
        part += block[: len(part)]
    return drawn
