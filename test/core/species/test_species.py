# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The table of woods: complete, physical, and clear about what it does not know."""

from __future__ import annotations

from collections import Counter
import dataclasses

import pytest

from tree_sway.core.species.species import NAMES, species_keys, species_like, species_named
from tree_sway.errors import SpeciesError


@pytest.mark.parametrize('key', species_keys())
def test_every_wood_is_green_wood(key):
    wood = species_named(key)
    assert wood.key == key
    assert wood.title
    # Green wood lies between balsa and boxwood (Forest Products Laboratory, Wood Handbook, 2010).
    assert 3e9 < wood.modulus < 16e9
    assert 350.0 < wood.density < 1300.0
    assert 0.02 <= wood.damping_bare <= 0.10
    assert 0.05 <= wood.damping_in_leaf <= 0.24
    assert 0.0 <= wood.drag_exponent < 1.0
    # Wood sounds at some 2-5 km/s along the grain.
    assert 1.9e3 < (wood.modulus / wood.density) ** 0.5 < 5e3


def test_drag_at_ten_metres_a_second_is_that_of_a_crown():
    for key in species_keys():
        wood = species_named(key)
        assert 0.2 < wood.drag_coefficient * 10.0**-wood.drag_exponent < 1.3


def test_an_unknown_species_is_refused_with_those_that_exist():
    with pytest.raises(
        SpeciesError, match=r"unknown species 'xyzzy'; use one of: alder, .*walnut"
    ):
        species_named('xyzzy')


def test_guesses_are_marked():
    marked = {key for key in species_keys() if species_named(key).is_estimate}
    dry_wood = {'horse_chestnut', 'hornbeam', 'pear', 'apple', 'tree_of_heaven', 'ginkgo'}
    of_family = {'zelkova', 'rowan', 'hawthorn', 'hazel', 'pagoda_tree'}
    guessed = {'benjamina', 'goldcrest', 'broadleaf', 'conifer'}
    assert marked >= guessed | dry_wood | of_family
    assert marked.isdisjoint({'oak', 'beech', 'ash', 'birch', 'spruce', 'pine', 'douglas_fir'})


def test_a_species_cannot_be_changed_by_accident():
    with pytest.raises(dataclasses.FrozenInstanceError):
        species_named('oak').modulus = 1.0


def test_without_leaves_a_tree_does_not_streamline():
    oak = species_named('oak')
    assert oak.drag_law(in_leaf=True) == (oak.drag_coefficient, oak.drag_exponent)
    assert oak.drag_law(in_leaf=False) == (oak.bare_drag_coefficient, 0.0)


def test_every_crown_in_leaf_streamlines():
    for key in species_keys():
        assert species_named(key).drag_law(in_leaf=True)[1] > 0.3


@pytest.mark.parametrize(
    ('name', 'key'),
    [
        ('Quercus robur L.', 'oak'),
        ('ACER', 'maple'),
        ('Acer pseudoplatanus', 'sycamore'),
        ("Prunus serrulata 'Kanzan'", 'cherry'),
        ('Douglas-fir', 'douglas_fir'),
        ('SS', 'sitka'),
        ('Salix sp.', 'willow'),
        ('Populus x canadensis', 'poplar'),
        ('Fichte', 'spruce'),
        ('Hainbuche', 'hornbeam'),
        ('Roßkastanie', 'horse_chestnut'),
        ('ROSSKASTANIE', 'horse_chestnut'),
        ("Marronnier d'Inde", 'horse_chestnut'),
        ('Chêne', 'oak'),
        ('CHENE', 'oak'),
        ('plátano de sombra', 'plane'),
        ('London planetree', 'plane'),
        ('honeylocust', 'honey_locust'),
        ('Callery pear', 'pear'),
        ('Ginkgo biloba', 'ginkgo'),
        ('Robinie', 'robinia'),
        ('Acer saccharinum', 'silver_maple'),
        ('Sophora japonica', 'pagoda_tree'),
        ('dąb', 'oak'),
        ('björk', 'birch'),
    ],
)
def test_names_of_lists_are_known_whatever_their_case(name, key):
    assert species_named(name).key == key


@pytest.mark.parametrize(
    ('name', 'key', 'guess'),
    [
        ('brich', 'broadleaf', "did you mean 'birch'?"),
        ('okk', 'broadleaf', "did you mean 'oak'?"),
        ('elmm', 'broadleaf', "did you mean 'elm'?"),
        ('Xyloma ignota', 'broadleaf', 'a broadleaf of no known species'),
        ('Sumpfzypresse', 'conifer', 'a conifer of no known species'),
        ('Winter-Linde', 'lime', 'is taken as lime'),
        ('Kaiserlinde', 'lime', 'is taken as lime'),
        ('American linden', 'lime', 'is taken as lime'),
        ('pin oak', 'oak', 'is taken as oak'),
        ('Pin noir', 'pine', 'is taken as Scots pine'),
        ('western redcedar', 'conifer', 'a conifer of no known species'),
    ],
)
def test_a_species_of_no_table_is_one_of_its_group_and_said(name, key, guess):
    species, note = species_like(name)
    assert species.key == key
    assert name in note
    assert guess in note


@pytest.mark.parametrize('name', ['oak_stiff.yaml', 'oak.yml', 'oak.JSON', 'oak.csv'])
def test_a_file_is_not_a_species_of_the_table(name):
    with pytest.raises(SpeciesError, match='the name of a file'):
        species_named(name)


@pytest.mark.parametrize(
    ('name', 'guess'), [('okk', 'oak'), ('Qercus robur', 'quercus robur'), ('brich', 'birch')]
)
def test_a_misspelt_species_has_the_nearest_name(name, guess):
    with pytest.raises(SpeciesError, match=f"did you mean '{guess}'"):
        species_named(name)


def test_every_name_is_of_one_species():
    counts = Counter(name for each in NAMES.values() for name in each)
    assert [name for name, count in counts.items() if count > 1] == []
    assert set(NAMES) == set(species_keys())
