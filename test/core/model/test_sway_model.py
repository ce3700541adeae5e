# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The prepared model of a tree: whole, checked, and enough to simulate it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.model.sway_model import MEANINGS, SwayModel, TABLE
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare, prepared
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.errors import FormatError

MODELS = (12, 0, 'branch')


@pytest.fixture(scope='module')
def models(fork):
    tree = fork()
    made = {model: prepare(tree, model=model) for model in MODELS}
    return made | {'limbs': prepare(tree, model=4, crown_coherence=0.3)}


class Kept:
    """A cache of one model."""

    def __init__(self):
        self.arrays = {}

    def read(self, digest):
        return self.arrays.get(digest)

    def write(self, digest, arrays):
        self.arrays[digest] = arrays


def again(model, **changes):
    return SwayModel.of_arrays(model.arrays() | changes, model.tree, model.species, model.settings)


@pytest.mark.parametrize('name', [*MODELS, 'limbs'])
def test_arrays_make_the_same_model(models, name):
    model = models[name]
    copy = again(model)
    assert copy.digest() == model.digest()
    assert copy.arrays().keys() == model.arrays().keys()
    wind, poses = (6.0, 1.0, 0.0), []
    for each in (model, copy):
        simulator = SwaySimulator(each)
        for _ in range(30):
            simulator.step(wind, 1 / 60)
        poses.append(simulator.place().tobytes())
    assert poses[0] == poses[1]


def test_a_simulator_leaves_its_model_as_it_is(models):
    model = models[12]
    before = model.digest()
    simulator = SwaySimulator(model)
    simulator.tune(stiffness_factor=2.0, damping_ratio=0.3, gravity=1.0)
    simulator.push(3, (1.0, 0.0, 0.0), 0.5)
    for _ in range(60):
        simulator.step((9.0, 0.0, 0.0), 1 / 60)
    assert model.digest() == before


def test_a_model_with_other_numbers_has_another_digest(models):
    model = models[12]
    others = [
        replace(model, stiffness=1.01 * model.stiffness),
        replace(model, mass=1.01 * model.mass),
        replace(model, drag_law=model.drag_law._replace(coefficient=2.0)),
        models[0],
    ]
    assert len({model.digest(), *(other.digest() for other in others)}) == 5


def bad_arrays(model):
    """Arrays that do not fit, each with a word of its error."""
    lifted = model.branch_parent.copy()
    lifted[1] = len(lifted)
    nan = model.load.copy()
    nan[3, 2, 0] = np.nan
    yield 'short', {'stiffness': model.stiffness[:-1]}, 'stiffness|own_damping'
    yield 'single', {'stiffness': model.stiffness.astype(np.float32)}, 'float32'
    yield 'not finite', {'load': nan}, 'not finite'
    yield 'parent', {'branch_parent': lifted}, 'branch_parent'
    yield 'cycle', {'branch_parent': np.arange(len(lifted)) - 0}, 'branch_parent'
    yield 'key', {'branch_coordinate': model.branch_coordinate + 1}, 'branch_coordinate'
    yield 'keys', {'branch_keys': np.where(model.branch_keys > 0, 99, 0)}, 'expected'
    yield 'seat', {'branch_base_segment': model.branch_base_segment + 1}, 'branch_base_segment'
    yield 'segments', {'branch_first': model.branch_first + 1}, 'branch_first'
    yield 'flat', {'branch_frame': model.branch_frame[:, :2]}, 'branch_frame'
    yield 'unknown', {'colour': np.zeros(3)}, 'no model has'
    yield 'drag law', {'drag_law': np.ones(2)}, 'drag_law'
    yield 'mass', {'mass': np.array(np.inf)}, 'mass'
    yield 'half a table', {'turning': np.zeros(0, dtype=np.float32)}, 'turning'


@pytest.mark.parametrize('number', range(14))
def test_an_array_that_does_not_fit_is_named(models, number):
    _, changes, named = list(bad_arrays(models[12]))[number]
    with pytest.raises(FormatError, match=named):
        again(models[12], **changes)


@pytest.mark.parametrize('name', ['mass', 'branch_parent', 'own_damping'])
def test_a_missing_array_is_named(models, name):
    arrays = models[12].arrays()
    del arrays[name]
    with pytest.raises(FormatError, match=f"array '{name}': missing"):
        SwayModel.of_arrays(
            arrays, *(getattr(models[12], x) for x in ('tree', 'species', 'settings'))
        )


def test_every_array_has_a_shape_and_a_meaning(models):
    for name, meaning in MEANINGS.items():
        assert meaning.shape, name
        assert meaning.text, name
    table = {name for name, meaning in MEANINGS.items() if meaning.group == TABLE}
    assert table <= models[12].arrays().keys()
    assert not table & models[0].arrays().keys()
    assert models[12].has_table
    assert not models['branch'].has_table
    assert models['limbs'].has_limbs


def test_a_model_says_what_it_is(models):
    assert repr(models[12]).startswith('SwayModel of tree, model 12: ')


def test_a_model_of_a_cut_tree_places_it_as_before(fork):
    """Branches are in the order of the tree, pieces of one branch after each other."""
    model = prepare(fork(6), model=12)
    assert (np.diff(model.branch_first) > 0).all()
    at_rest = make_simulator(fork(6), model=12).place()
    assert at_rest[:, :3] == pytest.approx(model.tree.start, abs=1e-12)


@pytest.mark.parametrize('name', [12, 'branch'])
def test_the_frequencies_of_the_tree_are_those_of_a_set_up_that_is_read(fork, name):
    """The model of isolated branches stores theirs, which are not those of the tree."""
    kept, found = Kept(), []
    for _ in range(2):
        reductions = TreeReductions(fork(), species_named('oak'), Settings(model=name))
        prepared(reductions, cache=kept)
        found.append(reductions.natural_frequencies(3))
    assert kept.arrays
    assert np.array_equal(*found)
