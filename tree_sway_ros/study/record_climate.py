# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a wind that is known in advance, as the models' errors are estimated from them."""

from __future__ import annotations

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.wind.climate import WindClimate


def climate_of_samples(velocity: Floats, rate: float) -> WindClimate:
    """
    Take the statistics of a record.

    Parameters
    ----------
    velocity
        Wind in [m/s], (n, 2) or (n, 3).
    rate
        Samples per second in [Hz].

    """
    speed = np.linalg.norm(velocity, axis=1)
    load = speed[:, None] * velocity[:, :2]
    around = load - load.mean(axis=0)
    largest = np.argmax(around.std(axis=0))
    return WindClimate(
        load.mean(axis=0),
        around.T @ around / len(load),
        float(speed.mean()),
        _integral_time(around[:, largest], rate),
        *_beat(around[:, largest], rate),
    )


def _integral_time(signal: Floats, rate: float) -> float:
    """Integral of the autocorrelation up to its first zero in [s], at least one sample."""
    n = len(signal)
    spectrum = np.abs(np.fft.rfft(signal, 2 * n)) ** 2
    correlation = np.fft.irfft(spectrum)[: n // 2]
    if not correlation[0] > 0.0:
        return 1.0 / rate
    correlation /= correlation[0]
    below = np.flatnonzero(correlation <= 0.0)
    end = int(below[0]) if len(below) else len(correlation)
    return max(float(correlation[:end].sum()) / rate, 1.0 / rate)


_FEWEST_BEATS = 4
"""Swings of a record below which its slowest gusts would pass for a beat."""


def _beat(signal: Floats, rate: float) -> tuple[float, float]:
    """Frequency that a signal swings at most in [Hz], and the share of its variance there [-]."""
    n = len(signal)
    power = np.abs(np.fft.rfft(signal * np.hanning(n))) ** 2
    total = float(power.sum())
    if len(power) <= _FEWEST_BEATS + 2 or not total > 0.0:
        return 1.0, 0.0
    peak = int(np.argmax(power))
    if peak < _FEWEST_BEATS:
        return 1.0, 0.0
    return peak * rate / n, float(power[peak - 2 : peak + 3].sum()) / total
