# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree apart from its anemometer: smooth or alive, the same for a seed, unchanged beside it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError
from tree_sway.growth.builtin import builtin_tree

DT = 1.0 / 60.0
TREE = builtin_tree('goldcrest')
WIND = simulate_turbulence(7.0, rate=60.0, duration=25.0, rng=2)


def tips(sim: SwaySimulator) -> Floats:
    """Tips in the wind, (n, b, 3)."""
    found = []
    for wind in WIND:
        sim.step(wind, DT)
        found.append(tips_of_poses(sim.tree, sim.place()))
    return np.array(found)[600:]


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


def test_a_forest_refuses_a_distance_to_its_anemometer() -> None:
    scene = Scene([PlacedTree(name, TREE, x=x) for name, x in (('one', 0.0), ('two', 9.0))])
    with pytest.raises(ParameterError, match='anemometer_distance'):
        scene.simulator(anemometer_distance=12.0)
