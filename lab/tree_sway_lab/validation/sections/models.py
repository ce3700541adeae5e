# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tip errors along the dial on straight and on random crooked trees."""

from __future__ import annotations

from functools import partial
import itertools

from tree_sway_lab.example_trees import RATIOS
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.trial import SECONDS, Trial, tried
from tree_sway_lab.validation.truth import FINE

SEEDS = (1, 8, 16, 18, 20)
"""Seeds of the crooked trees: small ones of the first twenty, to save time."""

UNTRIED_SEEDS = (32, 35, 43)
"""Seeds of crooked trees that no model was developed on."""

MORE_UNTRIED = tuple(range(30, 60))
"""Thirty in a row that no model was made with, ten of each habit, for a full run."""

SPEEDS = ('3', '9')
LIMITS = {'3': {'default': 0.03, 'full': 0.02}, '9': {'default': 0.04, 'full': 0.03}}
MODELS = ('branch', '3', '6', '12', '20', '40', 'default', 'full')

_STRAIGHT = tuple(f'straight {number}' for number in range(len(RATIOS)))


def measure(effort: Effort) -> Section:
    """Run all models and the truth in turbulence of 3 and 9 m/s."""
    untried = MORE_UNTRIED if effort.is_full else UNTRIED_SEEDS
    crooked = tuple(f'crooked {seed}' for seed in (*SEEDS, *untried))
    kinds = (*_STRAIGHT, *crooked)
    found = dict(zip(kinds, effort.each(judged, kinds), strict=True))
    checks = [
        Check(
            f'`{model}`, {speed} m/s, largest tip error of {name} trees',
            max(one.error for kind in of for one in found[kind]
                if (one.model, one.wind) == (model, speed)),
            high=limit,
        )
        for name, of in (('straight', _STRAIGHT), ('crooked', crooked))
        for speed, limits in LIMITS.items()
        for model, limit in limits.items()
    ]  # fmt: skip
    rows = [[f'`{model}`', *(_cell(found[kind], model) for kind in kinds)] for model in MODELS]
    text = (
        'Tip error over tip motion (root mean square over time and all tips) against every segment'
        f' solved ({FINE}), with weight and twist, in {SECONDS:g} s of simulated wind of 3 and 9 '
        'm/s. Straight trees are those of 40 branches whose children have 0.65, 0.5 and 0.4 of '
        "their parent's length; crooked ones are random, of 40 to 120 branches and three habits, "
        'called by the seed of their random numbers. No model was made with those of seeds '
        f'{", ".join(map(str, untried))}.'
    )
    return Section(
        'Models on straight and on crooked trees', text, checks, markdown_table(
            ['model, 3 and 9 m/s', *kinds], rows
        ),
    )  # fmt: skip


def judged(kind: str) -> list[Trial]:
    """Judge all models on one tree."""
    run = partial(tried, kind, fineness=FINE)
    return [run(wind, model) for model, wind in itertools.product(MODELS, SPEEDS)]


def _cell(trials: list[Trial], model: str) -> str:
    return ', '.join(f'{one.error:.3f}' for one in trials if one.model == model)
