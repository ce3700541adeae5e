# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wood of grown broadleaves, against allometry."""

from __future__ import annotations

from functools import partial

import numpy as np

from tree_sway.growth import grow
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.conifers import diameter_at_breast

BROADLEAVES = ('broadleaf', 'oak', 'birch', 'beech', 'ash', 'sycamore', 'walnut')
HEIGHTS = (6.0, 12.0, 24.0)
LIMIT = 0.1

_BASIC_DENSITY = 0.55


def measure(effort: Effort) -> Section:
    """Weigh grown trees of 6, 12 and 24 m."""
    cases = [(species, height) for species in BROADLEAVES for height in HEIGHTS]
    ratios = dict(zip(cases, effort.each(partial(over_allometry), cases), strict=True))
    checks = [
        Check(f'{species}, largest relative error', max(
            (ratios[species, height] - 1.0 for height in HEIGHTS), key=abs
        ), -LIMIT, LIMIT)
        for species in BROADLEAVES
    ]  # fmt: skip
    rows = [[species, *(f'{ratios[species, h]:.2f}' for h in HEIGHTS)] for species in BROADLEAVES]
    text = (
        f'Volume of wood times a basic density of {_BASIC_DENSITY:g} g/cm^3 over the dry mass '
        '0.0673 (rho D^2 H)^0.976 in kg, g/cm^3, cm and m (Chave et al. 2014, equation 4); the '
        'mean of seeds 0 to 4.'
    )
    head = ['species', *(f'{height:g} m' for height in HEIGHTS)]
    return Section('Wood of broadleaves', text, checks, markdown_table(head, rows))


def over_allometry(case: tuple[str, float]) -> float:
    """Dry mass of grown trees over that of measured ones of their size, mean of five."""
    species, height = case
    ratios = []
    for seed in range(5):
        tree = grow(species, height, rng=np.random.default_rng(seed))
        square = _BASIC_DENSITY * (100.0 * diameter_at_breast(tree)) ** 2 * height
        ratios.append(1e3 * _BASIC_DENSITY * tree.volume.sum() / (0.0673 * square**0.976))
    return float(np.mean(ratios))
