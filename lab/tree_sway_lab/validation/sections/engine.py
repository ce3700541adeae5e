# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The models against MuJoCo, an independent engine, with weight, twist and wind."""

from __future__ import annotations

from tree_sway_lab.compare.mujoco_tree import MujocoTree
from tree_sway_lab.compare.with_mujoco import mujoco_tips
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.tip_error import record_tips, roughness, tip_error
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.trial import judged_simulator
from tree_sway_lab.validation.truth import DAMPING_RATIO, FINE, GRAVITY, true_tips, WOOD
from tree_sway_lab.validation.winds import FRAME, wind_called

JUDGED, MORE = ('crooked 1', 'crooked 20', 'palm'), ('crooked 16', 'crooked 18', 'shrub')
WINDS, SECONDS = ('3', '9'), 4.0
LIMITS = {'every segment': 0.02, 'default': 0.04, 'full': 0.03}

PIECES, STEPS = 2, 32
"""Rigid pieces per segment, and steps per frame."""


def measure(effort: Effort) -> Section:
    """Run both references and the models in the same winds."""
    kinds = JUDGED + (MORE if effort.is_full else ())
    cases = [(kind, wind) for kind in kinds for wind in WINDS]
    found = effort.each(judged, cases)
    checks = [
        Check(f'`{name}`, largest tip error', max(each[name][0] for each in found), high=limit)
        for name, limit in LIMITS.items()
    ]
    rows = [
        [kind, f'{wind} m/s', *(f'{error:.3f}, {rough:.2f}' for error, rough in each.values())]
        for (kind, wind), each in zip(cases, found, strict=True)
    ]
    text = (
        f'Tip error over tip motion and roughness against MuJoCo: {PIECES} rigid pieces per '
        'segment, each on two hinges across it and one along it with the springs of bending and '
        f'twist, with weight, our law of drag on each piece, and {STEPS} steps per frame, in '
        f'{SECONDS:g} s of simulated wind. `every segment` is our own truth, {FINE}: what it '
        'differs by is mostly that joints half as far apart are less stiff.'
    )
    head = ['tree', 'wind', *LIMITS]
    return Section('MuJoCo as a second judge', text, checks, markdown_table(head, rows))


def judged(case: tuple[str, str]) -> dict[str, tuple[float, float]]:
    """Error and roughness of our truth and of the models, by name."""
    kind, name = case
    tree, wind = kind_called(kind), wind_called(name, SECONDS)
    engine = MujocoTree(
        tree, WOOD, DAMPING_RATIO, match_beam=False, gravity=GRAVITY, pieces=PIECES
    )
    truth = mujoco_tips(engine, wind, STEPS)
    tips = {'every segment': true_tips(tree, wind)}
    for model in ('default', 'full'):
        tips[model] = record_tips(judged_simulator(model, tree), tree, wind, FRAME)
    return {
        name: (tip_error(tree, each, truth), roughness(each, truth)) for name, each in tips.items()
    }
