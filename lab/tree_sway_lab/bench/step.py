# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One step of a tree, solved and placed, timed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import time

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import Tree

_DT = 1.0 / 60.0
_STEPS_A_ROUND = 200


@dataclass(frozen=True)
class StepTiming:
    """
    What one step costs, solving and placing, in [s].

    Parameters
    ----------
    model
        Model.
    median, minimum
        Times of the step.

    """

    model: str
    median: float
    minimum: float


def time_steps(tree: Tree, model: int | str, rounds: int) -> StepTiming:
    """Time the steps of a tree on a model, in rounds of 200 steps."""
    simulator = make_simulator(tree, model=model)
    winds = gusts(_STEPS_A_ROUND)
    poses = np.zeros((tree.n_segments, 7))

    def step(wind: Floats) -> None:
        simulator.step(wind, _DT)
        simulator.place(poses)

    step(winds[0])
    own = [each for _ in range(rounds) for each in _timed(step, winds)]
    return StepTiming(str(model), float(np.median(own)), min(own))


def gusts(count: int) -> Floats:
    """Wind of a gusty day around 8 m/s, the same in every run, (count, 3)."""
    rng = np.random.default_rng(0)
    return np.array([8.0, 0.0, 0.0]) + rng.normal(0.0, [2.0, 1.5, 0.5], (count, 3))


def _timed(step: Callable[[Floats], object], winds: Floats) -> list[float]:
    """Time of each step in [s]."""
    times = []
    for wind in winds:
        begin = time.perf_counter()
        step(wind)
        times.append(time.perf_counter() - begin)
    return times
