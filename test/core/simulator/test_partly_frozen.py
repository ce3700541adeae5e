# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees with frozen branches, stepped against the same with none."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.partly_frozen import PartlyFrozenTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.study.example_trees import forked_tree
from tree_sway_ros.study.tip_error import record_tips, tip_error

OAK = species_named('oak')
DT = 1.0 / 60.0
SETTINGS = Settings(n_modes=6)


@pytest.fixture(scope='module')
def whole():
    return CalibratedTree(forked_tree(0.5, 0.6), OAK, SETTINGS)


@pytest.fixture(scope='module')
def wind():
    return simulate_turbulence(6.0, rate=60, duration=4, rng=np.random.default_rng(1), height=10.0)


def tips(calibrated, whole, wind, model):
    sim = SwaySimulator(whole.tree, OAK, SETTINGS, model=model, calibrated=calibrated)
    return sim, record_tips(sim, whole.tree, wind, DT)


@pytest.mark.parametrize('model', ['branch', 'subtree', 'modes', 'coupled'])
def test_nothing_frozen_changes_nothing(whole, wind, model):
    none = PartlyFrozenTree(whole, np.zeros(whole.tree.n_branches, bool))
    _, before = tips(whole, whole, wind[:60], model)
    _, after = tips(none, whole, wind[:60], model)
    np.testing.assert_allclose(after, before, atol=1e-12)


@pytest.mark.parametrize('model', ['subtree', 'modes', 'coupled'])
def test_frozen_twigs_cost_two_percent_of_the_motion(whole, wind, model):
    tree = whole.tree
    twigs = tree.subtree_end - np.arange(tree.n_branches) == 1
    sim, after = tips(PartlyFrozenTree(whole, twigs), whole, wind, model)
    _, before = tips(whole, whole, wind, model)
    assert (sim.n_frozen, sim.n_solved, sim.n_copied) == (27, 13, 0)
    assert 0.001 < tip_error(tree, after, before) < 0.02


def test_all_frozen_but_the_stem(whole, wind):
    alone = PartlyFrozenTree(whole, np.ones(whole.tree.n_branches, bool))
    sim, _ = tips(alone, whole, wind[:60], 'coupled')
    assert sim.n_solved == 1
    assert sim.mass == pytest.approx(SwaySimulator(whole.tree, OAK, SETTINGS).mass)
    assert np.isfinite(sim.place()).all()
    assert np.abs(sim.tip_displacement).max() > 1e-3
    sim.reset()
    np.testing.assert_allclose(sim.place()[:, :3], whole.tree.start, atol=1e-12)
