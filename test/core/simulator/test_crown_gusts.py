# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model gets the same gusts limb by limb, and has them in its state."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree
from tree_sway_lab.validation.crooked_trees import crooked_tree
from tree_sway_lab.validation.truth import WOOD
from tree_sway_lab.validation.winds import turbulent

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.simulator.simulator import SwaySimulator

FRAME = 1.0 / 60.0


@pytest.fixture(scope='module')
def tree():
    return crooked_tree(4)


@pytest.mark.parametrize('model', ['branch', 'full'])
def test_numpy_meets_the_same_gusts(tree, model):
    settings = Settings(model=model, crown_coherence=0.5)
    sim = SwaySimulator(tree, WOOD, settings)
    twin = SwaySimulator(tree, WOOD, sim.settings, plain=True)
    for x in turbulent(6.0, 2.0, 1):
        sim.step(x, FRAME)
        twin.step(x, FRAME)
    assert sim.place() == pytest.approx(twin.place(), abs=1e-9)


@pytest.mark.parametrize('model', ['branch', 'full'])
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


def test_a_table_of_even_winds_takes_the_mean_of_the_limbs():
    tree = bench_tree()
    both = [make_simulator(tree, WOOD, model=20, crown_coherence=c) for c in (1.0, 0.5)]
    gust = np.vstack([np.tile([4.0, 0.0, 0.0], (600, 1)), np.tile([8.0, 0.0, 0.0], (30, 1))])
    for x in gust:
        for sim in both:
            sim.step(x, FRAME)
    even, late = (float(sim.tip_displacement[0]) for sim in both)
    assert 0.0 < late < even
