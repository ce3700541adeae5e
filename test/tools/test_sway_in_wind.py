# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree taken through a wind without ROS."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.wind.simulated.anemometer import AnemometerModel
from tree_sway_ros.files.wind.record import WindRecord
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.tools.sway_in_wind import recorded, simulated, sway_in_wind

WESTERLY = np.array([5.0, 0.0, 0.0])


@pytest.fixture
def simulator() -> SwaySimulator:
    return SwaySimulator(bench_tree(2), model="subtree")


def test_a_steady_wind_ends_where_stepping_by_hand_does(simulator: SwaySimulator) -> None:
    found = sway_in_wind(simulator, ((0.05 * k, WESTERLY) for k in itertools.count()), 30.0)
    by_hand = SwaySimulator(simulator.tree, model="subtree")
    for _ in range(1800):
        by_hand.step(WESTERLY, 1 / 60)
    by_hand.place()
    assert found.tip[-1] == pytest.approx(by_hand.tip_displacement, rel=1e-3)
    assert found.tip[-1][0] > 0.0
    assert found.time[[0, -1]] == pytest.approx([1 / 60, 30.0])
    assert found.wind[-1] == pytest.approx(WESTERLY)


def test_it_ends_with_the_record(simulator: SwaySimulator) -> None:
    time = np.arange(0.0, 2.0, 0.05)
    record = WindRecord(time, np.tile(WESTERLY, (len(time), 1)), "a test")
    found = sway_in_wind(simulator, recorded(record), 60.0)
    assert found.time[-1] == pytest.approx(time[-1], abs=1 / 60)
    assert found.wind.shape == found.tip.shape == (len(found.time), 3)


def test_a_simulated_wind_is_the_same_each_time(simulator: SwaySimulator) -> None:
    first = sway_in_wind(simulator, simulated(AnemometerModel(6.0, seed=3)), 3.0)
    simulator.reset()
    second = sway_in_wind(simulator, simulated(AnemometerModel(6.0, seed=3)), 3.0)
    assert np.array_equal(first.tip, second.tip)
    assert not np.array_equal(first.wind[0], first.wind[-1])
