# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tip errors of the models on straight and on random crooked trees."""

from __future__ import annotations

from functools import partial

import numpy as np

from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.study.example_trees import forked_tree, RATIOS
from tree_sway_ros.study.validation.crooked_trees import crooked_tree
from tree_sway_ros.study.validation.judge import Judge, PIECES, SUBSTEPS, Verdict
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section
from tree_sway_ros.study.validation.winds import turbulent

SEEDS = (1, 8, 16, 18, 20)
"""Of the crooked trees: small ones of the first twenty, so that it does not take long."""

MORE_SEEDS = (2, 4, 11, 12, 13, 15)
"""Further ones for a full run."""

UNTRIED_SEEDS = range(30, 60)
"""Thirty in a row that no model was made with, ten of each habit, for a full run."""

_FEW_UNTRIED = (32, 35, 43)

SPEEDS = (3.0, 9.0)
LIMITS = {'modes 12': 0.05, 'coupled': 0.03}

_STRAIGHT = tuple(f'straight {number}' for number in range(len(RATIOS)))


def measure(effort: Effort) -> Section:
    """Run all models and the truth in turbulence of 3 and 9 m/s."""
    seeds = SEEDS + (MORE_SEEDS if effort.is_full else ())
    seconds = 8.0 if effort.is_full else 5.0
    found = effort.each(partial(judged, seconds=seconds), [*_STRAIGHT, *map(str, seeds)])
    trees = {verdicts[0].tree: verdicts for verdicts in found}
    crooked = [one for verdicts in found[len(_STRAIGHT) :] for one in verdicts]
    checks = [
        Check(
            f'`{model}`, largest tip error of crooked trees',
            max(one.error for one in crooked if one.model == model),
            high=limit,
        )
        for model, limit in LIMITS.items()
    ]
    untried = effort.each(
        partial(judged, seconds=seconds, models=tuple(LIMITS)),
        [str(seed) for seed in UNTRIED_SEEDS if effort.is_full or seed in _FEW_UNTRIED],
    )
    checks += [
        Check(f'`{model}`, largest tip error of untried crooked trees', max(errors), high=limit)
        for model, limit in LIMITS.items()
        if (errors := [one.error for each in untried for one in each if one.model == model])
    ]
    tried = ', '.join(each[0].tree.split()[-1] for each in untried)
    models = list(dict.fromkeys(one.model for one in found[0] if 'frozen' not in one.model))
    rows = [
        [f'`{model}`', *(_cell(verdicts, model) for verdicts in trees.values())]
        for model in models
    ]
    text = (
        'Tip error over tip motion (root mean square over time and all tips) against every segment'
        f' solved in {PIECES} pieces at {60 * SUBSTEPS} Hz, with weight and twist, in {seconds:g} '
        's of simulated wind of 3 and 9 m/s. Straight trees are those of 40 branches whose '
        "children have 0.65, 0.5 and 0.4 of their parent's length; crooked ones are random, "
        'of 40 to 120 branches and three habits, told by the seed of their random numbers. '
        f'No model was made with the untried ones, of seeds {tried}.'
    )
    return Section(
        'Models on straight and on crooked trees', text, checks, markdown_table(
            ['model, 3 and 9 m/s', *trees], rows
        ),
    )  # fmt: skip


def tree_called(name: str) -> Tree:
    """Return a straight tree, or the crooked one of a seed."""
    if name in _STRAIGHT:
        return forked_tree(*RATIOS[_STRAIGHT.index(name)])
    return crooked_tree(int(name))


def judged(name: str, seconds: float, models: tuple[str, ...] | None = None) -> list[Verdict]:
    """Judge models on one tree, all if None."""
    seed = int(name.split()[-1])
    winds = {f'{speed:g} m/s': turbulent(speed, seconds, seed) for speed in SPEEDS}
    return Judge(tree_called(name)).verdicts(winds, models)


def _cell(verdicts: list[Verdict], model: str) -> str:
    errors = [one.error for one in verdicts if one.model == model]
    return ', '.join(f'{error:.3f}' for error in errors) if np.isfinite(errors).all() else '-'
