# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Models that change unseen."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.adaptive import (
    AdaptiveSimulator,
    CROSS_FADE,
    HAND_OVER,
    REVIEW,
    RUN_IN,
)
from tree_sway_ros.core.fidelity.ladder import LADDER
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.study.example_trees import forked_tree

DT = 1.0 / 60.0
WOOD = Species('example', 'example', 8e9, 900.0, damping_bare=0.08)


@pytest.fixture(scope='module')
def made():
    return AdaptiveSimulator(forked_tree(0.5, 0.6), WOOD, Settings(gravity=0.0))


@pytest.fixture
def adaptive(made):
    """Give the one simulator, as new, with other demands."""

    def asked(tolerance, budget=0.0):
        made.tolerance, made.budget, made.pace = tolerance, budget, 1.0
        made.counts.refused = 0
        made.reset()
        return made

    return asked


def test_a_far_tree_stands_still_and_a_near_one_is_solved(adaptive):
    assert adaptive(10.0).model == 'frozen'
    assert adaptive(0.01).model in ('modes', 'coupled')


def test_within_a_loose_tolerance_branches_are_frozen(adaptive):
    sim = adaptive(0.02)
    assert 0 < sim.n_frozen < 39
    assert sim.n_solved + sim.n_copied + sim.n_frozen == 40
    assert sim.choice.error <= 0.02


def test_a_budget_comes_before_the_tolerance(adaptive):
    free = adaptive(1e-9).choice
    tight = adaptive(1e-9, budget=0.5 * free.cost).choice
    assert tight.cost <= 0.5 * free.cost
    assert free.error < tight.error < free.motion
    assert adaptive(0.1, budget=free.cost).choice.cost < tight.cost
    assert adaptive(1e-9, budget=1e-3).model == 'frozen'


def test_a_slower_machine_can_afford_less(adaptive):
    sim = adaptive(1e-9, budget=30.0)
    before = sim.choice
    sim.pace = 2.0
    sim.reset()
    assert sim.frame_cost <= 30.0
    assert sim.choice.error > before.error


def test_a_smaller_budget_changes_the_model_without_a_step(adaptive):
    sim = adaptive(1e-9)
    for _ in range(300):
        sim.step((5.0, 1.0, 0.0), DT)
    sim.budget = budget = 0.5 * sim.frame_cost
    frames = []
    for _ in range(int((REVIEW + RUN_IN + CROSS_FADE) / DT) + 2):
        sim.step((5.0, 1.0, 0.0), DT)
        frames.append(sim.place()[:, :3].copy())
    assert sim.choice.cost <= budget
    np.testing.assert_array_equal(sim.place(), sim.shown.place())  # nothing fades
    assert sim.n_frozen > 0
    assert np.linalg.norm(np.diff(frames, axis=0), axis=2).max() < 1e-3


def test_a_tolerance_nobody_can_meet_takes_the_best(adaptive):
    assert adaptive(1e-9).model == 'coupled'


def test_coming_nearer_changes_the_model_without_a_step(adaptive):
    sim = adaptive(10.0)
    wind = simulate_turbulence(
        5.0, rate=60, duration=40, rng=np.random.default_rng(3), height=10.0
    )
    frames, changed_at = [], None
    for i, w in enumerate(wind):
        if i == 1200:
            sim.tolerance = 0.004
        sim.step(w, DT)
        frames.append(sim.place().copy())
        if changed_at is None and sim.model != 'frozen':
            changed_at = i
    assert changed_at is not None
    assert (changed_at - 1200) * DT <= REVIEW + 2 * DT
    moves = np.linalg.norm(np.diff(np.array(frames)[:, :, :3], axis=0), axis=2).max(axis=1)
    shown_as_it_is = changed_at + round(HAND_OVER / DT) + 1
    fading, afterwards = moves[changed_at - 2 : shown_as_it_is], moves[shown_as_it_is:]
    assert fading.max() <= afterwards.max() + 1e-3


@pytest.mark.parametrize(('before', 'after'), [(0.0, 10.0), (3.0, 12.0)])
def test_a_gust_is_met_at_once(adaptive, before, after):
    sim = adaptive(0.005)
    full = SwaySimulator(sim.tree, WOOD, Settings(gravity=0.0), model='coupled')
    for _ in range(20 * 60):
        sim.step((before, 0.0, 0.0), DT)
        full.step((before, 0.0, 0.0), DT)
    at_rest = sim.place()[:, :3].copy()
    gap, sway, moves = [], [], []
    for _ in range(4 * 60):
        sim.step((after, 0.0, 0.0), DT)
        full.step((after, 0.0, 0.0), DT)
        here, there = sim.place()[:, :3].copy(), full.place()[:, :3].copy()
        gap.append(np.linalg.norm(sim.tip_displacement - full.tip_displacement))
        sway.append(np.linalg.norm(full.tip_displacement))
        moves.append((np.abs(here - at_rest).max(), there))
        at_rest = here
    assert (np.array(gap) <= 0.1 * np.array(sway))[18:].all()
    true_moves = np.abs(np.diff([there for _, there in moves], axis=0)).max(axis=(1, 2))
    assert (np.array([move for move, _ in moves[1:]]) <= true_moves + 1e-3).all()


def test_an_unforeseen_gust_is_met_by_the_best_model_within_the_budget(adaptive):
    met = {}
    for budget in (0.0, 15.0):
        sim = adaptive(0.05, budget=budget)
        for speed, seconds in ((1.0, 20), (7.0, 1)):
            for _ in range(seconds * 60):
                sim.step((speed, 0.0, 0.0), DT)
        met[budget] = sim.choice
    assert met[0.0].name == 'coupled'
    assert met[15.0].error > met[0.0].error
    assert met[15.0].cost <= 15.0


def test_gusts_of_the_same_size_as_before_are_left_to_the_tolerance(adaptive):
    sim, names = adaptive(0.5), set()
    for second in range(40):
        for _ in range(60):
            sim.step((6.0 if second % 10 == 0 else 2.0, 0.0, 0.0), DT)
        if second >= 15:
            names.add(sim.choice.name)
    assert 'coupled' not in names


def test_a_gust_that_goes_leaves_the_model_for_a_while(adaptive):
    sim = adaptive(0.05)
    for speed, seconds in ((0.5, 20), (10.0, 2), (0.5, 5)):
        for _ in range(seconds * 60):
            sim.step((speed, 0.0, 0.0), DT)
        if seconds == 2:
            met = sim.model
    best_first = [model for model, *_ in LADDER]
    assert best_first.index(sim.model) <= best_first.index(met) < best_first.index('frozen')


def test_poses_stay_rotations_while_they_fade(adaptive):
    sim = adaptive(0.004)
    for _ in range(60):
        sim.step((6.0, 1.0, 0.0), DT)
    sim.tolerance = 10.0
    for _ in range(int((REVIEW + RUN_IN - 1.0 + 0.5 * CROSS_FADE) / DT)):
        sim.step((6.0, 1.0, 0.0), DT)
    assert not np.array_equal(sim.place(), sim.shown.place()), 'two models are mixed'
    np.testing.assert_allclose(np.linalg.norm(sim.place()[:, 3:], axis=1), 1.0, atol=1e-12)


def test_a_wind_on_the_border_does_not_flicker(adaptive):
    sim = adaptive(0.01)
    rng = np.random.default_rng(4)
    changes, before = 0, sim.choice.name
    for _ in range(60):
        for _ in range(60):
            sim.step((6.0 + 0.3 * rng.standard_normal(), 0.0, 0.0), DT)
        changes += sim.choice.name != before
        before = sim.choice.name
    assert changes <= 2


def test_reset_and_bad_wind_as_in_one_simulator(adaptive):
    sim = adaptive(0.05)
    rest = sim.place().copy()
    assert sim.step((np.nan, 0.0, 0.0), DT) == 1
    assert sim.counts.refused == 1
    for _ in range(60):
        sim.step((5.0, 0.0, 0.0), DT)
    sim.reset()
    np.testing.assert_array_equal(sim.place(), rest)


def test_counts_only_grow_whatever_models_come_and_go(adaptive):
    sim = adaptive(10.0)
    before, models = (sim.counts.steps, sim.counts.refused, sim.counts.held), set()
    start = before
    for second in range(40):
        sim.tolerance = 10.0 if second % 20 < 5 else 0.01
        for step in range(60):
            sim.step((np.nan if step == 7 else 6.0, 0.0, 0.0), DT)
            models.add(sim.model)
            now = (sim.counts.steps, sim.counts.refused, sim.counts.held)
            assert all(new >= old for new, old in zip(now, before, strict=True))
            before = now
    assert len(models) > 1
    assert (before[0] - start[0], before[1] - start[1]) == (40 * 60, 40)
