# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limp trees against segments that are solved: nearer than the table, in storms as well."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.kinds.shoots import Drawing, towards
from tree_sway_lab.tip_error import record_tips, roughness, tip_error
from tree_sway_lab.validation.trial import tried
from tree_sway_lab.validation.truth import FINE, QUICK, SETTINGS, true_model, true_tips, WOOD
from tree_sway_lab.validation.winds import FRAME, turbulent, wind_called

from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup import reduced_tree
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.setup.reductions import TreeReductions

UP = np.array([0.0, 0.0, 1.0])


def weeping(seed=11):
    """Draw a stem with six twigs of 1.4 m and 4 mm that hang from it."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(UP, 3.0, (0.05, 0.03), 5, wander=2.0)
    for k in range(6):
        to.shoot(
            towards(60.0 * k, 20.0), to.rng.uniform(1.2, 1.6), (0.004, 0.002), 6, on=stem,
            node=3 + k % 3, rise=-25.0, wander=3.0,
        )  # fmt: skip
    return to.tree('weeping')


def young_whip(seed=302):
    """Draw a stem of 2.4 m, 12 mm thick, with nine twigs of half a metre."""
    to = Drawing(np.random.default_rng(seed))
    stem = to.shoot(UP, 2.4, (0.012, 0.004), 12, wander=2.0)
    for k in range(9):
        to.shoot(
            towards(k * 137.5, to.rng.uniform(40.0, 60.0)), to.rng.uniform(0.4, 0.8),
            (0.0035, 0.0018), 6, on=stem, node=4 + k % 8, rise=2.0, wander=4.0,
        )  # fmt: skip
    return to.tree('young whip')


@cache
def limp_model() -> SwayModel:
    return prepare(weeping(), WOOD, SETTINGS, model=40, cache=None)


def limp_tree(**changes):
    return SwaySimulator(limp_model(), **changes)


def by_table():
    """Make the tree take the step of the table."""
    return SwaySimulator(limp_model().by_table())


@pytest.mark.parametrize('speed', [5.0, 9.0])
def test_it_is_nearer_to_the_truth_than_the_table(speed):
    wind = turbulent(speed, 3.0, 4)
    tree = weeping()
    truth = record_tips(true_model(tree, QUICK), tree, wind, FRAME, substeps=QUICK.substeps)
    error = tip_error(tree, record_tips(limp_tree(), tree, wind, FRAME), truth)
    table = tip_error(tree, record_tips(by_table(), tree, wind, FRAME), truth)
    print(f'{speed:g} m/s: error {error:.3f}, by the table {table:.3f}')
    assert error < 0.75 * table


def test_further_shapes_of_bent_twigs_do_not_rattle_in_short_steps():
    """They do if the drag is implicit by its damping at rest, where these shapes move the tree."""
    tree, wind = weeping(), turbulent(15.0, 3.0, 4)
    truth = true_tips(tree, wind, FINE)
    sim = make_simulator(tree, WOOD, replace(SETTINGS, model=40, enrich='carriers'))
    tips = record_tips(sim, tree, wind, FRAME, substeps=4)[: len(truth)]
    assert roughness(tips, truth) < 1.2
    assert tip_error(tree, tips, truth) < 0.1


@pytest.mark.parametrize(('tree', 'most_error'), [(weeping(3), 0.13), (young_whip(), 0.03)])
def test_it_does_not_rattle_at_60_hz(tree, most_error):
    """It does where coordinates are kept that are far faster than a frame."""
    wind = turbulent(15.0, 3.0, 4)
    truth = true_tips(tree, wind, FINE)
    tips = record_tips(make_simulator(tree, WOOD, SETTINGS), tree, wind, FRAME)[: len(truth)]
    assert 0.8 < roughness(tips, truth) < 1.2
    assert tip_error(tree, tips, truth) < most_error


def test_gusts_reach_its_limbs_one_after_another():
    """As they reach those of the reference."""
    wind = turbulent(7.0, 10.0, 5)

    def effect(model):
        whole, apart = (
            record_tips(
                make_simulator(weeping(), WOOD, SETTINGS, model=model, crown_coherence=coherence),
                weeping(), wind, FRAME,
            )
            for coherence in (1.0, 0.3)
        )  # fmt: skip
        return tip_error(weeping(), apart, whole)

    assert effect(40) == pytest.approx(effect('full'), rel=0.2)


def test_each_segment_has_the_gust_that_reaches_its_limb():
    """And not a load that is added to that of a uniform wind."""
    tree = kind_called('whips')
    tips = [
        record_tips(
            make_simulator(tree, WOOD, SETTINGS, model=model, crown_coherence=0.3), tree,
            turbulent(9.0, 4.0, 3), FRAME,
        )
        for model in (60, 'full')
    ]  # fmt: skip
    assert tip_error(tree, *tips) < 0.03


@pytest.mark.parametrize('kind', ['reeds 201', 'shoots 202', 'whips 203', 'bamboo 204'])
@pytest.mark.parametrize('speed', ['25', '40'])
def test_it_moves_in_storms_as_the_truth_does(kind, speed):
    one = tried(kind, speed, 'default', QUICK if speed == '25' else FINE)
    print(one)
    assert one.error < 0.2
    assert 0.7 < one.roughness < 1.5
    assert one.lowest > one.true_lowest - 0.05
    assert one.stride < 1.25 * one.true_stride
    assert one.clamped < 5


@pytest.mark.long
@pytest.mark.parametrize('kind', ['willow 301', 'birch 301'])
def test_hanging_twigs_move_in_a_storm_as_the_truth_does(kind):
    """They moved too smoothly in three pieces a twig."""
    one = tried(kind, '25', 'default', FINE)
    print(one)
    assert one.error < 0.2
    assert 0.68 < one.roughness < 1.2
    assert one.clamped == 0


@pytest.mark.parametrize('kind', ['birch', 'whips'])
def test_no_twig_outruns_a_storm_that_comes_at_once(kind):
    tree, wind = kind_called(kind), wind_called('80', 0.5)
    truth = record_tips(true_model(tree, QUICK), tree, wind[:3], FRAME, substeps=QUICK.substeps)
    tips = record_tips(make_simulator(tree, WOOD, SETTINGS), tree, wind, FRAME)
    moves = [np.linalg.norm(np.diff(each, axis=0), axis=2) for each in (truth, tips)]
    assert moves[0].max() > 0.5
    assert moves[1][:2].max() < 1.1 * moves[0].max()
    assert moves[1].max() < 80.0 * FRAME


@pytest.mark.parametrize('model', [60, 'full'])
def test_twigs_that_their_own_stiffness_shapes_get_a_further_pair(model, monkeypatch):
    def count(kind):
        settings = replace(SETTINGS, model=model)
        return TreeReductions(
            kind_called(kind), WOOD, settings
        ).with_subtrees.reduction.n_coordinates

    kinds = 'birch', 'whips', 'willow'
    shaped = [count(kind) for kind in kinds]
    monkeypatch.setattr(reduced_tree, 'STRUNG', 0.0)
    plain = [count(kind) for kind in kinds]
    assert [a > b for a, b in zip(shaped, plain, strict=True)] == [True, True, False]
