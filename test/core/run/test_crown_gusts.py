# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model gets the same gusts limb by limb, and has them in its state."""

from __future__ import annotations

from drawn_trees import crown, WOOD
import numpy as np
import pytest
from simulators import FULL, turbulence

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.scene.scene import Scene

FRAME = 1.0 / 60.0


@pytest.fixture(scope='module')
def tree():
    return crown()


@pytest.mark.parametrize('model', ['branch', 20, *FULL])
def test_a_state_goes_on_bit_for_bit(model):
    tree = crown()
    sim, other = (make_simulator(tree, WOOD, model=model, crown_coherence=0.6) for _ in range(2))
    wind = turbulence(5.0, 3.0, 2)
    for x in wind[:90]:
        sim.step(x, FRAME)
    other.set_state(sim.state())
    for x in wind[90:]:
        sim.step(x, FRAME)
        other.step(x, FRAME)
    assert np.array_equal(sim.place(), other.place())


def test_trees_of_a_scene_meet_them_too(tree):
    alone = make_simulator(tree, WOOD, model=20, crown_coherence=0.3)
    two = [PlacedTree('one', tree, species=WOOD), PlacedTree('two', tree, 6.0, species=WOOD)]
    scene = Scene(two).simulator(model=20, crown_coherence=0.3)
    for x in turbulence(6.0, 2.0, 1):
        alone.step(x, FRAME)
        scene.step(x, FRAME)
    assert np.array_equal(scene.place()[: tree.n_segments], alone.place())
