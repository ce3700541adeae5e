# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ours beside engines of rigid bodies: same tree, wind and rate; error against the truth."""

from __future__ import annotations

from tree_sway.core.settings import Settings
from tree_sway.core.species import species_named
from tree_sway.core.tree import Tree
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.bench.frame_time import frame_times
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.compare.engines import run_engines
from tree_sway_lab.compare.mujoco_tree import FRAME, MujocoTree
from tree_sway_lab.compare.with_mujoco import DAMPING_RATIO, mujoco_tips, without_twist
from tree_sway_lab.model_names import simulator_called
from tree_sway_lab.tip_error import record_tips, roughness, tip_error
from tree_sway_lab.validation.winds import turbulent

MODELS = ('20', 'default', 'full')
_SECONDS = 5.0


def race_engines(tree: Tree | None = None, seconds: float = _SECONDS) -> list[Measured]:
    """
    Run models of ours beside MuJoCo, DART and Newton, those that are installed.

    The truth is MuJoCo at 32 steps per frame.

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
    tree = tree if tree is not None else bench_tree()
    wood = without_twist(species_named(tree.species))
    wind = turbulent(7.0, seconds, 1)
    truth = mujoco_tips(MujocoTree(tree, wood, DAMPING_RATIO), wind, 32)
    engines = run_engines(tree, wood, DAMPING_RATIO, wind)
    settings = Settings(damping_ratio=DAMPING_RATIO, gravity=0.0, in_leaf=False)
    models = {name: simulator_called(name, tree, wood, settings) for name in MODELS}
    runs = {name: record_tips(model, tree, wind, FRAME) for name, model in models.items()}
    spent = {
        name: 1e-9 * (each.step + each.place)
        for name, each in frame_times(models, tree, wind, FRAME).items()
    }
    runs |= {f'{name} at 1/60 s': run.tips for name, run in engines.items()}
    spent |= {f'{name} at 1/60 s': run.cost for name, run in engines.items()}
    rows = []
    for name, tips in runs.items():
        rows += [
            Measured(f'{name}, time of a frame', 1e6 * spent[name], 'us'),
            Measured(f'{name}, error over motion', tip_error(tree, tips, truth), '-'),
            Measured(f'{name}, roughness', roughness(tips, truth), '-'),
        ]
    rows += [
        Measured(f"{model}, {engine}'s time over its own", run.cost / spent[model], '-')
        for model in models
        for engine, run in engines.items()
    ]
    return rows
