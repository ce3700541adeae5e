# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Winds to judge models in: a record, turbulence, and those that are hard on an estimate.

Each is the mean of every frame of 1/60 s in [m/s], (t, 3).

"""

from __future__ import annotations

import math
import re

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.wind import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway_lab.frame_means import frame_means

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
    """Take the windiest seconds of a record, each sample scaled."""
    means = scale * frame_means(time, velocity, FRAME)
    n = min(round(seconds / FRAME), len(means))
    run = np.convolve(np.linalg.norm(means, axis=1), np.ones(n), mode='valid')
    first = int(np.argmax(run))
    return means[first : first + n]


STEP_FRAME = 360
"""First frame of the stronger wind in the wind called ``step``."""

_NAMED = ('seconds', 'step', 'up', 'reversal', 'gust', 'turn', 'sine 0.8')


def wind_called(name: str, seconds: float, seed: int = 1) -> Floats:
    """
    Make a wind to judge by.

    Parameters
    ----------
    name
        A mean speed in [m/s], of turbulence; ``seconds``, means of 1 s of turbulence of 9 m/s;
        ``step``, 5 m/s for 6 s, then 10 for 2 s; ``up``, turbulence of 6 m/s straight up;
        ``reversal``, 8 m/s that goes over to -8 within 1 s; ``gust``, from 3 to 12 m/s and back;
        ``turn``, 7 m/s that turns by 90 degrees within 1 s; ``sine 0.8``, 5 m/s with gusts of 1.5
        at 0.8 Hz.
    seconds
        How long all but ``step`` are in [s].
    seed
        Seed of the turbulence.

    Raises
    ------
    ParameterError
        If there is no such wind.

    """
    frames = round(seconds / FRAME)
    if name == 'seconds':
        means = turbulent(9.0, math.ceil(seconds), seed).reshape(-1, 60, 3).mean(axis=1)
        return np.repeat(means, 60, axis=0)[:frames]
    if name == 'up':
        along = simulate_turbulence(
            6.0, rate=60.0, duration=seconds, rng=np.random.default_rng(seed), height=10.0
        )
        out: Floats = along[:, [2, 1, 0]] * [-1.0, 1.0, 1.0]
        return out
    if name == 'turn':
        angle = 0.5 * np.pi * np.clip(FRAME * np.arange(frames) - 0.4 * seconds, 0.0, 1.0)
        return _turned(7.0 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1))
    speed = _speeds(name, frames)
    if speed is not None:
        return _turned(speed[:, None] * np.array([1.0, 0.0, 0.0]))
    if re.fullmatch(r'\d+(\.\d+)?', name) and 0.0 < float(name) <= 100.0:
        mean = float(name)
        return turbulent(min(mean, 40.0), seconds, seed) * max(mean / 40.0, 1.0)
    raise ParameterError(
        f"no wind '{name}'", where='--wind',
        cure=f'give a speed of at most 100 m/s, or one of: {", ".join(_NAMED)}',
    )  # fmt: skip


def _speeds(name: str, frames: int) -> Floats | None:
    """Speed of a wind of one direction in each frame in [m/s], if the wind is one of these."""
    frame = np.arange(frames)
    if name == 'step':
        speed = 5.0 * np.clip(np.arange(STEP_FRAME + 120) / 120.0, 0.0, 1.0)
        speed[STEP_FRAME:] = 10.0
        return speed
    if name == 'reversal':
        return 8.0 * np.clip(frames - 2.0 * frame, -60.0, 60.0) / 60.0
    if name == 'gust':
        rise = np.clip((frame / frames - 0.2) / 0.4, 0.0, 1.0)
        return 3.0 + 4.5 * (1.0 - np.cos(2.0 * np.pi * rise))
    if found := re.fullmatch(r'sine (\d+(?:\.\d+)?)', name):
        return 5.0 + 1.5 * np.sin(2.0 * np.pi * float(found[1]) * FRAME * frame)
    return None


def _turned(velocity: Floats) -> Floats:
    c, s = math.cos(BEARING), math.sin(BEARING)
    out: Floats = velocity @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return out
