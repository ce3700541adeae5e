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

_SPEED = 6.0
_DT = 1.0 / 60.0


def in_breeze(
    simulator: SwaySimulator, seconds: float, sample: Callable[[], Floats]
) -> list[Floats]:
    """Run a simulator for a time [s] and return a sample of each frame; it is then set back."""
    before = simulator.state()
    samples = []
    rng = np.random.default_rng(7)
    wind = simulate_turbulence(_SPEED, rate=1.0 / _DT, duration=seconds, rng=rng)
    for number, each in enumerate(wind):
        simulator.step(each, _DT)
        if number % round(1.0 / (_DT * RATE)) == 0:
            samples.append(sample())
    simulator.set_state(before)
    return samples
