# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""States that are saved and set: a simulator continues as if nothing had happened."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulators import AUTO, MODELS, OBSERVED, swaying

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import species_named
from tree_sway.core.tree_state import digest_of
from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.errors import StateError

DT = 1.0 / 60.0


def winds(n, seed=4):
    rng = np.random.default_rng(seed)
    return np.array([5.0, 1.0, 0.2]) + np.cumsum(rng.normal(0.0, 0.5, (n, 3)), axis=0)


@pytest.fixture(scope='module', params=[0, 6, 60, *MODELS, *OBSERVED])
def tree_on(request, fork):
    tree = fork()
    return lambda: swaying(tree, request.param)


def test_a_simulator_goes_on_from_a_state_bit_for_bit(tree_on):
    one, other = tree_on(), tree_on()
    for wind in winds(40):
        one.step(wind, DT)
    other.set_state(one.state())
    assert (other.place() == one.place()).all()
    for wind in winds(20, seed=9):
        one.step(wind, DT)
        other.step(wind, DT)
    assert one.place().tobytes() == other.place().tobytes()


def test_key_rotations_place_as_the_simulator_does(tree_on):
    sim = tree_on()
    for wind in winds(40):
        sim.step(wind, DT)
    poses = sim.place()
    gap = np.linalg.norm(sim.place_rotations(sim.rotations())[:, :3] - poses[:, :3], axis=1).max()
    assert gap <= 1e-12


def foreign(state):
    yield 'another', replace(state, tree='another')
    yield 'model', replace(state, model='full')
    yield 'settings', replace(state, digest='0' * 16)
    yield 'number of values', replace(state, values=state.values[1:])
    yield 'finite', replace(state, values=state.values * np.nan)


def test_a_foreign_state_is_refused_by_name_and_the_old_one_stays(fork):
    sim = make_simulator(fork(), model='branch')
    for wind in winds(10):
        sim.step(wind, DT)
    before = sim.state()
    for name, state in foreign(before):
        with pytest.raises(StateError, match=name):
            sim.set_state(state)
        assert sim.state().values.tobytes() == before.values.tobytes()


@pytest.mark.parametrize('model', AUTO)
def test_a_tree_that_chooses_its_model_refuses_a_foreign_state(fork, model):
    tree = fork()
    sim = make_simulator(tree, species_named(tree.species), model=model)
    for state in (replace(sim.state(), model='99'), replace(sim.state(), digest='0' * 16)):
        with pytest.raises(StateError, match=r'a state of (model|settings)'):
            sim.set_state(state)


def test_the_digest_differs_between_trees_and_settings(fork, stem):
    tree, sim = fork(), make_simulator(fork())
    own = digest_of(tree, sim.settings)
    assert own == digest_of(replace(fork(), name='of another name'), sim.settings)
    assert own != digest_of(stem(), sim.settings)
    assert own != digest_of(tree, replace(sim.settings, gravity=0.0))
    leaves = np.ones(tree.n_branches)
    in_leaf = replace(sim.settings, in_leaf=True)
    assert digest_of(tree, in_leaf) != digest_of(tree, replace(in_leaf, leaf_mass=leaves))


@pytest.mark.parametrize(
    ('name', 'values'),
    [
        ('gravity', [10, 10.0, np.float64(10.0), np.float32(10.0)]),
        ('crown_coherence', [1, 1.0, np.int64(1)]),
        ('in_leaf', [True, np.bool_(True)]),
        ('leaf_mass', [np.ones(3), np.ones(3, dtype=int), np.ones(3, dtype=np.float32)]),
        ('profile', [WindProfile('power', 10), WindProfile('power', np.float64(10.0))]),
    ],
)
def test_equal_values_have_one_digest_whatever_their_type(name, values):
    assert len({digest_of(Settings(**{name: value})) for value in values}) == 1
    assert len({Settings(**{name: value}) for value in values}) == 1


def test_values_that_differ_have_different_digests():
    given = [
        Settings(),
        Settings(gravity=9.8),
        Settings(in_leaf=False),
        Settings(in_leaf=True),
        Settings(leaf_mass=np.ones(3)),
        Settings(leaf_mass=np.ones(4)),
        Settings(leaf_area=np.ones(3)),
        Settings(model='full'),
        Settings(profile=WindProfile('log')),
    ]
    assert len({digest_of(each) for each in given}) == len(given)


@pytest.mark.parametrize('model', [12, *MODELS])
def test_a_state_of_a_tree_that_is_tuned_otherwise_is_refused(tree_of, model):
    sim, other = (make_simulator(tree_of, model=model) for _ in range(2))
    sim.tune(stiffness_factor=3.0)
    assert sim.digest() != other.digest()
    with pytest.raises(StateError, match='a state of settings'):
        other.set_state(sim.state())
    other.tune(stiffness_factor=3.0)
    other.set_state(sim.state())
    sim.tune(stiffness_factor=1.0), other.tune(stiffness_factor=1.0)
    assert sim.digest() == make_simulator(tree_of, model=model).digest()


@pytest.fixture(scope='module')
def tree_of(fork):
    return fork()


@pytest.mark.parametrize(
    'change',
    [list, str, np.ndarray.tolist, lambda _: None, lambda v: v[:, None], lambda v: v * 1j,
     lambda v: v.astype(str), lambda v: v.astype(object), lambda v: v * 1e200],
)  # fmt: skip
def test_a_state_of_other_values_is_refused_and_the_old_one_stays(fork, change):
    sim = make_simulator(fork())
    sim.step((5.0, 0.0, 0.0), DT)
    before = sim.state()
    with pytest.raises(StateError, match='set what state'):
        sim.set_state(replace(before, values=change(before.values)))
    assert sim.state().values.tobytes() == before.values.tobytes()
