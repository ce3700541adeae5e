# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Errors of every number of coordinates, known before a step, against what a step does."""

from __future__ import annotations

from itertools import pairwise

from drawn_trees import crown
import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.tree.tree import tips_of_poses
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.fidelity.climate import WindClimate
from tree_sway.fidelity.estimate import ErrorEstimator

DT = 1.0 / 60.0


@pytest.fixture(scope='module')
def sim():
    return make_simulator(crown())


@pytest.fixture(scope='module')
def estimator(sim):
    return ErrorEstimator(sim.banks[0])


def turbulent(speed, seed):
    return simulate_turbulence(speed, rate=60.0, duration=10.0, rng=np.random.default_rng(seed))


def climate_of(speed):
    wind = turbulent(speed, 1) if speed > 0.0 else np.zeros((600, 3))
    return WindClimate.of_samples(wind, 60.0)


@pytest.mark.parametrize('way', [(1, 0, 0), (0, 0, 1), (0, 0, -1)])
def test_fewer_coordinates_never_err_by_more_than_is_said(sim, estimator, way):
    """Set against all coordinates of the table, in wind from the side, up and down."""
    tree = sim.tree
    across = np.cross(way, [0.6, 0.8, 0.0])
    turn = np.stack([way, across, np.cross(way, across)])
    wind = turbulent(7.0, 1) @ turn
    climate = WindClimate.of_samples(wind, 60.0)
    said = {e.n_coordinates: e.error for e in estimator.estimates(climate)}
    oscillators, m = sim.banks[0].oscillators, sim.banks[0].oscillators.shapes.shape[1]
    found = {}
    for k in (*estimator.dial[1:-1], m):
        sim.reset()
        oscillators.show(np.zeros(m), k)
        tips = []
        for each in wind:
            sim.step(each, DT)
            tips.append(tips_of_poses(tree, sim.place()))
        found[k] = np.array(tips)
    truth = found.pop(m)
    moved = float(np.sqrt(np.square(truth - truth.mean(axis=0)).sum(axis=2).mean()))
    for k, tips in found.items():
        error = float(np.sqrt(np.square(tips - truth).sum(axis=2).mean()))
        assert error <= said[k], k
    assert moved > 0.0


def test_more_coordinates_err_less_and_cost_more(estimator):
    estimates = estimator.estimates(climate_of(6.0))
    assert [e.n_coordinates for e in estimates] == [0, 3, 6, 12, 20, 40, 60]
    errors, costs = [e.error for e in estimates], [e.cost for e in estimates]
    assert (np.diff(errors) < 0.0).all()
    assert (np.diff(costs) > 0.0).all()


def test_errors_rise_with_the_wind_and_with_its_turns(estimator):
    by_speed = [estimator.estimates(climate_of(v)) for v in (0.0, 3.0, 9.0, 18.0)]
    assert [e.error for e in by_speed[0]] == [0.0] * len(by_speed[0])
    for slow, fast in pairwise(by_speed[1:]):
        assert all(a.error < b.error for a, b in zip(slow, fast, strict=True))
        assert slow[0].turn < fast[0].turn


def test_still_air_and_a_wind_straight_up_is_no_calm(estimator):
    up = np.tile([0.0, 0.0, 6.0], (600, 1))
    estimates = estimator.estimates(WindClimate.of_samples(up, 60.0))
    assert estimates[0].error > 1e-3
    assert estimates[0].turn > 0.0


def test_estimates_are_those_of_the_tree_as_it_is_tuned():
    sim = make_simulator(crown(), model='auto')
    climate = climate_of(6.0)
    before = sim.estimates(climate)
    sim.tune(stiffness_factor=3.0)
    for _ in range(60):
        sim.step((2.0, 0.0, 0.0), DT)
    after = sim.estimates(climate)
    assert all(b.error < 0.6 * a.error for a, b in zip(before, after, strict=True))
