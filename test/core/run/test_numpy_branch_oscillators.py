# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The compiled simulator and the one in numpy: two programs, one motion.

Where nothing is compiled both are the same, and only what numpy does is tested.

"""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.core.growth.builtin import builtin_tree
from tree_sway.core.run.simulator import LOAD_CLAMPED
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.static_responses import WindMoments
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
    return tree_from_segments(start, end, rng.uniform(0.006, 0.02, n), parent=parent)


@pytest.fixture(scope='module')
def tree():
    return segments_in_all_directions()


def pair(tree, model, **changes):
    """Make a simulator on compiled kernels, and one in numpy."""
    sim = make_simulator(tree, model=model, gravity=0.0, **changes)
    return sim, make_simulator(tree, settings=sim.settings, plain=True)


@pytest.mark.parametrize(
    ('name', 'model'),
    [
        ('wild', 'branch'),
        pytest.param('bench', 'branch', marks=pytest.mark.long),
    ],
)
def test_two_hundred_random_steps_agree(tree, name, model):
    sim, twin = pair(tree if name == 'wild' else bench_tree(), model)
    rng = np.random.default_rng(2)
    largest = 0.0
    for k in range(200):
        wind, dt = rng.normal(0, 3, 3), rng.choice([1 / 60, 1 / 30, 0.4])
        assert sim.step(wind, dt) == twin.step(wind, dt)
        if k % 10 == 9:
            assert np.abs(sim.place() - twin.place()).max() < 1e-9
            largest = max(largest, np.abs(sim.tip_displacement).max())
    assert largest > 0.01


@pytest.mark.parametrize('model', ['branch'])
def test_a_tree_of_many_twigs_agrees(model):
    sim, twin = pair(builtin_tree('benjamina'), model)
    for k in range(60):
        wind = (6.0, np.sin(k), 0.5)
        assert sim.step(wind, 1 / 60) == twin.step(wind, 1 / 60)
    assert np.abs(sim.place() - twin.place()).max() < 1e-9


def test_they_agree_where_loads_are_held(tree):
    sim, twin = pair(tree, 'branch')
    clamped = 0
    for k in range(20):
        wind = [145.0, 30.0 * np.sin(k), 5.0]
        status = sim.step(wind, 1 / 60)
        assert twin.step(wind, 1 / 60) == status
        clamped += status == LOAD_CLAMPED
    # Beyond a radian the kernel's polynomials are right to 3e-9 of a sine, not to rounding.
    assert np.abs(sim.place() - twin.place()).max() < 1e-6
    assert clamped > 0
    assert sim.counts == twin.counts


@pytest.mark.parametrize('enrich', ['none', 'carriers', 'all'])
def test_placing_agrees_for_every_kind_of_coordinate(tree, enrich):
    sim, twin = pair(tree, 12, enrich=enrich)
    for k in range(20):
        sim.step([9.0, 4.0 * np.sin(k), 1.0], 1 / 30)
        placed = twin.place_rotations(sim.rotations())
        assert np.abs(sim.place() - placed).max() < 1e-9
    assert np.abs(sim.tip_displacement).max() > 1e-3


@pytest.mark.parametrize('model', ['branch'])
def test_a_state_of_one_is_taken_by_the_other(tree, model):
    sim, twin = pair(tree, model)
    for k in range(30):
        sim.step([9.0, 4.0 * np.sin(k), 1.0], 1 / 60)
    twin.set_state(sim.state())
    for one in (sim, twin):
        one.step([5.0, 1.0, 0.0], 1 / 60)
    assert np.abs(sim.place() - twin.place()).max() < 1e-9


@pytest.mark.compiled
def test_moments_of_even_winds_are_those_that_a_tree_at_rest_bears():
    load = WindMoments(make_simulator(bench_tree(), model=12).banks[0].branches)
    moments, still = load.at_rest(np.eye(3), np.eye(load.n)), np.zeros(load.n)
    for wind, moment in zip(np.eye(3), moments, strict=True):
        assert moment == pytest.approx(load(still, still, wind), rel=1e-9, abs=1e-12)
