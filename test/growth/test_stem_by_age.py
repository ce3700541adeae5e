# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Stems of street trees by age."""

import numpy as np
import pytest

from tree_sway.core.species.species import species_keys
from tree_sway.errors import ParameterError
from tree_sway.growth.growing import grow
from tree_sway.growth.stem_by_age import stem_growth, stem_of_age


def test_a_stem_follows_the_published_curve() -> None:
    """Littleleaf lime in the Northeast at 50 years, by hand from its four coefficients."""
    centimetres = 2.70741 + 1.43292 * 50 - 0.01191 * 50**2 + 0.00006 * 50**3
    assert stem_of_age('lime', 50.0) == pytest.approx(0.01 * centimetres)
    assert stem_of_age('Tilia cordata', 50.0) == stem_of_age('lime', 50.0)


@pytest.mark.parametrize('species', stem_growth())
def test_every_curve_grows_to_its_end(species: str) -> None:
    curve = stem_growth()[species]
    assert species in species_keys()
    assert np.diff(curve.diameters).min() > 0.0
    assert curve.oldest >= 30
    assert 0.3 < curve.diameters[-1] < 1.5
    assert stem_of_age(species, curve.oldest) == curve.diameters[-1]


@pytest.mark.parametrize(
    ('species', 'age', 'cure'),
    [
        ('larch', 20.0, 'or take one of spruce'),
        ('birch', 90.0, 'up to 36'),
        ('birch', 0.0, 'above 0'),
        ('birch', float('nan'), 'above 0'),
    ],
)
def test_an_age_without_a_curve_is_refused(species: str, age: float, cure: str) -> None:
    with pytest.raises(ParameterError, match=cure):
        stem_of_age(species, age)


def test_an_older_tree_of_a_height_has_a_thicker_stem() -> None:
    young, old = (
        grow('oak', 14.0, stem_of_age('oak', age), rng=np.random.default_rng(3))
        for age in (30.0, 90.0)
    )
    assert old.base_diameter[0] > 2.0 * young.base_diameter[0]
