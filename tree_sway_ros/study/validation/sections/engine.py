# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""MuJoCo as a second judge: an engine that nobody here wrote, with weight, twist and wind."""

from __future__ import annotations

from functools import partial

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.study.compare.mujoco_tree import MujocoTree
from tree_sway_ros.study.compare.with_mujoco import mujoco_tips
from tree_sway_ros.study.tip_error import record_tips, tip_error
from tree_sway_ros.study.validation.judge import DAMPING_RATIO, Judge, SETTINGS, WOOD
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section
from tree_sway_ros.study.validation.sections.models import LIMITS, SPEEDS, tree_called
from tree_sway_ros.study.validation.winds import FRAME, turbulent

SEEDS = (1, 20)
"""Of the crooked trees."""

MORE_SEEDS = (16, 18)

PIECES, STEPS = 2, 32
"""Rigid pieces per segment, and steps per frame."""


def measure(effort: Effort) -> Section:
    """Run both references and the models in the same winds."""
    seeds = SEEDS + (MORE_SEEDS if effort.is_full else ())
    seconds = 8.0 if effort.is_full else 4.0
    cases = [(seed, speed) for seed in seeds for speed in SPEEDS]
    found = effort.each(partial(_judged, seconds=seconds), cases)
    checks = [Check('`segments`, largest tip error', max(e['segments'] for e in found), high=0.02)]
    checks += [
        Check(f'`{name}`, largest tip error', max(errors[name] for errors in found), high=limit)
        for name, limit in LIMITS.items()
    ]
    rows = [
        [tree_called(str(seed)).name, f'{speed:g} m/s', *(f'{e:.3f}' for e in errors.values())]
        for (seed, speed), errors in zip(cases, found, strict=True)
    ]
    text = (
        f'Tip error over tip motion against MuJoCo: {PIECES} rigid pieces per segment, each on '
        'two hinges across it and one along it with the springs of bending and twist, with weight,'
        f' our law of drag on each piece, and {STEPS} steps per frame; crooked trees in '
        f'{seconds:g} s of simulated wind. `segments` has 4 pieces and 8 steps per frame: what '
        'it differs by is mostly that joints half as far apart are less stiff.'
    )
    head = ['tree', 'wind', *found[0]]
    return Section('MuJoCo as a second judge', text, checks, markdown_table(head, rows))


def _judged(case: tuple[int, float], seconds: float) -> dict[str, float]:
    seed, speed = case
    tree, wind = tree_called(str(seed)), turbulent(speed, seconds, seed)
    judge = Judge(tree)
    truth = mujoco_tips(_engine(tree), wind, STEPS)
    models = {'modes 12': judge.model('modes', 12), 'coupled': judge.model('coupled')}
    tips: dict[str, Floats] = {
        'segments': record_tips(judge.truth, tree, wind, FRAME, substeps=judge.substeps)
    }
    tips |= {name: record_tips(model, tree, wind, FRAME) for name, model in models.items()}
    return {name: tip_error(tree, each, truth) for name, each in tips.items()}


def _engine(tree: Tree) -> MujocoTree:
    return MujocoTree(
        tree, WOOD, DAMPING_RATIO, match_beam=False, gravity=SETTINGS.gravity, pieces=PIECES
    )
