# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Faults of motion sensors: what a cable, a clock, a driver or a hand does to their samples."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tree_sway_lab.twin.simulated_sensor import SensedMotion

FROM = 90.0
"""Time in [s] from which a fault is there that begins later than its sensor."""

_SPIKE = 8.0 * 9.80665
_G = 9.80665

Fault = Callable[[SensedMotion, np.random.Generator], SensedMotion]


def _spikes(motion: SensedMotion, rng: np.random.Generator) -> SensedMotion:
    """Throw one sample in a hundred off by 8 g, in any direction."""
    away = rng.normal(size=motion.acceleration.shape)
    away *= _SPIKE / np.linalg.norm(away, axis=1, keepdims=True)
    away[rng.random(len(away)) > 0.01] = 0.0
    return motion._replace(acceleration=motion.acceleration + away)


def _stuck(motion: SensedMotion, rng: np.random.Generator) -> SensedMotion:
    """Repeat the last numbers."""
    last = int(np.searchsorted(motion.time, FROM))
    acceleration, rate = motion.acceleration.copy(), motion.rate.copy()
    acceleration[last:], rate[last:] = acceleration[last], rate[last]
    return motion._replace(acceleration=acceleration, rate=rate)


def _noise(motion: SensedMotion, rng: np.random.Generator) -> SensedMotion:
    """Measure noise, as with a broken solder joint."""
    later = motion.time >= FROM
    acceleration, rate = motion.acceleration.copy(), motion.rate.copy()
    acceleration[later] += rng.normal(size=(int(later.sum()), 3))
    rate[later] += 0.3 * rng.normal(size=(int(later.sum()), 3))
    return motion._replace(acceleration=acceleration, rate=rate)


def _loose(motion: SensedMotion, rng: np.random.Generator) -> SensedMotion:
    """Fall off the belt, and hang another way."""
    later = motion.time >= FROM
    acceleration, rate = motion.acceleration.copy(), motion.rate.copy()
    acceleration[later] = acceleration[later][:, [1, 2, 0]]
    rate[later] = rate[later][:, [1, 2, 0]]
    return motion._replace(acceleration=acceleration, rate=rate)


def _late(lag: float) -> Fault:
    """Stamp samples by a lag in [s] later than they are."""
    return lambda motion, rng: motion._replace(time=motion.time + lag)


FIRST, LIVE = 'first ', 'live '
"""
What names of faults begin with: those that the first of several sensors alone has, and those of
samples that come as they are measured, whatever their stamps.
"""

WAY = 0.02
"""Time [s] in which a live sample comes."""

FAULTS: dict[str, Fault] = {
    'none': lambda motion, rng: motion,
    'spikes': _spikes,
    'stuck': _stuck,
    'noise': _noise,
    'loose': _loose,
    'silent': lambda motion, rng: SensedMotion(*(each[motion.time < FROM] for each in motion)),
    'opposite': lambda motion, rng: motion._replace(acceleration=-motion.acceleration),
    'left-handed': lambda motion, rng: motion._replace(
        acceleration=motion.acceleration * [1.0, -1.0, 1.0], rate=motion.rate * [1.0, -1.0, 1.0]
    ),
    'units': lambda motion, rng: motion._replace(
        acceleration=motion.acceleration / _G, rate=np.degrees(motion.rate)
    ),
    'late 0.15': lambda motion, rng: motion._replace(time=motion.time + 0.15),
    **{f'late {lag:g}': _late(lag) for lag in (0.2, 0.5, 1.0, 2.0, -0.5, -1.0, -2.0)},
    **{f'{FIRST}late {lag:g}': _late(lag) for lag in (0.5, 1.0, -0.5, -1.0)},
    **{f'{LIVE}{lag:g}': _late(lag) for lag in (0.0, 0.2, 0.5, 1.0, -0.2, -0.5, -1.0)},
    'drift 200 ppm': lambda motion, rng: motion._replace(time=motion.time * 1.0002),
    'bias 5 deg/s': lambda motion, rng: motion._replace(rate=motion.rate + np.radians(5.0)),
}
"""Faults by their names."""
