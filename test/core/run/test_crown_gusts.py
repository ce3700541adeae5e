# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model gets the same gusts limb by limb, and has them in its state."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.bench.sizes import against
from tree_sway_lab.validation.crooked_trees import crooked_tree
from tree_sway_lab.validation.truth import WOOD
from tree_sway_lab.validation.winds import turbulent

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene
from tree_sway.core.settings import Settings

FRAME = 1.0 / 60.0


@pytest.fixture(scope='module')
def tree():
    return crooked_tree(4)


@pytest.mark.parametrize('model', ['branch', 'full', 20])
def test_a_state_goes_on_bit_for_bit(model):
    tree = bench_tree()
    sim, other = (make_simulator(tree, WOOD, model=model, crown_coherence=0.6) for _ in range(2))
    wind = turbulent(5.0, 3.0, 2)
    for x in wind[:90]:
        sim.step(x, FRAME)
    other.set_state(sim.state())
    for x in wind[90:]:
        sim.step(x, FRAME)
        other.step(x, FRAME)
    assert np.array_equal(sim.place(), other.place())


@pytest.mark.parametrize('speed', [3.0, 9.0])
def test_a_table_meets_the_gusts_limb_by_limb(tree, speed):
    settings = Settings(crown_coherence=0.3)
    full, table = (make_simulator(tree, WOOD, settings, model=each) for each in ('full', 60))
    wind = turbulent(speed, 12.0, 3)
    assert against(table, full, wind) < 0.03  # 0.3 to 0.5 with the mean of the limbs' winds


def test_trees_of_a_scene_meet_them_too(tree):
    alone = make_simulator(tree, WOOD, model=20, crown_coherence=0.3)
    two = [PlacedTree('one', tree, species=WOOD), PlacedTree('two', tree, 6.0, species=WOOD)]
    scene = Scene(two).simulator(model=20, crown_coherence=0.3)
    for x in turbulent(6.0, 2.0, 1):
        alone.step(x, FRAME)
        scene.step(x, FRAME)
    assert np.array_equal(scene.place()[: tree.n_segments], alone.place())
