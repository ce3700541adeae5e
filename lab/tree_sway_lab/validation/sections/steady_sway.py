# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sway in steady winds that lean a tree by 10, 20 and 30 % of its height."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.tip_error import record_tips, Swaying, tip_error
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.trial import judged_simulator
from tree_sway_lab.validation.truth import QUICK, true_model
from tree_sway_lab.validation.winds import FRAME

SWAYS, LIMITS = (0.1, 0.2, 0.3), (0.01, 0.02, 0.04)
"""Sways of the highest tip over the height of the tree, and errors of it that are allowed."""

ALL_TIPS = 0.03
MODELS = ('default', 'full')
JUDGED = (
    'palm', 'leaning', 'candelabra', 'limbs8', 'spire', 'shrub', 'crooked 1', 'crooked 8',
    'crooked 18',
)  # fmt: skip

_ALONG = np.array([0.8, 0.6, 0.0])
_SETTLE, _MEAN = 10.0, 60


class Sway(NamedTuple):
    """Sway of the highest tip over the truth's, less 1, and error of all tips, in [-]."""

    highest: float
    all_tips: float


def measure(effort: Effort) -> Section:
    """Compare the steady sway of models with the truth's."""
    found = dict(zip(JUDGED, effort.each(swayed, JUDGED), strict=True))
    checks = []
    for model in MODELS:
        for share, limit in zip(SWAYS, LIMITS, strict=True):
            name = f'`{model}`, sway of {100.0 * share:g} % of the height'
            of = [each[model, share] for each in found.values()]
            checks += [
                Check(f'{name}, highest tip', max(abs(one.highest) for one in of), high=limit),
                Check(f'{name}, all tips', max(one.all_tips for one in of), high=ALL_TIPS),
            ]
    rows = [
        [
            kind, f'`{model}`',
            *(f'{each[model, s].highest:+.3f}, {each[model, s].all_tips:.3f}' for s in SWAYS),
        ]
        for kind, each in found.items() for model in MODELS
    ]  # fmt: skip
    text = (
        "Sway of the highest tip over the truth's, less 1, and error of all tips over their "
        'displacement, in the mean of a second, in a steady wind that leans the tree by these '
        f'shares of its height; truth: every segment, {QUICK.pieces} pieces each.'
    )
    head = ['tree', 'model', *(f'{100.0 * share:g} %' for share in SWAYS)]
    return Section('Steady sway', text, checks, markdown_table(head, rows))


def swayed(kind: str) -> dict[tuple[str, float], Sway]:
    """Find by model and share of the height how far the steady sway is from the truth's."""
    tree = kind_called(kind)
    rest = tree.end[tree.branch_first[1:] - 1]
    highest = int(np.argmax(rest[:, 2]))
    models = {name: judged_simulator(name, tree) for name in MODELS}
    truth, found = true_model(tree, QUICK), {}
    for share in SWAYS:
        speed, true = _leaning(truth, tree, share * tree.height, highest)
        for name, model in models.items():
            model.reset()
            tips = _mean_tips(model, tree, speed)
            way = np.linalg.norm([tips[highest] - rest[highest], true[highest] - rest[highest]],
                                 axis=1)  # fmt: skip
            found[name, share] = Sway(
                float(way[0] / way[1]) - 1.0, tip_error(tree, tips[None], true[None])
            )
    return found


def _leaning(truth: Swaying, tree: Tree, sway: float, tip: int) -> tuple[float, Floats]:
    """Wind speed in [m/s] that leans the truth's tip by about so much in [m], and all tips."""
    rest, speed = tree.end[tree.branch_first[1:] - 1], 5.0
    for _ in range(12):
        # From where it was before: only the rest counts, which long steps find too.
        tips = _mean_tips(truth, tree, speed)
        reached = float(np.linalg.norm(tips[tip] - rest[tip]))
        if abs(reached / sway - 1.0) < 0.03:
            break
        speed = min(speed * float(np.clip((sway / max(reached, 1e-6)) ** 0.55, 0.4, 2.5)), 140.0)
    return speed, tips


def _mean_tips(model: Swaying, tree: Tree, speed: float) -> Floats:
    wind = np.tile(speed * _ALONG, (round(_SETTLE / FRAME), 1))
    mean: Floats = record_tips(model, tree, wind, FRAME)[-_MEAN:].mean(axis=0)
    return mean
