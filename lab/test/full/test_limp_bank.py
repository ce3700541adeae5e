# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model `full` of a limp tree is nearer to the truth than fewer coordinates are."""

from dataclasses import replace

import numpy as np
import pytest
from tree_sway_lab.full.bank import FullBank
from tree_sway_lab.full.limp_bank import LimpFullBank
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.kinds.shoots import Drawing, towards
from tree_sway_lab.tip_error import record_tips, roughness, tip_error
from tree_sway_lab.validation.truth import FINE, SETTINGS, true_tips, WOOD
from tree_sway_lab.validation.winds import FRAME, turbulent

from tree_sway.core.scene.make import make_simulator


def weeping():
    """Draw a stem with three twigs of 1.4 m and 4 mm that hang from it."""
    to = Drawing(np.random.default_rng(11))
    stem = to.shoot(np.array([0.0, 0.0, 1.0]), 3.0, (0.05, 0.03), 4, wander=2.0)
    for k in range(3):
        to.shoot(
            towards(120.0 * k, 20.0), to.rng.uniform(1.2, 1.6), (0.004, 0.002), 5, on=stem,
            node=2 + k % 2, rise=-25.0, wander=3.0,
        )  # fmt: skip
    return to.tree('weeping')


def full(tree, **changes):
    return make_simulator(tree, WOOD, replace(SETTINGS, model='full', **changes))


def bank_of(sim):
    bank = sim.banks[0].oscillators
    assert isinstance(bank, LimpFullBank)
    return bank


@pytest.mark.parametrize(
    ('kind', 'most'),
    [('whips', 0.06), pytest.param('birch', 0.06, marks=pytest.mark.long)],
)
def test_it_is_nearer_to_the_truth_than_the_default(kind, most):
    tree = kind_called(kind)
    wind = turbulent(15.0, 2.0, 5)
    truth = true_tips(tree, wind, FINE)
    tips, fewer = (
        record_tips(sim, tree, wind, FRAME)[: len(truth)]
        for sim in (full(tree), make_simulator(tree, WOOD, SETTINGS))
    )
    error = tip_error(tree, tips, truth)
    print(f'{kind}: error {error:.3f}, of the default {tip_error(tree, fewer, truth):.3f}')
    assert error < min(most, tip_error(tree, fewer, truth))
    assert 0.8 < roughness(tips, truth) < 1.2


def test_the_force_on_each_branch_is_that_of_the_load_on_branches():
    sim = full(weeping())
    for _ in range(3):
        sim.step((2.0, 0.5, 0.0), FRAME)
    bank = bank_of(sim)
    at_pose = bank.forces()
    other = FullBank(bank.branches, sim.models[0])
    other.set_step(FRAME)
    other.take_over(*bank.motion())
    other.advance(2.0, 0.5, 0.0)
    by_branch = other.forces()
    np.testing.assert_allclose(at_pose[0], by_branch[0], rtol=0.05, atol=1e-3)
    assert np.linalg.norm(at_pose[1:]) == pytest.approx(np.linalg.norm(by_branch[1:]), rel=0.1)


@pytest.mark.parametrize('speed', [15.0, 40.0])
def test_it_begins_anew_after_a_reset(speed):
    sim = full(weeping())
    wind = turbulent(speed, 1.0, 2)
    first = record_tips(sim, weeping(), wind, FRAME)
    sim.reset()
    np.testing.assert_array_equal(record_tips(sim, weeping(), wind, FRAME), first)
    assert sim.counts.restarted == 0


def test_gusts_reach_its_limbs_one_after_another():
    wind = turbulent(7.0, 2.0, 5)
    whole, apart = (
        record_tips(full(weeping(), crown_coherence=coherence), weeping(), wind, FRAME)
        for coherence in (1.0, 0.3)
    )
    assert tip_error(weeping(), apart, whole) > 0.02
