# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind of animations in files: a gusty breeze, always the same."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.wind import simulate_turbulence

RATE = 15
"""Frames per second."""

SPEED = 6.0
"""Usual mean speed [m/s]."""

SECONDS = {'.glb': 20.0, '.usda': 10.0, '.usdz': 10.0}
"""Length of the animation in a file of a suffix [s]."""

_DT = 1.0 / 60.0
_BLENDED = round(2.0 / _DT)
"""Number of steps in which the end of the wind becomes its beginning."""


def in_breeze(
    simulator: SwaySimulator,
    seconds: float,
    sample: Callable[[], Floats],
    speed: float = SPEED,
) -> list[Floats]:
    """
    Run a simulator in a wind that begins again after a time [s]; it is then set back.

    A sample of each frame is returned, from when the rest is forgotten; the last is the first.
    """
    before = simulator.state()
    duration = seconds + _BLENDED * _DT
    wind = simulate_turbulence(speed, rate=1.0 / _DT, duration=duration, rng=7)
    wind, behind = np.split(wind, [-_BLENDED])
    wind[:_BLENDED] += np.linspace(1.0, 0.0, _BLENDED)[:, None] * (behind - wind[:_BLENDED])
    for each in wind:
        simulator.step(each, _DT)
    samples = []
    for number, each in enumerate(wind):
        simulator.step(each, _DT)
        if number % round(1.0 / (_DT * RATE)) == 0:
            samples.append(sample())
    simulator.set_state(before)
    return [*samples, samples[0]]
