# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Measured trees that no law here was made with: their first frequency, and that of grown trees.

The table of all published frequencies of Jackson et al. (2021) is no part of this package: sheet
``Combined_f0_data`` of ``NaturalFrequencies_FieldData.xlsx``, as ``frequencies.csv`` in the folder
of data. Scored are the trees of `OWNERS`, whose species are in our table. Those of other people
were seen: the conifers of Moore & Maguire's line, the trees of section ``published``, and those
that the growth was compared with (``doc/trees.md``).

"""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway.core.species import species_named
from tree_sway.errors import ParameterError, SpeciesError
from tree_sway.growth import grow
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.conifers import first_frequency
from tree_sway_lab.validation.sections.published import line_frequency

FILE = 'frequencies.csv'
OWNERS = (
    'Amanda Bunce', 'Brian Kane', 'Chris Still', 'Dirk Schindler', 'Dom Ciruzzi', 'John Selker',
)  # fmt: skip
"""Who measured the trees."""
MEDIANS = {'conifers': (0.85, 1.15), 'forest': (0.8, 1.25), 'open': (0.8, 1.25)}
WITHIN_TWO = 0.8
"""Limits of the median of computed over measured, and of the share within a factor of 2."""
TITLES = {'conifers': 'conifers', 'forest': 'forest broadleaves', 'open': 'open broadleaves'}


class Measured(NamedTuple):
    """A tree: kind of `MEDIANS`, species, height and diameter [m], frequency [Hz], owner."""

    kind: str
    species: str
    height: float
    diameter: float
    frequency: float
    owner: str


def measure(effort: Effort) -> Section:
    """Grow each tree of the table by its height and stem diameter."""
    path = effort.data / FILE if effort.data else None
    trees = measured_trees(path) if path and path.is_file() else []
    ratios = np.array(effort.each(over_measured, trees), dtype=np.float64)
    checks = list[Check]()
    rows = list[list[str]]()
    for kind, limits in MEDIANS.items():
        chosen = [k for k, tree in enumerate(trees) if tree.kind == kind]
        if not chosen:
            continue
        grown = ratios[chosen]
        within = float(np.mean((grown > 0.5) & (grown < 2.0)))
        checks += [
            Check(f'{TITLES[kind]}, over measured, median', float(np.nanmedian(grown)), *limits),
            Check(f'{TITLES[kind]}, share within a factor of 2', within, WITHIN_TWO),
        ]
        rows += _rows([trees[k] for k in chosen], grown)
    text = (
        'First frequency in leaf, with typical roots, of trees grown by height and stem diameter '
        'as `tree-sway grow` does, over the measured one. The trees are those of '
        f'{", ".join(OWNERS)} in the table of Jackson et al. (2021, Biogeosciences 18, '
        '4059-4072) whose species are in ours; no law was made with them. Those too slender to '
        'stand count as beyond a factor of 2. Line: the simplest law, fitted to such trees (602 '
        'conifers, Moore & Maguire 2004; 111 broadleaves of forests and 88 of the open, Jackson '
        f'et al. 2021). The table is not ours to give: as `{FILE}` in the folder `--data` it is '
        'scored again.'
    )
    head = ['kind', 'species', 'measured by', 'number', 'not grown', 'ours over measured, median',
            'lowest', 'highest', 'line, median']  # fmt: skip
    return Section('Held-out trees', text, checks, markdown_table(head, rows))


def measured_trees(path: Path) -> list[Measured]:
    """Return the trees of `OWNERS` in a table whose species are known and that have all values."""
    with path.open(encoding='utf-8-sig', newline='') as file:
        rows = list(csv.DictReader(file))
    trees = list[Measured]()
    for row in rows:
        height, diameter, frequency = (_number(row[name]) for name in ('H_m', 'DBH_m', 'f0'))
        if row['Owner'] not in OWNERS or not math.isfinite(height * diameter * frequency):
            continue
        try:
            species = species_named(row['Species_Latin'].strip())
        except SpeciesError:
            continue
        kind = 'conifers' if species.habit == 'conifer' else row['Environment'].lower()
        tree = Measured(kind, species.key, height, diameter, frequency, row['Owner'])
        trees.append(tree)
    return trees


def over_measured(tree: Measured) -> float:
    """First frequency of a grown tree of its size over the measured; NaN if it cannot stand."""
    rng = np.random.default_rng(0)
    try:
        grown = grow(tree.species, tree.height, tree.diameter, rng=rng)
    except ParameterError:
        return math.nan
    return first_frequency(grown, species_named(tree.species)) / tree.frequency


def _number(cell: str) -> float:
    return float(cell) if cell.strip() else math.nan


def _rows(trees: list[Measured], ratios: np.ndarray) -> list[list[str]]:
    """Return a row for each species of each owner, and one for all."""
    groups = {(tree.species, tree.owner): list[int]() for tree in trees}
    for k, tree in enumerate(trees):
        groups[tree.species, tree.owner].append(k)
    everyone = ('all', ''), list(range(len(trees)))
    rows = list[list[str]]()
    for (species, owner), chosen in (*sorted(groups.items()), everyone):
        found = ratios[chosen]
        grown = found[np.isfinite(found)]
        of_line = [_of_line(trees[k]) for k in chosen]
        spread = [f'{each:.2f}' for each in (np.median(grown), grown.min(), grown.max())]
        rows.append([
            TITLES[trees[0].kind], species, owner, str(len(chosen)),
            str(len(chosen) - len(grown)), *spread, f'{np.median(of_line):.2f}',
        ])  # fmt: skip
    return rows


def _of_line(tree: Measured) -> float:
    kind = 'conifer' if tree.kind == 'conifers' else tree.kind
    return line_frequency(kind, tree.diameter, tree.height) / tree.frequency
