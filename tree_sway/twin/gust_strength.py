# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How strong the unknown forces on a tree are, by what its sensors measure beyond the model.

The law of `disturbance` has gusts of a usual strength. Wood, drag, shelter and weather make the
motion of a real tree smaller or larger by a factor of ten in its power, and a filter that expects
ten times the motion takes the noise of a sensor for sway.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.twin.waves import power_of, way_in

_BANDS = ((0.03, 0.25), (0.5, 2.2))
"""Slow and fast sway, frequencies over the first one of the tree [-]."""

_LEAST = 0.02
"""Least power measured in a band over that expected; more than expected is taken for that [-]."""

_LINES = 40
"""Lines of a band whose power is computed."""


class BeyondModel(NamedTuple):
    """
    What a sensor measured beyond the model to east and north, (n, 2), at equal steps.

    ``rows`` are those by displacement, rate and force of the coordinates, (2, 3, m), and ``noise``
    is the standard deviation of a sample's noise.
    """

    motion: Floats
    rows: Floats
    noise: float


class UsualLaw(NamedTuple):
    """
    The law whose strength is asked for.

    Stiffness [1/s^2] and damping [1/s] of the coordinates, (m,), covariance of their forces,
    (m, m), the time after which these have decayed to 1/e [s], the first frequency of the tree
    [Hz], and a step [s].
    """

    stiffness: Floats
    damping: Floats
    covariance: Floats
    time_constant: float
    frequency: float
    dt: float


def strength_of(sensors: Sequence[BeyondModel], law: UsualLaw) -> float:
    """
    Power of the unknown forces over the usual one [-].

    It is the geometric mean over slow and fast sway of the power measured, less that of the noise,
    over that expected.
    """
    logs = list[float]()
    for low, high in _BANDS:
        powers = [_powers(each, law, low, high) for each in sensors]
        measured, expected = np.sum(powers, axis=0).tolist()
        if expected:
            logs.append(math.log(min(max(measured / expected, _LEAST), 1.0)))
    return math.exp(sum(logs) / len(logs)) if logs else 1.0


def _powers(sensor: BeyondModel, law: UsualLaw, low: float, high: float) -> tuple[float, float]:
    """Power in a band that a sensor measured beyond its noise, and that expected."""
    count = len(sensor.motion)
    hertz = np.fft.rfftfreq(max(count, 1), law.dt)
    first, last = np.searchsorted(hertz, [low * law.frequency, high * law.frequency]).tolist()
    if first == last:
        return 0.0, 0.0
    window = np.sin(0.5 * np.pi * way_in(count))[:, None]
    waves = np.fft.rfft(window * (sensor.motion - sensor.motion.mean(axis=0)), axis=0)
    size = np.square(window).sum()
    noise = 2.0 * size * sensor.noise**2
    measured = (power_of(waves[first:last]).sum(axis=1) - noise).sum()

    lines = np.arange(first, last, max((last - first) // _LINES, 1))
    w = 2.0 * np.pi * hertz[lines][:, None]
    by_eta, by_rate, by_force = sensor.rows.swapaxes(0, 1)[:, :, None]
    response = 1.0 / (law.stiffness - w * w + 1j * w * law.damping)
    moved = (by_eta + 1j * w * by_rate) * response + by_force
    power = (moved @ law.covariance * moved.conj()).real.sum(axis=(0, 2))
    time = law.time_constant
    gusts = 2.0 * time / (1.0 + np.square(w[:, 0] * time))
    return measured, (last - first) / len(lines) * size / law.dt * (power @ gusts)
