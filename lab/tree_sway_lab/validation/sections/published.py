# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees of published height and stem diameter: frequency and moment at the base, against ours.

Of every species that both tables have, the tree of median height is taken, whatever its figures.
Beside each is the frequency of the simplest law, a line over diameter / height^2. All 17 forest
broadleaves of one wood are taken as well.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from tree_sway.core.growth.grow import grow
from tree_sway.core.model.settings import Settings
from tree_sway.core.scene.simulate import simulate
from tree_sway.core.tree.species import species_named
from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway.tables import table_beside
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.conifers import first_frequency

TREES = table_beside(__file__, 'published.csv')
FOREST_BROADLEAVES = table_beside(__file__, 'forest_broadleaves.csv')
"""Trees of Wytham Woods in the field table of Jackson et al. (2019)."""
CONIFERS, BROADLEAVES = (-0.15, 0.15), (-0.5, 1.0)
"""Between which the relative error of a frequency must be."""

SPEED, INTENSITY, SECONDS, RATE = 10.0, 0.3, 600.0, 20.0
LINES = {'conifer': (0.0766, 3.1219), 'forest': (0.207, 0.135), 'open': (0.106, 1.733)}
"""
First frequency [Hz] at 0 and per diameter [cm] over squared height [m]: 602 conifers (Moore &
Maguire 2004), 111 broadleaves of forests and 88 of the open (Jackson et al. 2021, fitted here).
"""
MEDIAN, WITHIN_TWO = (0.8, 1.25), 0.8
"""Computed over measured of forest broadleaves: the median, and the share within a factor of 2."""
PER_SPEED_SQUARED = 111.91
"""Largest moment of an hour over d^2 h and the squared mean wind at the top [N m s^2/m^5]."""


def measure(effort: Effort) -> Section:
    """Grow each tree by its height and stem diameter, and let conifers sway in turbulence."""
    found = effort.each(partial(compared), TREES)
    checks, rows = list[Check](), list[list[str]]()
    for tree, (frequency, moment) in zip(TREES, found, strict=True):
        measured = tree['frequency']
        limits = BROADLEAVES if moment is None else CONIFERS
        what = f'{tree["species"]} of {tree["height"]:g} m, relative error of the first frequency'
        checks.append(Check(what, frequency / measured - 1.0, *limits))
        published = PER_SPEED_SQUARED * tree['diameter'] ** 2 * tree['height'] * SPEED**2
        moments = ['', ''] if moment is None else [f'{published:.0f}', f'{moment:.0f}']
        head = [tree['species'], f'{tree["height"]:g}', f'{tree["diameter"]:g}', tree['site']]
        named = f'{tree["measured_by"]}, one of {tree["number"]}'
        kind = tree['site'] if moment is None else 'conifer'
        line = line_frequency(kind, tree['diameter'], tree['height'])
        rows.append([*head, named, f'{measured:g}', f'{frequency:.3g}', f'{line:.3g}', *moments])
    ratios = effort.each(partial(over_measured), FOREST_BROADLEAVES)
    grown = np.array([ratio for ratio in ratios if ratio is not None])
    within = float(np.sum((grown > 0.5) & (grown < 2.0)) / len(ratios))
    checks += [
        Check(
            'forest broadleaves, first frequency over measured, median',
            float(np.median(grown)),
            *MEDIAN,
        ),
        Check('forest broadleaves, share within a factor of 2', within, WITHIN_TWO),
    ]
    pairs = zip(FOREST_BROADLEAVES, ratios, strict=True)
    rows += [_forest_row(tree, ratio) for tree, ratio in pairs]
    text = (
        'Measured trees of the field table of Jackson et al. (2019, Journal of the Royal Society '
        'Interface 16, 20190116), of each species the one of median height; ours are grown by '
        'height and stem diameter, in leaf. Conifers in a stand are beams, and height and stem '
        'diameter say how often they sway; of broadleaves they do not (the same study: a third '
        'of the variance of those in the open), and what is grown without their crown is within '
        'a factor of 2 at most. Published moments: 111.91 d^2 h U^2, the largest of an hour at '
        'the base of conifers by the mean wind U at their top (Hale et al. 2012; ForestGALES); '
        f'ours: the largest in {SECONDS:g} s of turbulence of {SPEED:g} m/s and an intensity of '
        f'{INTENSITY:g} at the top, log profile over a roughness of a tenth of the height, for a '
        'tree that no other shelters and whose crown has not been cut short by neighbours. Line: '
        'the simplest law, of 602 conifers (Moore & Maguire 2004), 111 broadleaves of forests or '
        '88 of the open (Jackson et al. 2021); it was fitted to such trees and ours was not. The '
        'last rows are all trees of Wytham Woods in the field table; a slender one that a grown '
        'tree could not carry counts as beyond a factor of 2.'
    )
    titles = [
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
    title = 'Published trees'
    return Section(title, text, checks, markdown_table(titles, rows))


def line_frequency(kind: str, diameter: float, height: float) -> float:
    """First frequency [Hz] by one of `LINES`, of diameter and height in [m]."""
    constant, slope = LINES[kind]
    return constant + slope * 100.0 * diameter / height**2


def over_measured(row: dict[str, Any]) -> float | None:
    """First frequency of a tree grown to its size over the measured one; None if it cannot be."""
    try:
        tree = grow(row['species'], row['height'], row['diameter'], rng=np.random.default_rng(0))
    except ParameterError:
        return None
    return first_frequency(tree, species_named(row['species'])) / float(row['frequency'])


def _forest_row(tree: dict[str, Any], ratio: float | None) -> list[str]:
    ours = 'not grown' if ratio is None else f'{ratio * tree["frequency"]:.3g}'
    line = line_frequency('forest', tree['diameter'], tree['height'])
    head = [tree['species'], f'{tree["height"]:g}', f'{tree["diameter"]:g}', 'forest']
    named = 'Toby Jackson, Wytham'
    return [*head, named, f'{tree["frequency"]:g}', ours, f'{line:.3g}', '', '']


def compared(row: dict[str, Any]) -> tuple[float, float | None]:
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
