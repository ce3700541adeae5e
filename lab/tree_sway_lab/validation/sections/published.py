# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Published trees: first frequency and moment at the base, measured and of grown trees of their size.

``published.csv`` has one tree of each species that both our species table and the field table of
Jackson et al. (2019) have, the one of median height. ``forest_broadleaves.csv`` has all 17 of one
wood. The simplest law, a line over diameter / height^2, is computed beside the model.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.settings import Settings
from tree_sway.core.species import species_named
from tree_sway.core.wind import simulate_turbulence, WindProfile
from tree_sway.errors import ParameterError
from tree_sway.growth import grow
from tree_sway.simulation import simulate
from tree_sway.tables import table_beside
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.conifers import first_frequency

TREES = table_beside(__file__, 'published.csv')
FOREST_BROADLEAVES = table_beside(__file__, 'forest_broadleaves.csv')
"""Trees of Wytham Woods in the field table of Jackson et al. (2019)."""
CONIFERS, BROADLEAVES = (-0.15, 0.15), (-0.5, 1.0)
"""Limits of the relative error of a frequency."""

SPEED, INTENSITY, SECONDS, RATE = 10.0, 0.3, 600.0, 20.0
"""Wind of the base moments: mean [m/s], turbulence intensity, duration [s], samples [1/s]."""
LINES = {'conifer': (0.0766, 3.1219), 'forest': (0.207, 0.135), 'open': (0.106, 1.733)}
"""
First frequency [Hz] at 0 and per diameter [cm] over squared height [m]: 602 conifers (Moore &
Maguire 2004), 111 broadleaves of forests and 88 of the open (Jackson et al. 2021, fitted here).
"""
MEDIAN, WITHIN_TWO = (0.8, 1.25), 0.8
"""Limits for forest broadleaves: median of computed over measured, share within a factor of 2."""
PER_SPEED_SQUARED = 111.91
"""Largest moment of an hour over d^2 h and the squared mean wind at the top [N m s^2/m^5]."""

TEXT = (
    'Measured trees of the field table of Jackson et al. (2019, Journal of the Royal Society '
    'Interface 16, 20190116), of each species the one of median height; ours are grown by '
    'height and stem diameter, in leaf, on typical roots. Conifers in a stand are beams, and '
    'height and stem diameter say how often they sway; of broadleaves they do not (the same '
    'study: a third of the variance of those in the open), and what is grown without their '
    'crown is within a factor of 2 at most. Published moments: 111.91 d^2 h U^2, the largest of '
    'an hour at '
    'the base of conifers by the mean wind U at their top (Hale et al. 2012; ForestGALES); '
    f'ours: the largest in {SECONDS:g} s of turbulence of {SPEED:g} m/s and an intensity of '
    f'{INTENSITY:g} at the top, log profile over a roughness of a tenth of the height, for a '
    'tree that no other shelters and whose crown has not been cut short by neighbours. Line: '
    'the simplest law, of 602 conifers (Moore & Maguire 2004), 111 broadleaves of forests or '
    '88 of the open (Jackson et al. 2021); it was fitted to such trees and ours was not. The '
    'last rows are all trees of Wytham Woods in the field table; a slender one that a grown '
    'tree could not carry counts as beyond a factor of 2.'
)
TITLES = [
    'species',
    'height [m]',
    'diameter [m]',
    'site',
    'measured by',
    'frequency [Hz]',
    'ours',
    'line',
    'moment [N m]',
    'ours',
]


def measure(effort: Effort) -> Section:
    """Grow each tree by its height and stem diameter, and let conifers sway in turbulence."""
    computed = effort.each(frequency_and_moment, TREES)
    ratios = effort.each(over_measured, FOREST_BROADLEAVES)
    grown = np.array([ratio for ratio in ratios if ratio is not None])
    within_two = float(np.sum((grown > 0.5) & (grown < 2.0)) / len(ratios))
    median = 'forest broadleaves, first frequency over measured, median'
    share = 'forest broadleaves, share within a factor of 2'
    pairs = list(zip(TREES, computed, strict=True))
    forest = zip(FOREST_BROADLEAVES, ratios, strict=True)
    checks = [
        *(_check(tree, frequency, moment) for tree, (frequency, moment) in pairs),
        Check(median, float(np.median(grown)), *MEDIAN),
        Check(share, within_two, WITHIN_TWO),
    ]
    rows = [
        *(_row(tree, frequency, moment) for tree, (frequency, moment) in pairs),
        *(_forest_row(tree, ratio) for tree, ratio in forest),
    ]
    return Section('Published trees', TEXT, checks, markdown_table(TITLES, rows))


def _check(tree: dict[str, Any], frequency: float, moment: float | None) -> Check:
    """Check the frequency [Hz] of a tree; conifers have a moment."""
    limits = BROADLEAVES if moment is None else CONIFERS
    what = f'{tree["species"]} of {tree["height"]:g} m, relative error of the first frequency'
    return Check(what, frequency / tree['frequency'] - 1.0, *limits)


def _row(tree: dict[str, Any], frequency: float, moment: float | None) -> list[str]:
    published = PER_SPEED_SQUARED * tree['diameter'] ** 2 * tree['height'] * SPEED**2
    kind = tree['site'] if moment is None else 'conifer'
    line = line_frequency(kind, tree['diameter'], tree['height'])
    return [
        tree['species'],
        f'{tree["height"]:g}',
        f'{tree["diameter"]:g}',
        tree['site'],
        f'{tree["measured_by"]}, one of {tree["number"]}',
        f'{tree["frequency"]:g}',
        f'{frequency:.3g}',
        f'{line:.3g}',
        *(['', ''] if moment is None else [f'{published:.0f}', f'{moment:.0f}']),
    ]


def line_frequency(kind: str, diameter: float, height: float) -> float:
    """First frequency [Hz] by one of `LINES`, of diameter and height in [m]."""
    constant, slope = LINES[kind]
    return constant + slope * 100.0 * diameter / height**2


def over_measured(row: dict[str, Any]) -> float | None:
    """First frequency of a grown tree of its size over the measured; None if it cannot stand."""
    try:
        tree = grow(row['species'], row['height'], row['diameter'], rng=np.random.default_rng(0))
    except ParameterError:
        return None
    return first_frequency(tree, species_named(row['species'])) / float(row['frequency'])


def _forest_row(tree: dict[str, Any], ratio: float | None) -> list[str]:
    ours = 'not grown' if ratio is None else f'{ratio * tree["frequency"]:.3g}'
    line = line_frequency('forest', tree['diameter'], tree['height'])
    return [
        tree['species'],
        f'{tree["height"]:g}',
        f'{tree["diameter"]:g}',
        'forest',
        'Toby Jackson, Wytham',
        f'{tree["frequency"]:g}',
        ours,
        f'{line:.3g}',
        '',
        '',
    ]


def frequency_and_moment(row: dict[str, Any]) -> tuple[float, float | None]:
    """First frequency [Hz] of a tree grown to its size, and of a conifer the base moment [N m]."""
    species = species_named(row['species'])
    tree = grow(row['species'], row['height'], row['diameter'], rng=np.random.default_rng(0))
    frequency = first_frequency(tree, species)
    if species.habit != 'conifer':
        return frequency, None
    height = float(row['height'])
    wind = simulate_turbulence(
        SPEED, rate=RATE, duration=SECONDS, rng=np.random.default_rng(1), height=height,
        intensity=INTENSITY,
    )  # fmt: skip
    profile = WindProfile('log', height, roughness=0.1 * height)
    settings = Settings(model=20, in_leaf=True, profile=profile)
    sway = simulate(tree, wind, rate=RATE, settings=settings)
    return frequency, float(np.hypot(*sway.base_moment[:, :2].T).max())
