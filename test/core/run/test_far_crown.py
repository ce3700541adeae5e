# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree apart from its anemometer: smooth or alive, the same for a seed, unchanged beside it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from drawn_trees import crown
import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.settings import Settings
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError

DT = 1.0 / 60.0
TREE = crown((4, 2), 4)
SETTLED = 5 * 60
WIND = simulate_turbulence(7.0, rate=60.0, duration=15.0, rng=2)


def tips(sim: SwaySimulator) -> Floats:
    """Tips in the wind, (n, b, 3)."""
    found = []
    for wind in WIND:
        sim.step(wind, DT)
        found.append(tips_of_poses(sim.tree, sim.place()))
    return np.array(found)[SETTLED:]


@cache
def tips_beside() -> Floats:
    """Tips of a tree without a distance."""
    return tips(make_simulator(TREE))


def roughness(motion: Floats) -> float:
    """Root mean square of the second difference."""
    return float(np.sqrt(np.square(np.diff(motion, 2, axis=0)).mean()))


def test_a_tree_beside_its_anemometer_moves_as_without_a_distance() -> None:
    measured = {'anemometer_distance': 9.0, 'gusts': 'measured'}
    for changes in ({'anemometer_distance': 0.0}, measured):
        np.testing.assert_array_equal(tips(make_simulator(TREE, **changes)), tips_beside())


def test_the_expected_motion_is_smooth_and_a_sample_is_not() -> None:
    measured = roughness(tips_beside())
    expected = roughness(tips(make_simulator(TREE, anemometer_distance=12.0)))
    sample = roughness(tips(make_simulator(TREE, anemometer_distance=12.0, gusts='sample')))
    assert expected < 0.4 * measured
    assert 0.4 * measured < sample < 1.2 * measured


def test_two_sites_with_a_seed_show_the_same_gusts_and_a_state_goes_on_with_them() -> None:
    changes = {'anemometer_distance': 12.0, 'gusts': 'sample', 'gust_seed': 5}
    one, other = (make_simulator(TREE, **changes) for _ in range(2))
    np.testing.assert_array_equal(tips(one), tips(other))
    state = one.state()
    wanted = tips(one)
    other.reset()
    other.set_state(state)
    np.testing.assert_array_equal(tips(other), wanted)


def test_a_scene_knows_how_far_its_anemometer_is() -> None:
    scene = Scene([PlacedTree('one', TREE)])
    there = replace(scene, anemometer=(-12.0, 0.0, 5.0)).simulator()
    assert there.models[0].settings.anemometer_distance == pytest.approx(12.0)
    assert scene.simulator().models[0].settings.anemometer_distance == 0.0


def forest(count: int) -> Scene:
    """Trees in a row to the east."""
    return Scene([PlacedTree(f'tree {i}', TREE, x=9.0 * i) for i in range(count)])


def test_each_tree_of_a_forest_stands_apart_from_the_anemometer_by_its_own_way() -> None:
    west = {'anemometer_distance': 12.0, 'anemometer_bearing': 1.5 * np.pi, 'gusts': 'sample'}
    sim = forest(2).simulator(**west)
    near, far = (each.settings for each in sim.simulators)
    assert (near.anemometer_distance, far.anemometer_distance) == pytest.approx((12.0, 21.0))
    assert near.gust_seed != far.gust_seed
    moved = []
    for wind in WIND:
        sim.step(wind, DT)
        moved.append([each.tip_displacement for each in sim.simulators])
    first, second = np.array(moved)[SETTLED:, :, 0].T
    assert abs(np.corrcoef(np.diff(first), np.diff(second))[0, 1]) < 0.5
    again = forest(2).simulator(**west)
    for wind in WIND:
        again.step(wind, DT)
    np.testing.assert_array_equal(again.place(), sim.place())


def test_trees_without_a_bearing_are_all_as_far_and_too_many_are_refused() -> None:
    sim = forest(2).simulator(anemometer_distance=12.0)
    assert [each.settings.anemometer_distance for each in sim.simulators] == [12.0, 12.0]
    with pytest.raises(ParameterError, match='anemometer_distance'):
        forest(21).simulator(anemometer_distance=12.0)


def test_a_setting_says_which_gusts_a_tree_meets() -> None:
    told = Settings(anemometer_distance=12.0, anemometer_bearing=-0.5 * np.pi, gusts='sample')
    assert told.wind_told == 'a sample, seed 0; anemometer 12 m away at 270 degrees'
    assert 'taken to stand at the tree' in Settings().wind_told
