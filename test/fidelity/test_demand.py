# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a scene asks, handed to trees that can choose."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import species_named
from tree_sway.fidelity.demand import measure_costs, set_demand
from tree_sway.growth.builtin import builtin_tree

OAK = species_named('oak')


@pytest.fixture(scope='module')
def pair(fork):
    trees = fork(), fork(3)
    return [make_simulator(tree, OAK, Settings(model='auto')) for tree in trees]


def test_each_tree_gets_its_share_of_the_budget(pair):
    pinned = make_simulator(pair[0].tree, OAK)
    set_demand([*pair, pinned], tolerance=0.01, budget=40.0)
    assert [each.budget for each in pair] == pytest.approx([10.0, 30.0])
    assert [each.tolerance for each in pair] == [0.01, 0.01]
    assert not hasattr(pinned, 'tolerance')


def test_a_camera_turns_angles_into_metres(pair):
    far = pair[0].tree.start[0] - (50.0, 0.0, 0.0)
    set_demand(pair, tolerance=9.0, camera=far, tolerance_angle=0.004)
    assert pair[0].tolerance == pytest.approx(0.004 * 50.0, rel=0.05)
    assert pair[0].budget == 0.0


def test_the_measured_cost_is_that_of_the_trees_that_choose_alone(pair):
    reads, pinned = [], make_simulator(pair[0].tree, OAK)

    class Both:
        simulators = (*pair, pinned)

        def step(self, wind, dt):
            reads.append('all')

        def place(self):
            return None

        def reset(self):
            reads.append('reset')

    def timer():
        reads.append('timer')
        return 1.234e-3 * reads.count('timer')

    for _ in range(2):
        measure_costs(Both(), 1 / 60, timer)
        assert sum(each.frame_cost for each in pair) == pytest.approx(1234.0)
        assert pair[0].cost_scale == pair[1].cost_scale
    assert reads[:4] == ['all', 'timer', 'timer', 'all']
    assert reads[-1] == 'reset'
    assert not hasattr(pinned, 'cost_scale')


def test_trees_are_at_rest_once_their_cost_is_measured():
    simulator = make_simulator(builtin_tree('goldcrest'))
    rest = simulator.place().copy()
    measure_costs(simulator, 1 / 60, lambda: 0.0)
    np.testing.assert_array_equal(simulator.place(), rest)
