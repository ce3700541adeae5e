# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The table of winds against all coordinates, on built-in, scanned and crooked trees."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.settings import USUAL
from tree_sway.core.setup import prepare
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.core.wind.gusts import USUAL_COHERENCE
from tree_sway.errors import ParameterError
from tree_sway.fidelity import AdaptiveSimulator, WindClimate
from tree_sway.files.trees import open_tree
from tree_sway.growth import BUILTIN_TREES
from tree_sway_lab.bench.sizes import against, gusts_and_turns
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.tip_error import record_tips
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.truth import WOOD
from tree_sway_lab.validation.winds import FRAME, turbulent

LIMIT = 0.03
SPEEDS = (2.0, 5.0, 8.0, 12.0)
"""Mean winds in [m/s]."""

MANY = 240
"""Coordinates of a tree that is too large for `full`."""

SCANS = ('tree121.csv', 'qsm_archi.csv', 'qsm_treeqsm_v5.mat', 'walnut.mtg')
"""Files in the folder of data, trees that stand."""


APART = 0.1
"""Limit where gusts reach one limb after another."""

LIMB_BY_LIMB = ('crooked 4', 'crooked 8', 'crooked 62', 'broad', 'spire', 'shrub')
SMALL, HANGING = ('tree121.csv', 'qsm_treeqsm_v5.mat'), ('willow', 'birch')
"""Kinds and files of trees that `full` takes, in such gusts; kinds whose twigs hang."""


class Departure(NamedTuple):
    """
    How far one tree on its table is from `full` in each of `SPEEDS`.

    Parameters
    ----------
    branches
        How many it has.
    errors
        Root mean square gap of all segments over their motion.
    over_estimates
        Root mean square gap of all tips over the error that is estimated for the table.
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
    small = [*LIMB_BY_LIMB, *(str(file) for file in files if file.name in SMALL)]
    name = f'gusts limb by limb (`crown_coherence` {USUAL_COHERENCE:g}), largest error over motion'
    for named, those in ((name, small), (f'{name} where twigs hang', HANGING)):
        most = max(value for each in effort.each(limb_by_limb, list(those)) for value in each)
        checks.append(Check(named, most, high=APART))
    rows = [
        [Path(source).name, str(each.branches), *(f'{e:.3f}' for e in each.errors),
         f'{max(each.over_estimates):.2f}', f'{max(each.outside):.3f}']
        for source, each in found.items()
    ]  # fmt: skip
    text = (
        'Gap between the default model, all its coordinates shown, and `full` '
        f'({MANY} coordinates of a tree too large for it) over the motion of '
        'all segments, in 20 s of simulated wind with a gust of 1.6 times, a slow turn and a '
        'sudden one by 90 degrees; and the gap of the tips over the estimated error. In gusts '
        'limb by limb it is that of all segments in turbulence, on '
        f'{", ".join((*LIMB_BY_LIMB, *SMALL))}; twigs hang on {" and ".join(HANGING)}.'
    )
    head = ['tree', 'branches', *(f'{speed:g} m/s' for speed in SPEEDS)]
    head += ['most over estimate', 'most steps outside of the table']
    return Section('The table of winds', text, checks, markdown_table(head, rows))


def departure(source: str) -> Departure:
    """Measure a built-in tree or a file."""
    opened = open_tree(source)
    tree, species = opened.tree, opened.species
    tabled = AdaptiveSimulator(prepare(tree, species), tolerance=0.0)
    full = _reference(tree, species)
    errors, over, outside = [], [], []
    for speed in SPEEDS:
        wind, before = gusts_and_turns(speed), tabled.banks[0].oscillators.n_outside
        errors.append(against(tabled, full, wind))
        outside.append((tabled.banks[0].oscillators.n_outside - before) / len(wind))
        tabled.reset()
        full.reset()
        gap = record_tips(tabled, tree, wind, FRAME) - record_tips(full, tree, wind, FRAME)
        metres = float(np.sqrt(np.square(gap).sum(axis=2).mean()))
        estimate = tabled.estimates(WindClimate.of_samples(wind, 1.0 / FRAME))[-1]
        over.append(metres / estimate.error)
    return Departure(tree.n_branches, errors, over, outside)


def limb_by_limb(source: str) -> list[float]:
    """Measure a kind of tree or a file in turbulence that reaches its limbs one by one."""
    if Path(source).name in SCANS:
        opened = open_tree(source)
        tree, species = opened.tree, opened.species
    else:
        tree, species = kind_called(source), WOOD
    table, full = (
        make_simulator(tree, species, model=each, crown_coherence=USUAL_COHERENCE)
        for each in (USUAL, 'full')
    )
    return [against(table, full, turbulent(speed, 20.0, 3)) for speed in SPEEDS]


def _reference(tree: Tree, species: Species) -> SwaySimulator:
    """Make the model that the default is compared with."""
    try:
        return make_simulator(tree, species, model='full')
    except ParameterError:
        return make_simulator(tree, species, model=MANY)
