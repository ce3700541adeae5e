# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One model on one kind of tree in one wind: error, roughness and the first frame after a step.

The three are given together: a model can be near the truth and shake, or be smooth and wrong.

"""

from __future__ import annotations

from functools import lru_cache
import importlib.util
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.tree import Tree
from tree_sway_lab.bench.frame_time import frame_times
from tree_sway_lab.compare.engines import MODULES, run_engines
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.model_names import simulator_called
from tree_sway_lab.tip_error import record_tips, roughness, tip_error
from tree_sway_lab.validation.truth import (
    DAMPING_RATIO,
    FINE,
    Fineness,
    GRAVITY,
    SETTINGS,
    true_tips,
    WOOD,
)
from tree_sway_lab.validation.winds import FRAME, STEP_FRAME, wind_called

SECONDS = 6.0
"""Duration of turbulence [s]."""

MUJOCO = 'MuJoCo'
"""Name of the engine in place of a model: one joint a segment, one step a frame."""


class Trial(NamedTuple):
    """
    What a model did.

    Parameters
    ----------
    kind, wind, model
        Tree, wind and model of the run.
    error
        Distance of tips from the truth's over their motion from rest, root mean square, in [-].
    roughness
        Second difference of the tips over time, root mean square, over the truth's, in [-].
    jump, true_jump
        Largest move of a tip in the first frame after the wind rises from 5 to 10 m/s in [m]; nan
        in other winds.
    stride, true_stride
        Largest move of a tip in any frame in [m].
    lowest, true_lowest
        Height of the lowest tip in any frame over the root in [m].
    clamped
        How many loads or steps the model clamped.
    cost
        CPU time to step and to place a frame in [us], which one frame in ten stays below; of
        MuJoCo without the wind's force, which is no part of it.

    """

    kind: str
    wind: str
    model: str
    error: float
    roughness: float
    jump: float
    true_jump: float
    stride: float
    true_stride: float
    lowest: float
    true_lowest: float
    clamped: int
    cost: float


def tried(kind: str, wind: str, model: str, fineness: Fineness = FINE) -> Trial:
    """
    Run a model beside the truth, as long as there is a truth (`true_tips`).

    Parameters
    ----------
    kind
        A kind of tree, as of `kind_called`.
    wind
        A wind, as of `wind_called`.
    model
        A model, as of `simulator_called`, or `MUJOCO`.
    fineness
        Fineness of the truth.

    """
    tree, blowing = kind_called(kind), wind_called(wind, SECONDS)
    truth = true_tips(tree, blowing, fineness)
    run = _run_of_mujoco if model == MUJOCO else _run_of_ours
    tips, cost, clamped = run(kind, model, blowing)
    tips = tips[: len(truth)]
    strides, true_strides = _strides(tips), _strides(truth)
    jumps = math.nan, math.nan
    if wind == 'step' and len(strides) >= STEP_FRAME:
        jumps = float(strides[STEP_FRAME - 1]), float(true_strides[STEP_FRAME - 1])
    return Trial(
        kind,
        wind,
        model,
        tip_error(tree, tips, truth),
        roughness(tips, truth),
        *jumps,
        float(strides.max()),
        float(true_strides.max()),
        float(tips[:, :, 2].min() - tree.start[0, 2]),
        float(truth[:, :, 2].min() - tree.start[0, 2]),
        clamped,
        cost,
    )


def has_mujoco() -> bool:
    """Whether MuJoCo is installed."""
    return importlib.util.find_spec(MODULES[MUJOCO]) is not None


def _run_of_ours(kind: str, model: str, wind: Floats) -> tuple[Floats, float, int]:
    """Tips (t, b, 3) in [m], cost [us] and clamped loads of a model in a wind."""
    tree, simulator = kind_called(kind), _simulator(kind, model)
    simulator.reset()
    before = simulator.counts.clamped
    tips = record_tips(simulator, tree, wind, FRAME)
    clamped = simulator.counts.clamped - before
    return tips, frame_cost(simulator, tree, wind), clamped


def _run_of_mujoco(kind: str, _: str, wind: Floats) -> tuple[Floats, float, int]:
    """Tips (t, b, 3) in [m] and cost [us] of MuJoCo with a joint a segment and a step a frame."""
    runs = run_engines(
        kind_called(kind), WOOD, DAMPING_RATIO, wind, gravity=GRAVITY, match_beam=False,
        names=(MUJOCO,),
    )  # fmt: skip
    return runs[MUJOCO].tips, 1e6 * runs[MUJOCO].cost, 0


@lru_cache(maxsize=4)
def _simulator(kind: str, model: str) -> SwaySimulator:
    return judged_simulator(model, kind_called(kind))


def judged_simulator(model: str, tree: Tree) -> SwaySimulator:
    """Make a simulator of a tree of `WOOD` on a model, as of `simulator_called`."""
    return simulator_called(model, tree, WOOD, SETTINGS)


def frame_cost(simulator: SwaySimulator, tree: Tree, wind: Floats) -> float:
    """CPU time to step and to place a frame in [us], which one frame in ten stays below."""
    return 1e-3 * sum(frame_times({'ours': simulator}, tree, wind, FRAME)['ours'])


def _strides(tips: Floats) -> Floats:
    """Largest move of a tip in each frame but the first in [m], (t - 1,)."""
    out: Floats = np.linalg.norm(np.diff(tips, axis=0), axis=2).max(axis=1)
    return out
