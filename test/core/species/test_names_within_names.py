# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names of species in brackets, turned round, in lists, and of two trees in one name."""

from __future__ import annotations

import pytest

from tree_sway.core.species import species_like, species_named
from tree_sway.errors import SpeciesError


@pytest.mark.parametrize(
    ('name', 'key'),
    [
        ('Field Maple (Acer campestre)', 'maple'),
        ('Acer campestre (Field Maple)', 'maple'),
        ('[Quercus robur] Common Oak', 'oak'),
        ('Lawson Cypress (Chamaecyparis lawsoniana)', 'conifer'),
        ('Oak, English (Quercus robur)', 'oak'),
        ('Chestnut, Horse', 'horse_chestnut'),
        ('Maple, Silver', 'silver_maple'),
        # A Latin name counts before a common one, which means another tree elsewhere.
        ('Sycamore (Platanus occidentalis)', 'plane'),
        ('Sycamore (Acer pseudoplatanus)', 'sycamore'),
        ('Mountain Ash (Eucalyptus regnans)', 'eucalyptus'),
        ('Eucalyptus regnans (Mountain Ash)', 'eucalyptus'),
        ('Liquidambar styraciflua (gum)', 'sweetgum'),
        ('Pine (Scots', 'pine'),
        ('楓香', 'sweetgum'),
    ],
)
def test_a_known_name_is_found_wherever_it_stands(name: str, key: str) -> None:
    assert species_named(name).key == key
    assert species_like(name)[1] == ''


@pytest.mark.parametrize(
    ('name', 'key'),
    [
        ('willow oak', 'oak'),
        ('Oak, willow', 'oak'),
        ('chestnut oak', 'oak'),
        ('Red Oak (Querus rubra)', 'oak'),
        ('Érable à feuilles de frêne', 'maple'),
    ],
)
def test_the_noun_of_a_name_is_the_tree(name: str, key: str) -> None:
    assert species_like(name)[0].key == key


@pytest.mark.parametrize(
    'name', ['Mixed: hawthorn, elder, field maple', 'oak / ash', 'maple, oak, ash']
)
def test_a_list_of_several_is_no_one_of_them(name: str) -> None:
    species, note = species_like(name)
    assert species.key == 'broadleaf'
    assert name in note
    with pytest.raises(SpeciesError, match='several species'):
        species_named(name)


def test_two_names_of_one_species_are_no_list() -> None:
    assert species_named('Acer rubrum / red maple').key == 'red_maple'
    assert species_named('Tilia cordata / Tilia x europaea').key == 'lime'


@pytest.mark.parametrize('name', ['Souche', 'Tree(s)', "Arbutus 'Marina'"])
def test_a_far_name_is_not_suggested(name: str) -> None:
    assert 'did you mean' not in species_like(name)[1]
