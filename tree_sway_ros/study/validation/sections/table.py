# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model `wind_basis` against `modes`, on built-in and on scanned trees."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway_ros.core.fidelity.ladder import FidelityLadder
from tree_sway_ros.core.growth.builtin import BUILTIN_TREES
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.wind.climate import WindClimate
from tree_sway_ros.files.trees.source import open_tree
from tree_sway_ros.study.bench.sizes import against, gusts_and_turns
from tree_sway_ros.study.tip_error import record_tips
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section
from tree_sway_ros.study.validation.winds import FRAME

LIMIT = 0.03
SPEEDS = (2.0, 5.0, 8.0, 12.0)
"""Mean winds in [m/s]."""

SCANS = ('tree121.csv', 'qsm_archi.csv', 'qsm_treeqsm_v5.mat', 'walnut.mtg')
"""Files in the folder of data, trees that stand."""


class Departure(NamedTuple):
    """
    How far one tree on its table is from `modes` in each of `SPEEDS`.

    Parameters
    ----------
    branches
        How many it has.
    errors
        Root mean square gap of all segments over their motion.
    over_estimates
        Root mean square gap of all tips over the error that the ladder estimates for the model.
    outside
        Share of steps outside of the table.

    """

    branches: int
    errors: list[float]
    over_estimates: list[float]
    outside: list[float]


def measure(effort: Effort) -> Section:
    """Run both models on every tree, in turbulence with a gust, a slow turn and a sudden one."""
    folder = effort.data / 'trees' if effort.data else Path()
    files = [folder / name for name in SCANS if effort.data and (folder / name).is_file()]
    sources = [*BUILTIN_TREES, *map(str, files)]
    found = dict(zip(sources, effort.each(departure, sources), strict=True))
    checks = [
        Check(f'`{Path(source).name}`, largest error over motion', max(each.errors), high=LIMIT)
        for source, each in found.items()
    ]
    over = [value for each in found.values() for value in each.over_estimates]
    checks.append(Check('largest error over the estimate of the model', max(over), high=1.0))
    rows = [
        [Path(source).name, str(each.branches), *(f'{e:.3f}' for e in each.errors),
         f'{max(each.over_estimates):.2f}', f'{max(each.outside):.3f}']
        for source, each in found.items()
    ]  # fmt: skip
    text = (
        'Gap between `wind_basis`, as it is by default, and `modes` over the motion of all '
        'segments, in 20 s of simulated wind with a gust of 1.6 times, a slow turn and a sudden '
        'one by 90 degrees; and the gap of the tips over the error that the ladder tells. Where a '
        'tree of many limbs has fewer modes in `modes` than on the table, as the walnut, the gap '
        'is what those modes add.'
    )
    head = ['tree', 'branches', *(f'{speed:g} m/s' for speed in SPEEDS)]
    head += ['most over estimate', 'most steps outside of the table']
    return Section('The table of winds', text, checks, markdown_table(head, rows))


def departure(source: str) -> Departure:
    """Measure a built-in tree or a file."""
    opened = open_tree(source)
    tree, species, settings = opened.tree, opened.species, Settings()
    tabled, modal = (
        SwaySimulator(tree, species, settings, model=model) for model in ('wind_basis', 'modes')
    )
    ladder = FidelityLadder(tree, species, settings)
    errors, over, outside = [], [], []
    for speed in SPEEDS:
        wind, before = gusts_and_turns(speed), tabled.bank.oscillators.n_outside
        errors.append(against(tabled, modal, wind))
        outside.append((tabled.bank.oscillators.n_outside - before) / len(wind))
        tabled.reset()
        modal.reset()
        gap = record_tips(tabled, tree, wind, FRAME) - record_tips(modal, tree, wind, FRAME)
        metres = float(np.sqrt(np.square(gap).sum(axis=2).mean()))
        told = ladder.estimates(WindClimate.of_samples(wind, FRAME))
        (estimate,) = (e for e in told if e.model == 'wind_basis' and e.n_frozen == 0)
        over.append(metres / estimate.error)
    return Departure(tree.n_branches, errors, over, outside)
