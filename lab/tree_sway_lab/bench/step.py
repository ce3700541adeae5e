# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One step of a tree, timed: the compiled kernels against the same formulas in plain numpy.

Both go through the same gusts; they must agree before anything is timed. Rounds alternate, so that
whatever else the machine does meets both.

"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import time

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import TreeSwayError

_DT = 1.0 / 60.0
_STEPS_A_ROUND, _TWIN_STEPS_A_ROUND = 200, 10
_STEPS_TO_AGREE = 120
#: Largest difference of any number of the pose block, [m] and [-].
_AGREEMENT = 1e-9


@dataclass(frozen=True)
class StepTiming:
    """
    What one step costs, solving and placing, in [s].

    Parameters
    ----------
    model
        Model.
    median, minimum
        Times of the compiled step.
    twin_median, twin_minimum
        Times of the step in numpy.
    difference
        Largest difference of the two pose blocks over the steps that were compared.

    """

    model: str
    median: float
    minimum: float
    twin_median: float
    twin_minimum: float
    difference: float

    @property
    def ratio(self) -> float:
        """How many times faster than numpy, by the medians."""
        return self.twin_median / self.median


def time_steps(tree: Tree, model: int | str, rounds: int) -> StepTiming:
    """
    Time per step of a tree.

    Parameters
    ----------
    tree
        The tree; no twig of it copies another.
    model
        Model.
    rounds
        Number of rounds of 200 steps.

    Returns
    -------
    StepTiming
        Medians and minima over all steps.

    Raises
    ------
    TreeSwayError
        If the two disagree, so that there is nothing to compare.

    """
    simulator = make_simulator(tree, model=model)
    twin = make_simulator(tree, settings=simulator.settings, plain=True)
    winds = gusts(_STEPS_A_ROUND)
    poses = np.zeros((tree.n_segments, 7))
    difference = _agree(simulator, twin, winds, poses)

    def own_step(wind: Floats) -> None:
        simulator.step(wind, _DT)
        simulator.place(poses)

    def twin_step(wind: Floats) -> None:
        twin.step(wind, _DT)
        twin.place(poses)

    own_step(winds[0])
    own: list[float] = []
    others: list[float] = []
    for _ in range(rounds):
        own += _timed(own_step, winds)
        others += _timed(twin_step, winds[:_TWIN_STEPS_A_ROUND])
    medians = float(np.median(own)), float(np.median(others))
    return StepTiming(str(model), medians[0], min(own), medians[1], min(others), difference)


def gusts(count: int) -> Floats:
    """Wind of a gusty day around 8 m/s, the same in every run, (count, 3)."""
    rng = np.random.default_rng(0)
    return np.array([8.0, 0.0, 0.0]) + rng.normal(0.0, [2.0, 1.5, 0.5], (count, 3))


def _agree(simulator: SwaySimulator, twin: SwaySimulator, winds: Floats, poses: Floats) -> float:
    """Largest difference over some steps; raises where it is more than rounding."""
    difference = 0.0
    for wind in winds[:_STEPS_TO_AGREE]:
        simulator.step(wind, _DT)
        twin.step(wind, _DT)
        difference = max(difference, float(np.abs(simulator.place(poses) - twin.place()).max()))
    if not difference <= _AGREEMENT:
        raise TreeSwayError(
            f'the kernels and their numpy twin differ by {difference:.2e}',
            where=simulator.model,
            cure=f'find out which is wrong; {_AGREEMENT:g} is allowed',
        )
    return difference


def _timed(step: Callable[[Floats], object], winds: Floats) -> list[float]:
    """Time of each step in [s]."""
    times = []
    for wind in winds:
        begin = time.perf_counter()
        step(wind)
        times.append(time.perf_counter() - begin)
    return times
