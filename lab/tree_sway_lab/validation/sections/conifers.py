# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""First frequencies of grown conifers, against those measured on conifers of the same size."""

from __future__ import annotations

from functools import partial

import numpy as np

from tree_sway.core.settings import Settings
from tree_sway.core.setup import TreeReductions
from tree_sway.core.species import Species, species_named
from tree_sway.core.tree import rooted, Tree
from tree_sway.growth import BREAST_HEIGHT, grow
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section

CONIFERS = ('spruce', 'sitka', 'pine', 'douglas_fir')
HEIGHTS = (10.0, 15.0, 20.0, 30.0)
LIMIT = 0.15


def measure(effort: Effort) -> Section:
    """Grow conifers of 10 to 30 m and find how often they sway in needles."""
    cases = [(species, height) for species in CONIFERS for height in HEIGHTS]
    ratios = dict(zip(cases, effort.each(partial(over_measured), cases), strict=True))
    checks = [
        Check(f'{species}, largest relative error', max(
            (ratios[species, height] - 1.0 for height in HEIGHTS), key=abs
        ), -LIMIT, LIMIT)
        for species in CONIFERS
    ]  # fmt: skip
    rows = [[species, *(f'{ratios[species, h]:.2f}' for h in HEIGHTS)] for species in CONIFERS]
    text = (
        'First frequency in needles, on typical roots as `tree-sway grow` gives, over '
        'f = 0.0766 + 3.1219 DBH / H^2 (Hz, cm, m), the line through 602 conifers of eight '
        'species (Moore & Maguire 2004).'
    )
    head = ['species', *(f'{height:g} m' for height in HEIGHTS)]
    return Section('Frequencies of conifers', text, checks, markdown_table(head, rows))


def over_measured(case: tuple[str, float]) -> float:
    """First frequency of a grown conifer over that of measured ones of its size."""
    species, height = case
    tree = grow(species, height, rng=np.random.default_rng(0))
    measured = 0.0766 + 3.1219 * 100.0 * diameter_at_breast(tree) / height**2
    return first_frequency(tree, species_named(species)) / measured


def first_frequency(tree: Tree, species: Species) -> float:
    """First natural frequency of a tree in leaf on typical roots, as grown, in [Hz]."""
    reductions = TreeReductions(tree, rooted(tree, species), Settings(in_leaf=True))
    return float(reductions.natural_frequencies(1)[0])


def diameter_at_breast(tree: Tree) -> float:
    """Diameter of the stem at 1.3 m in [m]."""
    stem = tree.segments_of(0)
    return float(np.interp(BREAST_HEIGHT, tree.start[stem][:, 2], tree.base_diameter[stem]))
