# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What may be given as a tree to every function, and what is refused there with a cure."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import Species, species_named
from tree_sway.core.tree.grown_tree import tree_and_species
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, SpeciesError
from tree_sway.growth.growing import grow

DOORS = {
    'make_simulator': lambda tree, **options: make_simulator(tree, model='branch', **options),
    'prepare': lambda tree, **options: make_simulator(prepare(tree, model='branch', **options)),
    'Scene': lambda tree, **options: Scene([PlacedTree('one', tree)]).simulator(
        model='branch', **options
    ),
}


class Grown(NamedTuple):
    """A tree with a species of its own, as a file gives it."""

    tree: Tree
    species: Species


@pytest.fixture(scope='module')
def opened(fork):
    oak = species_named('oak')
    return Grown(replace(fork(), species='oak'), replace(oak, modulus=2.0 * oak.modulus))


def test_a_tree_brings_its_species(opened):
    assert tree_and_species(opened) == (opened.tree, opened.species)
    ash = species_named('ash')
    assert tree_and_species(opened, ash) == (opened.tree, ash)
    assert tree_and_species(opened.tree) == (opened.tree, species_named('oak'))


@pytest.mark.parametrize('door', DOORS)
def test_an_opened_tree_may_be_given_as_it_is(opened, door):
    made = DOORS[door](opened)
    apart = {
        'make_simulator': lambda: make_simulator(opened.tree, opened.species, model='branch'),
        'prepare': lambda: make_simulator(prepare(opened.tree, opened.species, model='branch')),
        'Scene': lambda: Scene([PlacedTree('one', opened.tree, species=opened.species)]).simulator(
            model='branch'
        ),
    }[door]()
    for each in (made, apart):
        each.step((5.0, 0.0, 0.0), 1.0 / 60.0)
    np.testing.assert_array_equal(made.place(), apart.place())


@pytest.mark.parametrize('door', DOORS)
@pytest.mark.parametrize('wrong', ['benjamina', None, 3.0, Settings()])
def test_what_is_no_tree_is_refused_everywhere(door, wrong):
    kind = type(wrong).__name__
    with pytest.raises(ParameterError, match=f'tree: a {kind}, where a tree is expected; give'):
        DOORS[door](wrong)


@pytest.mark.parametrize('door', DOORS)
def test_what_are_no_settings_is_refused_everywhere(opened, door):
    with pytest.raises(ParameterError, match='settings: a Species, where Settings are expected'):
        DOORS[door](opened, settings=opened.species)
    with pytest.raises(ParameterError, match="unknown setting 'gravit'; did you mean 'gravity'"):
        DOORS[door](opened, gravit=0.0)


def test_settings_in_the_place_of_the_species_are_refused(opened):
    for door in (make_simulator, prepare):
        with pytest.raises(ParameterError, match=r'species: a Settings, .* as settings='):
            door(opened, Settings())
    with pytest.raises(ParameterError, match='species: a str, where a Species is expected'):
        PlacedTree('one', opened, species='oak')


def test_a_species_in_the_place_of_its_key_is_refused(opened):
    for door in (species_named, lambda key: grow(key, 5.0, rng=None)):
        with pytest.raises(SpeciesError, match=r"a Species, where the name .*'oak'"):
            door(opened.species)


def test_a_forest_asks_for_placed_trees(opened):
    with pytest.raises(ParameterError, match=r'trees\[0\]: a Grown, where a PlacedTree is'):
        Scene([opened])
