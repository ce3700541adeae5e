# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree that turns its dial: up at once, down slowly, and never a step in the picture."""

from __future__ import annotations

from drawn_trees import crown
import numpy as np
import pytest

from tree_sway.core.run.outcome import Outcome
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.errors import ParameterError, StateError
from tree_sway.fidelity.adaptive import LEAVE_IN, REVIEW
from tree_sway.fidelity.climate import WindClimate

DT = 1.0 / 60.0
TREE = crown()


def adaptive(tolerance, **changes):
    return make_simulator(TREE, tolerance=tolerance, model='auto', **changes)


def turbulent(speed, seconds, seed=0):
    rng = np.random.default_rng(seed)
    return simulate_turbulence(speed, rate=60.0, duration=seconds, rng=rng)


def number(sim):
    return sim.choice.n_coordinates


def test_the_tolerance_chooses_the_number():
    numbers = [number(adaptive(tolerance)) for tolerance in (10.0, 0.03, 0.01, 1e-9)]
    assert numbers[0] == 0
    assert numbers[-1] == 60
    assert numbers == sorted(numbers)
    assert len(set(numbers)) > 2


def test_a_budget_comes_before_the_tolerance():
    sim = adaptive(1e-9, budget=1e-3)
    assert number(sim) == 0
    few, *_, most = sim.estimates(WindClimate.of_samples(turbulent(8.0, 3.0), 60.0))
    for wind in turbulent(8.0, 3.0):
        sim.step(wind, DT)
    sim.budget = 0.5 * (few.cost + most.cost)
    sim.review(at_best=True)
    assert 0 < number(sim) < 60
    assert sim.frame_cost <= sim.budget
    sim.cost_scale = 2.0
    sim.review()
    assert number(sim) == 0


def test_a_gust_from_calm_is_met_at_once_and_the_picture_does_not_jump():
    sim, truth = adaptive(0.02), make_simulator(TREE)
    for _ in range(round(70.0 / DT)):
        sim.step((0.5, 0.0, 0.0), DT), truth.step((0.5, 0.0, 0.0), DT)
    assert number(sim) < 6
    before, tips = number(sim), []
    for k in range(120):
        wind = (0.5 if k < 30 else 12.0, 0.0, 0.0)
        sim.step(wind, DT), truth.step(wind, DT)
        tips.append([tips_of_poses(TREE, each.place()) for each in (sim, truth)])
        if k == 30:
            assert number(sim) > before
    steps = np.linalg.norm(np.diff(np.array(tips), axis=0), axis=-1).max(axis=(0, 2))
    assert steps[0] <= 1.2 * steps[1]
    assert np.abs(tips[-1][0] - tips[-1][1]).max() < 1e-6


def test_it_goes_down_slowly_and_unseen():
    sim = adaptive(0.004)
    for wind in turbulent(10.0, 10.0):
        sim.step(wind, DT)
    high = number(sim)
    assert high > 12
    left, largest, last = None, 0.0, None
    for k in range(round(90.0 / DT)):
        sim.step((1.0, 0.0, 0.0), DT)
        if k >= round(20.0 / DT):
            tips = tips_of_poses(TREE, sim.place())
            largest = max(largest, 0.0 if last is None else float(np.abs(tips - last).max()))
            last = tips
        if left is None and number(sim) < high:
            left = k * DT
    assert number(sim) < high
    assert left is not None
    assert left > REVIEW
    assert largest < 5e-4


def test_wind_straight_up_moves_it_and_is_in_its_estimate():
    sim, truth = adaptive(0.003), make_simulator(TREE)
    for k in range(600):
        wind = (0.0, 0.0, 0.0 if k < 120 else 6.0)
        sim.step(wind, DT), truth.step(wind, DT)
    assert sim.choice.n_coordinates > 0
    assert sim.choice.error > 0.0
    moved = np.abs(truth.place()[:, :3] - TREE.start).max()
    assert moved > 1e-3
    tips = [tips_of_poses(TREE, each.place()) for each in (sim, truth)]
    assert np.sqrt(np.square(tips[0] - tips[1]).sum(axis=1).mean()) <= sim.choice.error


@pytest.mark.parametrize('changes', [
    {'stiffness_factor': 1.5}, {'gravity': 3.0}, {'damping_ratio': 0.3},
])  # fmt: skip
def test_a_change_reaches_what_sways_and_what_is_estimated(changes):
    sim = adaptive(1e-9)
    plain = make_simulator(TREE)
    for each in (sim, plain):
        each.tune(**changes)
    for wind in turbulent(5.0, 3.0):
        sim.step(wind, DT), plain.step(wind, DT)
    assert sim.place() == pytest.approx(plain.place(), abs=1e-12)
    tunable = sim.banks[0].oscillators.tunable
    assert sim._estimator._stiffness == pytest.approx(tunable.stiffness)
    assert sim._estimator._own_damping == pytest.approx(tunable.damping)


def test_a_motion_that_is_not_finite_is_counted_and_goes_on_from_rest():
    sim = adaptive(0.005)
    sim.step((5.0, 0.0, 0.0), DT)
    sim.banks[0].oscillators.swing[0][:] = np.nan
    assert sim.step((5.0, 0.0, 0.0), DT) & Outcome.RESTARTED
    assert sim.counts.restarted == 1
    assert np.isfinite(sim.place()).all()


def test_a_state_goes_on_bit_for_bit_in_the_midst_of_a_change():
    sim, other = adaptive(0.006), adaptive(0.006)
    wind = np.vstack([turbulent(2.0, 4.0), turbulent(12.0, 1.0)])
    for each in wind[:270]:
        sim.step(each, DT)
    other.set_state(sim.state())
    assert (other.place() == sim.place()).all()
    with pytest.raises(StateError):
        make_simulator(TREE).set_state(sim.state())


def test_reset_is_back_to_the_expected_wind():
    sim = adaptive(0.006)
    first = number(sim)
    for wind in turbulent(14.0, 3.0):
        sim.step(wind, DT)
    sim.reset()
    assert number(sim) == first
    assert np.abs(sim.place()[:, :3] - TREE.start).max() < 1e-12
    assert LEAVE_IN > 0.0


@pytest.mark.parametrize('name', ['tolerance', 'budget'])
def test_a_demand_that_is_no_number_is_named(name):
    with pytest.raises(ParameterError, match='is not a number'):
        make_simulator(TREE, model='auto', **{name: 'a'})
