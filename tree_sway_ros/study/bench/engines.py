# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ours against engines of rigid bodies: same tree, wind and rate; error against the truth."""

from __future__ import annotations

import importlib.util

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.reference.measure import frame_means
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import MissingDependencyError
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.study.bench.measured import Measured
from tree_sway_ros.study.chart.fidelity import simulated_wind
from tree_sway_ros.study.compare.mujoco_tree import MujocoTree
from tree_sway_ros.study.compare.with_mujoco import (
    compare_with_mujoco,
    DAMPING_RATIO,
    FRAME,
    mujoco_tips,
    without_twist,
)
from tree_sway_ros.study.tip_error import tip_error
from tree_sway_ros.tools.progress import bar

_SECONDS = 5.0


def race_engines(tree: Tree | None = None, seconds: float = _SECONDS) -> list[Measured]:
    """
    Run models of ours beside MuJoCo, and beside DART where it is installed.

    Parameters
    ----------
    tree
        The tree; the benchmark's of 726 segments if None.
    seconds
        How long, in a simulated wind.

    Returns
    -------
    list of Measured
        CPU per frame in [us], errors of the tips over their motion, and ratios.

    Raises
    ------
    MissingDependencyError
        If MuJoCo is not installed.

    """
    if importlib.util.find_spec('mujoco') is None:
        raise MissingDependencyError(
            'the race needs MuJoCo, which is not installed', cure='pip install mujoco'
        )
    tree = tree if tree is not None else bench_tree()
    time, velocity = simulated_wind(seconds, seed=1)
    wind = frame_means(time, velocity, FRAME)[: round(seconds / FRAME)]
    rows, engine = [], np.zeros(2)
    for model in bar(('wind_basis', 'modes'), 'models against MuJoCo'):
        told = compare_with_mujoco(tree, species_named(tree.species), wind, model=model)
        rows += [
            Measured(f'{model}, solve and place', 1e6 * told.cost * FRAME, 'us'),
            Measured(f'{model}, error over motion', told.error, '-'),
            Measured(f"{model}, MuJoCo's time over its own", told.speed_up, '-'),
        ]
        engine[:] = told.mujoco_cost, told.error_at_60
    rows += [
        Measured('MuJoCo at 1/60 s', float(1e6 * engine[0] * FRAME), 'us'),
        Measured('MuJoCo at 1/60 s, error over motion', float(engine[1]), '-'),
    ]
    return rows + (_dart(tree, wind) if importlib.util.find_spec('dartpy') else [])


def _dart(tree: Tree, wind: Floats) -> list[Measured]:
    """Run DART on the same bodies, behind the same truth."""
    from tree_sway_ros.study.compare.dart_tree import DartTree

    wood = without_twist(species_named(tree.species))
    truth = mujoco_tips(MujocoTree(tree, wood, DAMPING_RATIO), wind, 32)
    tips, cost = DartTree(MujocoTree(tree, wood, DAMPING_RATIO, even=False), FRAME).race(wind)
    return [
        Measured('DART at 1/60 s', 1e6 * cost, 'us'),
        Measured('DART at 1/60 s, error over motion', tip_error(tree, tips, truth), '-'),
    ]
