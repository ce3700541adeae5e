# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A scene in a wind, frame by frame, for commands that draw it."""

from __future__ import annotations

from collections.abc import Iterator

from tree_sway.commands import bar
from tree_sway.core.scene import Run, Simulator
from tree_sway.core.wind import FASTEST_WIND, WindGate, WindIntake
from tree_sway.simulation import blow, WindSource

_STEPS_PER_SECOND = 60.0


def swaying(
    simulator: Simulator, wind: WindSource, rate: float, seconds: float, what: str = 'swaying'
) -> Iterator[None]:
    """
    Sway a scene, at least 60 steps per second, and yield after each frame.

    Parameters
    ----------
    simulator, wind
        Scene at rest, and the samples of its wind.
    rate
        Frames per second [Hz].
    seconds
        Length of all frames [s].
    what
        Label of the progress.

    """
    steps = max(1, round(_STEPS_PER_SECOND / rate))
    intake = WindIntake(gate=WindGate(max_speed=FASTEST_WIND))
    run = Run(simulator, rate * steps, intake=intake)
    tick = 0
    for _ in bar(range(max(1, round(seconds * rate))), what):
        for _ in range(steps):
            tick += 1
            blow(run, wind, tick * run.period)
        yield
