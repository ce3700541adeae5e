# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Winds to judge models in: a record, turbulence, and those that are hard on an estimate.

Each is the mean of every frame of 1/60 s in [m/s], (t, 3).

"""

from __future__ import annotations

import math

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.reference.measure import frame_means
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence

FRAME = 1.0 / 60.0

BEARING = math.radians(35.0)
"""Where winds blow to, from x towards y, so that no axis of a tree is favoured."""


def turbulent(mean_speed: float, seconds: float, seed: int) -> Floats:
    """Kaimal turbulence at 10 m about a mean speed in [m/s]."""
    velocity = simulate_turbulence(
        mean_speed, rate=60.0, duration=seconds, rng=np.random.default_rng(seed), height=10.0
    )
    return _turned(velocity)


def from_record(time: Floats, velocity: Floats, seconds: float, scale: float = 1.0) -> Floats:
    """Take the windiest so many seconds of a record, each sample so many times as strong."""
    means = scale * frame_means(time, velocity, FRAME)
    n = min(round(seconds / FRAME), len(means))
    run = np.convolve(np.linalg.norm(means, axis=1), np.ones(n), mode='valid')
    first = int(np.argmax(run))
    return means[first : first + n]


def hard_cases(seconds: float, first_frequency: float) -> dict[str, Floats]:
    """Make a gust, a step, a swing at a tree's first frequency [Hz], and a turn of the wind."""
    t = FRAME * (0.5 + np.arange(round(seconds / FRAME)))
    still, along = np.zeros_like(t), np.ones_like(t)
    rise = np.clip((t - 0.2 * seconds) / (0.4 * seconds), 0.0, 1.0)
    gust = 3.0 + 4.5 * (1.0 - np.cos(2.0 * np.pi * rise))
    turn = 0.5 * np.pi * np.clip((t - 0.4 * seconds) / 1.0, 0.0, 1.0)
    speeds = {
        'gust': (gust, still),
        'step': (np.where(t > 0.1 * seconds, 10.0, 0.0), still),
        'sine': (5.0 + 1.5 * np.sin(2.0 * np.pi * first_frequency * t), still),
        'turn': (7.0 * np.cos(turn), 7.0 * np.sin(turn)),
    }
    return {
        name: _turned(np.stack([u * along, v * along, still], axis=1))
        for name, (u, v) in speeds.items()
    }


def _turned(velocity: Floats) -> Floats:
    c, s = math.cos(BEARING), math.sin(BEARING)
    out: Floats = velocity @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return out
