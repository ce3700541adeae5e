# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The simulator of one tree and that of many: the same names, with the same meanings."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.errors import StateError

DT = 1.0 / 60.0
TURN, SCALE = 0.7, 1.3


@pytest.fixture
def stand(fork, mirror_fork):
    """Make two trees on a table, one of them turned and larger, and one on its own model."""
    trees = [
        PlacedTree('a', fork()),
        PlacedTree('b', fork(), 5.0, 2.0, 0.5, yaw=TURN, scale=SCALE),
        PlacedTree('c', mirror_fork()[0], x=9.0, model='branch'),
    ]
    return Scene(trees, name='row', convection_ratio=np.inf).simulator(model=12)


def names_of(simulator):
    return {name for name in {*dir(simulator), *vars(simulator)} if not name.startswith('_')}


def swayed(simulator, steps=90, seed=5):
    rng = np.random.default_rng(seed)
    for _ in range(steps):
        simulator.step(rng.normal((7.0, 1.0, 0.0), (1.0, 1.0, 0.2)), DT)
    return simulator


def test_one_tree_and_many_have_the_same_public_names(fork, stand):
    assert names_of(make_simulator(fork(), model=12)) == names_of(stand)


def test_rotations_place_the_trees_where_they_are(stand):
    swayed(stand)
    placed = stand.place()
    assert stand.place_rotations(stand.rotations()) == pytest.approx(placed, abs=1e-6)
    still = stand.place_rotations(np.zeros_like(stand.rotations()))
    assert np.abs(still - placed).max() > 1e-3


def test_a_stand_continues_bit_for_bit_from_its_state(stand):
    swayed(stand)
    state, poses = stand.state(), stand.place()
    after = swayed(stand, 30, seed=6).place()
    stand.reset()
    stand.set_state(state)
    assert stand.place().tobytes() == poses.tobytes()
    assert swayed(stand, 30, seed=6).place().tobytes() == after.tobytes()


def test_a_state_of_another_stand_is_refused(fork, stand):
    other = Scene([PlacedTree('a', fork()), PlacedTree('b', fork(), x=3.0)], name='row')
    with pytest.raises(StateError, match='settings'):
        stand.set_state(other.simulator(model=12).state())


def test_moments_are_those_of_each_tree_alone(fork, stand):
    alone = make_simulator(fork(), model=12)
    for simulator in (stand, alone):
        swayed(simulator)
    assert stand.wind_moment.shape == (3, 3)
    assert stand.wind_moment[0] == pytest.approx(alone.wind_moment, rel=1e-6)


def test_the_load_of_a_push_is_the_force_where_the_tree_stands(stand):
    rows, force = stand.segments_of('b'), np.array([3.0, -2.0, 1.0])
    stand.push(rows.stop - 1, force, 5.0)
    swayed(stand, 3)
    assert {*stand.pushed} == {1}
    assert stand.push_load[1, :3] == pytest.approx(force)
    assert not stand.push_load[[0, 2]].any()
    at = stand.place()[rows.stop - 1, :3] - stand.places[1, :3]
    assert np.linalg.norm(stand.push_load[1, 3:]) > 0.5 * np.linalg.norm(np.cross(at, force))


def test_masses_and_frequencies_follow_the_scale(fork, stand):
    alone = make_simulator(fork(), model=12)
    own = stand.simulators[0]
    assert stand.mass == pytest.approx((1.0 + SCALE**3) * alone.mass + own.mass)
    one = alone.frequencies(3)
    found = np.sort(np.concatenate([one, one / SCALE, own.frequencies(3)]))[:3]
    assert stand.frequencies(3) == pytest.approx(found)
