# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model meets the same gusts limb by limb, and keeps them in its state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.simulator.assembly import CalibratedTree
from tree_sway_ros.core.simulator.partly_frozen import PartlyFrozenTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.study.bench.bench_tree import bench_tree
from tree_sway_ros.study.tip_error import record_tips, tip_error
from tree_sway_ros.study.validation.crooked_trees import crooked_tree
from tree_sway_ros.study.validation.judge import WOOD
from tree_sway_ros.study.validation.winds import turbulent

FRAME = 1.0 / 60.0


@pytest.fixture(scope='module')
def tree():
    return crooked_tree(4)


def tips(tree, wind, model, coherence):
    sim = make_simulator(
        tree, WOOD, Settings(crown_coherence=coherence, twig_tolerance=-1.0), model=model
    )
    return record_tips(sim, tree, wind, FRAME)


def test_models_agree_with_every_segment_solved_in_gusts_limb_by_limb(tree):
    wind = turbulent(6.0, 8.0, 4)
    truth = tips(tree, wind, 'segments', 0.5)
    assert tip_error(tree, tips(tree, wind, 'coupled', 0.5), truth) < 0.08
    # The check can tell the two winds apart.
    assert tip_error(tree, tips(tree, wind, 'coupled', 1.0), truth) > 0.12


@pytest.mark.parametrize('model', ['branch', 'modes'])
def test_numpy_meets_the_same_gusts(tree, model):
    settings = Settings(model=model, crown_coherence=0.5)
    sim = SwaySimulator(tree, WOOD, settings)
    plain = CalibratedTree(tree, WOOD, sim.settings, plain=True)
    twin = SwaySimulator(tree, WOOD, sim.settings, calibrated=plain)
    for x in turbulent(6.0, 2.0, 1):
        sim.step(x, FRAME)
        twin.step(x, FRAME)
    assert sim.place() == pytest.approx(twin.place(), abs=1e-9)


@pytest.mark.parametrize('model', ['subtree', 'wind_basis', 'modes', 'segments'])
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


def test_frozen_branches_leave_the_delays_of_the_others(tree):
    whole = CalibratedTree(tree, WOOD, Settings())
    frozen = np.zeros(tree.n_branches, dtype=bool)
    limb = int(np.flatnonzero(tree.branch_parent == 0)[1])
    frozen[limb : tree.subtree_end[limb]] = True
    part = PartlyFrozenTree(whole, frozen)
    assert np.array_equal(part.crown_delays.of_branch, whole.crown_delays.of_branch[~frozen])


def test_a_table_of_even_winds_takes_the_mean_of_the_limbs():
    tree = bench_tree()
    both = [make_simulator(tree, WOOD, model='wind_basis', crown_coherence=c) for c in (1.0, 0.5)]
    gust = np.vstack([np.tile([4.0, 0.0, 0.0], (600, 1)), np.tile([8.0, 0.0, 0.0], (30, 1))])
    for x in gust:
        for sim in both:
            sim.step(x, FRAME)
    even, late = (float(sim.tip_displacement[0]) for sim in both)
    assert 0.0 < late < even


def test_models_of_a_change_have_felt_the_same_gusts(tree):
    settings = Settings(crown_coherence=0.5)
    sim = SwaySimulator(tree, WOOD, settings)
    better = SwaySimulator(tree, WOOD, replace(settings, model='coupled'))
    wind = turbulent(6.0, 3.0, 3)
    for x in wind:
        sim.step(x, FRAME)
    better.follow_wind(sim)
    assert np.array_equal(better.memory()[-4], sim.memory()[-4])
