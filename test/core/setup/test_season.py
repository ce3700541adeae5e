# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Leaves on or off: lower frequencies, more damping, a load below the square of the wind."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tree_sway.core.leaves.foliage import foliage_of
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.setup.season import in_season
from tree_sway.core.species.species import species_keys, species_named
from tree_sway.errors import ParameterError
from tree_sway.growth.builtin import builtin_tree
from tree_sway.growth.growing import grow

OAK = species_named('oak')
SPEEDS = np.geomspace(2.0, 20.0, 10)
GROWN = {'oak': 12.0, 'birch': 9.0, 'spruce': 12.0, 'pine': 14.0}
_long = pytest.mark.long


@cache
def tree_named(name):
    if name in GROWN:
        return grow(name, GROWN[name], rng=np.random.default_rng(0))
    return builtin_tree(name)


def branch_wood(tree):
    """Mass of all wood but the stem's in [kg]."""
    volume = tree.volume.sum() - tree.volume[tree.segments_of(0)].sum()
    return volume * species_named(tree.species).density


def first_frequency(tree, settings):
    """First natural frequency of a tree; its table of winds is not made."""
    return TreeReductions(tree, species_named(tree.species), settings).natural_frequencies(1)[0]


def test_leaves_weigh_catch_and_damp(fork):
    tree = replace(fork(), species='oak')
    foliage = foliage_of(tree)
    usual = Settings(model='branch', gravity=0.0)
    leafy = in_season(tree, OAK, replace(usual, in_leaf=True))
    assert (leafy.leaf_mass == foliage.mass).all()
    assert (leafy.leaf_area == foliage.drag_area).all()
    assert leafy == replace(
        usual, in_leaf=True, leaf_mass=leafy.leaf_mass, leaf_area=leafy.leaf_area
    )
    bare, full = (make_simulator(tree, settings=each) for each in (usual, leafy))
    assert full.mass - bare.mass == pytest.approx(foliage.mass.sum())


def test_by_default_an_oak_is_bare_and_a_spruce_is_not(fork):
    spruce = species_named('spruce')
    assert in_season(fork(), OAK, Settings()) == Settings(in_leaf=False)
    leafy = in_season(fork(), spruce, Settings())
    assert leafy.in_leaf
    assert leafy.leaf_mass == pytest.approx(foliage_of(fork(), traits=spruce.leaves).mass)
    assert in_season(fork(), spruce, leafy) is leafy
    assert in_season(fork(), spruce, Settings(in_leaf=False)) == Settings(in_leaf=False)


def test_leaves_may_be_given(fork):
    heavy = replace(OAK.leaves, fresh_mass=1.0)
    settings = in_season(fork(), replace(OAK, leaves=heavy), Settings(in_leaf=True))
    assert settings.leaf_mass == pytest.approx(foliage_of(fork(), traits=heavy).mass)
    given = in_season(fork(), OAK, Settings(leaf_mass=np.ones(4)))
    assert (given.leaf_mass == 1.0).all()
    assert given.in_leaf
    assert given.leaf_area is None


def test_leaves_on_a_bare_tree_are_refused():
    with pytest.raises(ParameterError, match='leaves on a bare tree'):
        Settings(in_leaf=False, leaf_mass=np.ones(1))


@pytest.mark.parametrize('key', species_keys())
def test_needles_stay(key):
    wood = species_named(key)
    exception = key in ('larch', 'eucalyptus')  # larches shed their needles, eucalyptus nothing
    assert wood.leaves.is_evergreen == ((wood.habit != 'broadleaf') != exception)


DOORS = {
    'make_simulator': lambda tree, **how: make_simulator(tree, **how),
    'Scene': lambda tree, **how: Scene([PlacedTree('tree', tree)]).simulator(**how),
}


@pytest.mark.parametrize('door', DOORS)
def test_an_evergreen_is_in_leaf_behind_every_door_unless_set_otherwise(door, fork):
    tree = replace(fork(), species='spruce')
    assert DOORS[door](tree).settings.in_leaf is True
    assert DOORS[door](tree, in_leaf=False).settings.in_leaf is False


def test_goldcrest_sways_as_slowly_as_its_leaves_make_it():
    tree, wood = builtin_tree('goldcrest'), species_named('goldcrest')
    leafy, bare = (
        TreeReductions(tree, wood, in_season(tree, wood, each)).natural_frequencies(1)
        for each in (Settings(), Settings(in_leaf=False))
    )
    assert leafy == pytest.approx(3.49, abs=0.02)
    assert bare == pytest.approx(6.69, abs=0.02)


#: What is missed, and by how much, is in the reason.
_too_heavy = pytest.mark.xfail(
    strict=True, reason="leaves at 60 % of the branches' mass bring it to 0.50 to 0.69"
)


@pytest.mark.parametrize(
    ('name', 'shares'),
    [
        pytest.param('pine', (0.15, 0.60), marks=_long),
        pytest.param('benjamina', (0.15, 0.43), marks=_long),
        pytest.param('spruce', (0.20, 0.60), marks=_long),
        pytest.param('spruce', (0.15, 0.60), marks=_long),
        pytest.param('goldcrest', (0.15, 0.60), marks=_long),
        pytest.param('broadleaf', (0.15, 0.32), marks=_long),
        pytest.param('broadleaf', (0.15, 0.60), marks=[_long, _too_heavy]),
        pytest.param('oak', (0.08, 0.22), marks=_long),
        pytest.param('oak', (0.15, 0.60), marks=[_long, _too_heavy]),
        pytest.param('benjamina', (0.15, 0.60), marks=[_long, _too_heavy]),
    ],
)
def test_leaves_lower_the_first_frequency(name, shares):
    """Leaves of 15 to 60 % of the branches' mass bring it to 0.70 to 0.95 of the bare one."""
    tree = tree_named(name)
    leafy = in_season(tree, species_named(tree.species), Settings(in_leaf=True))
    mass = leafy.leaf_mass / leafy.leaf_mass.sum() * branch_wood(tree)
    bare = first_frequency(tree, Settings(in_leaf=False))
    most, least = (
        first_frequency(tree, replace(leafy, leaf_mass=mass * share)) / bare for share in shares
    )
    assert 0.70 <= least < most <= 0.95


@pytest.mark.parametrize(
    'name',
    [
        pytest.param(key, marks=[] if key == 'oak' else [_long])
        for key in species_keys()
        if species_named(key).habit == 'broadleaf'
    ],
)
def test_broadleaves_in_leaf_sway_as_much_slower_as_measured_ones(name):
    tree = grow(name, 12.0, rng=np.random.default_rng(0))
    bare, leafy = (first_frequency(tree, Settings(in_leaf=each)) for each in (False, True))
    assert 0.76 <= leafy / bare <= 0.94


def test_leaves_damp():
    for key in species_keys():
        wood = species_named(key)
        assert wood.damping_in_leaf > wood.damping_bare


def growth_of_load(tree, settings):
    """Exponent p of the moment at the base, U^p."""
    sim = make_simulator(tree, settings=replace(settings, damping_ratio=0.7))
    moment = []
    for speed in SPEEDS:
        for _ in range(60):
            sim.step((speed, 0.0, 0.0), 0.1)
        moment.append(np.linalg.norm(sim.wind_moment))
    return np.polyfit(np.log(SPEEDS), np.log(moment), 1)[0]


@pytest.mark.parametrize(
    'name',
    [
        'benjamina',
        *(pytest.param(each, marks=_long) for each in ('oak', 'birch', 'spruce', 'pine')),
    ],
)
def test_load_grows_with_the_square_of_the_wind_but_less_in_leaf(name):
    tree, usual = tree_named(name), Settings(model='branch')
    assert 1.90 <= growth_of_load(tree, replace(usual, in_leaf=False)) <= 2.05
    assert 1.50 <= growth_of_load(tree, replace(usual, in_leaf=True)) <= 1.70


def test_the_wind_moment_is_that_of_drag(stem):
    """A stem in a steady wind: pressure times area times the height of its middle."""
    tree = stem(length=2.0, base=0.05)
    sim = make_simulator(tree, model='branch', damping_ratio=0.7)
    for _ in range(200):
        sim.step((3.0, 0.0, 0.0), 0.1)
    pushed = 0.5 * 1.225 * 1.2 * 3.0**2 * (2.0 * 0.05)
    assert sim.wind_moment == pytest.approx([0.0, pushed * 1.0, 0.0], rel=1e-3, abs=1e-9)
    sim.reset()
    sim.step((0.0, 0.0, 0.0), 0.1)
    assert sim.wind_moment == pytest.approx(np.zeros(3), abs=1e-12)
