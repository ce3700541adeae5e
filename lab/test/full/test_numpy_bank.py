# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The model `full` compiled and in numpy: two programs, one motion.

Where nothing is compiled both are the same, and only what numpy does is tested.
"""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.building import tree_from_segments


def segments_in_all_directions(n=60):
    """Make a tree without rule: segments of any thickness on the ends of others, with gaps."""
    rng = np.random.default_rng(8)
    start, end, parent = np.zeros((n, 3)), np.zeros((n, 3)), np.full(n, -1)
    end[0] = (0, 0, 1)
    for i in range(1, n):
        parent[i] = rng.integers(max(0, i - 8), i)
        start[i] = end[parent[i]] + rng.normal(0, 0.002, 3)
        end[i] = start[i] + rng.normal(0, 0.2, 3) + np.array([0, 0, 0.1])
    return tree_from_segments(start, end, rng.uniform(0.02, 0.04, n), parent=parent)


@pytest.fixture(scope='module')
def tree():
    return segments_in_all_directions()


def pair(tree, **changes):
    """Make a simulator on compiled kernels, and one in numpy."""
    sim = make_simulator(tree, model='full', gravity=0.0, **changes)
    return sim, make_simulator(tree, settings=sim.settings, plain=True)


@pytest.mark.parametrize('name', ['bench', pytest.param('wild', marks=pytest.mark.long)])
def test_two_hundred_random_steps_agree(tree, name):
    sim, twin = pair(tree if name == 'wild' else bench_tree())
    rng = np.random.default_rng(2)
    largest = 0.0
    for k in range(200):
        wind, dt = rng.normal(0, 3, 3), rng.choice([1 / 60, 1 / 30, 0.4])
        assert sim.step(wind, dt) == twin.step(wind, dt)
        if k % 10 == 9:
            assert np.abs(sim.place() - twin.place()).max() < 1e-9
            largest = max(largest, np.abs(sim.tip_displacement).max())
    assert largest > 0.01


def test_a_state_of_one_is_taken_by_the_other(tree):
    sim, twin = pair(tree)
    for k in range(30):
        sim.step([9.0, 4.0 * np.sin(k), 1.0], 1 / 60)
    twin.set_state(sim.state())
    for one in (sim, twin):
        one.step([5.0, 1.0, 0.0], 1 / 60)
    assert np.abs(sim.place() - twin.place()).max() < 1e-9
