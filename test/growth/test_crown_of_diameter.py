# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The crown of a grown tree follows a measured diameter of its stem."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.growth.crown_allometry import breast_height_diameter, crown_change, crown_size
from tree_sway.growth.growing import grow

SLENDER, USUAL, STOUT = 0.75, 1.0, 1.3
"""Diameters over the usual one of a height."""


def _grown(species: str, height: float, factor: float) -> Tree:
    usual = breast_height_diameter(grow(species, height, rng=np.random.default_rng(2)))
    return grow(species, height, factor * usual, rng=np.random.default_rng(2))


def _width_and_base(tree: Tree) -> tuple[float, float]:
    ends = np.vstack([tree.start, tree.end])
    lowest = float(tree.start[tree.branch_first[1:-1], 2].min())
    return float(np.ptp(ends[:, :2], axis=0).mean()), lowest


@pytest.mark.parametrize(('species', 'height'), [('spruce', 24.0), ('oak', 18.0), ('ash', 20.0)])
def test_a_thinner_stem_has_a_narrower_crown_that_begins_higher(species, height):
    usual_diameter = breast_height_diameter(_grown(species, height, USUAL))
    usual_width, usual_base = _width_and_base(_grown(species, height, USUAL))
    for factor in (SLENDER, STOUT):
        width, base = _width_and_base(_grown(species, height, factor))
        wanted = crown_size(species, factor * usual_diameter, height).width
        wanted /= crown_size(species, usual_diameter, height).width
        assert width / usual_width == pytest.approx(wanted, rel=0.12)
        assert (base > usual_base) if factor < 1.0 else (base < usual_base)


def test_the_usual_diameter_changes_nothing():
    given, free = _grown('oak', 12.0, USUAL), grow('oak', 12.0, rng=np.random.default_rng(2))
    np.testing.assert_allclose(given.end, free.end, rtol=1e-9, atol=1e-9)
    assert crown_change('benjamina', 1.0, 0.02, 0.01) == (1.0, 0.0)


def test_a_spruce_has_the_published_share_of_bare_stem():
    # Hasenauer & Monserud (1996): slenderness of 75 in place of 54.8, 24 m.
    change = crown_change('spruce', 24.0, 0.438, 0.32)
    bare = 0.011232 * (75.0 - 54.795) - 0.6358e-4 * (1024.0 - 1918.4)
    assert change.bare == pytest.approx(bare, rel=1e-3)
    # Hale et al. (2015), Norway spruce: 0.8524 m and 11.5 m a metre of diameter.
    assert change.width == pytest.approx(4.5324 / 5.8894, rel=1e-4)


@pytest.mark.parametrize(
    ('species', 'height', 'diameter', 'measured', 'in_leaf'),
    [
        ('oak', 6.0, 0.30, 1.10, True),
        ('ash', 24.6, 0.285, 0.187, False),
        *(
            pytest.param(*each, marks=pytest.mark.long)
            for each in (
                ('lime', 4.7, 0.07, 1.42, True),
                ('lime', 5.9, 0.099, 1.10, True),
                ('lime', 6.2, 0.134, 1.02, True),
                ('sycamore', 17.5, 0.223, 0.228, False),
                ('oak', 18.1, 0.656, 0.242, False),
            )
        ),
    ],
)
def test_broadleaves_of_given_size_sway_within_half_of_measured_ones(
    species, height, diameter, measured, in_leaf
):
    """Trees of the collection of Jackson et al. (2021), slender and stout ones."""
    tree = grow(species, height, diameter, rng=np.random.default_rng(5))
    whole = TreeReductions(tree, species_named(species), Settings(in_leaf=in_leaf))
    assert 0.65 <= whole.natural_frequencies(1)[0] / measured <= 1.55
