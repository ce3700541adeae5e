# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree of any size from species, height and diameter."""

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.species.species import species_keys, species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, SpeciesError
from tree_sway.growth.growing import grow


def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def stem_diameter_at(tree: Tree, height: float) -> float:
    stem = tree.segments_of(0)
    z = np.append(tree.start[stem][0, 2], tree.end[stem][:, 2])
    d = np.append(tree.base_diameter[stem][0], tree.tip_diameter[stem])
    return float(np.interp(height, z, d))


@given(
    species=st.sampled_from(['oak', 'birch', 'spruce', 'pine']),
    height=st.floats(3.0, 40.0),
    slenderness=st.floats(30.0, 60.0),
)
@settings(max_examples=10, deadline=None)
def test_height_and_breast_height_diameter_are_met(
    species: str, height: float, slenderness: float
) -> None:
    tree = grow(species, height, height / slenderness, rng=rng())
    assert tree.height == pytest.approx(height, rel=1e-12)
    assert stem_diameter_at(tree, 1.3) == pytest.approx(height / slenderness, rel=1e-9)
    assert tree.species == tree.name == species
    assert tree.n_segments <= 3000


@pytest.mark.parametrize('species', species_keys())
def test_every_species_grows_without_a_diameter(species: str) -> None:
    height = 1.5 if species_named(species).habit == 'pot' else 12.0
    tree = grow(species, height, rng=rng(), name='mine')
    assert tree.name == 'mine'
    assert 800 >= height / stem_diameter_at(tree, 0.0) >= 20
    assert tree.n_segments <= 3000


def test_habits_follow_the_species() -> None:
    habits = [species_named(s).habit for s in ('spruce', 'oak', 'goldcrest')]
    assert habits == ['conifer', 'broadleaf', 'pot']


def test_size_alone_does_not_change_the_shape() -> None:
    small, large = (grow('oak', height, rng=rng()) for height in (6.0, 12.0))
    np.testing.assert_allclose(large.end, 2.0 * small.end, rtol=1e-12)


@pytest.mark.parametrize(
    ('species', 'height', 'diameter', 'message'),
    [
        ('oak', 0.5, None, 'height 0.5 m is out of range .*give 1 to 50 m'),
        ('oak', float('nan'), None, 'height nan m'),
        ('benjamina', 9.0, None, 'give 0.2 to 4 m'),
        ('oak', 20.0, 0.05, 'bend over under its own weight'),
        ('oak', 10.0, 9.0, 'is no stem; give .* to 2 m'),
        ('oak', 10.0, -0.1, 'diameter -0.1 m'),
        ('oak', 10.0, float('nan'), 'diameter nan m'),
    ],
)
def test_bad_sizes_are_refused_with_the_cure(
    species: str, height: float, diameter: float | None, message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        grow(species, height, diameter, rng=rng())


def test_an_unknown_species_is_refused() -> None:
    with pytest.raises(SpeciesError, match="'okk'"):
        grow('okk', 10.0, rng=rng())
