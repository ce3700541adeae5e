# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The error of every model, told before a step is taken, against the truth."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.estimate import choose
from tree_sway_ros.core.fidelity.ladder import BEND, FidelityLadder, FLOOR, MARGIN
from tree_sway_ros.core.reference.articulated import ArticulatedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.wind.climate import WindClimate
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.study.example_trees import EXAMPLE_DENSITY, EXAMPLE_MODULUS, forked_tree, RATIOS
from tree_sway_ros.study.tip_error import record_tips

DAMPING = 0.05
WOOD = Species('example', 'example', EXAMPLE_MODULUS, EXAMPLE_DENSITY, damping_bare=DAMPING)
NO_WEIGHT = Settings(gravity=0.0)
RATE, SETTLED = 60, 180


@pytest.fixture(scope='module')
def ladder():
    return FidelityLadder(forked_tree(0.5, 0.6), WOOD, NO_WEIGHT)


@pytest.mark.parametrize(('length_ratio', 'diameter_ratio'), RATIOS)
def test_estimates_bound_the_true_error_and_are_not_idle(length_ratio, diameter_ratio):
    tree = forked_tree(length_ratio, diameter_ratio)
    wind = simulate_turbulence(
        4.0, rate=RATE, duration=7, rng=np.random.default_rng(5), height=10.0
    )
    ladder = FidelityLadder(tree, WOOD, NO_WEIGHT)
    truth = ArticulatedTree(
        tree, EXAMPLE_MODULUS, EXAMPLE_DENSITY, DAMPING, 1.2, subdivisions=2,
        twist_ratio=2.0 * WOOD.shear_ratio,
    )  # fmt: skip
    true_tips = record_tips(truth, tree, wind, 1.0 / RATE, substeps=2)[SETTLED:]
    effectivity, partly_frozen = [], 0
    for estimate in ladder.estimates(WindClimate.of_samples(wind, RATE)):
        model = SwaySimulator(
            tree, WOOD, NO_WEIGHT, model=estimate.model, n_modes=max(estimate.n_modes, 1),
            calibrated=ladder.calibrated(estimate),
        )  # fmt: skip
        assert model.n_frozen == estimate.n_frozen
        partly_frozen += 0 < estimate.n_frozen < tree.n_branches - 1
        tips = record_tips(model, tree, wind, 1.0 / RATE)[SETTLED:]
        error = np.sqrt(np.square(tips - true_tips).sum(axis=-1).mean())
        assert error <= estimate.error, estimate.name
        effectivity.append(error / estimate.error)
    assert np.median(effectivity) >= 0.3
    assert partly_frozen >= 3


def test_a_model_with_more_modes_errs_less(ladder):
    found = {e.name: e for e in ladder.estimates(WindClimate.steady(6.0, 0.3))}
    errors = [
        found[name].error for name in ('subtree', 'modes 3', 'modes 6', 'modes 12', 'coupled')
    ]
    assert errors == sorted(errors, reverse=True)
    assert found['frozen'].error > found['frozen'].motion


def test_the_more_is_frozen_the_less_it_costs_and_the_more_it_errs(ladder):
    estimates = ladder.estimates(WindClimate.steady(6.0, 0.3))
    modes = sorted(
        (e for e in estimates if e.name.startswith('modes 12')), key=lambda e: e.n_frozen
    )
    assert len(modes) >= 3
    assert [e.cost for e in modes] == sorted((e.cost for e in modes), reverse=True)
    assert modes[-1].cost < 0.7 * modes[0].cost
    assert modes[0].error < modes[-1].error


def test_the_better_models_are_told_to_err_more_where_the_tree_bends_far(ladder):
    def share(speed):
        found = {e.name: e for e in ladder.estimates(WindClimate.steady(speed, 0.2))}
        return found['coupled'].error / found['frozen'].error

    reach = float(np.linalg.norm(ladder.tree.end - ladder.tree.start[0], axis=1).max())
    frozen = next(
        e for e in ladder.estimates(WindClimate.steady(20.0, 0.2)) if e.model == 'frozen'
    )
    bent = BEND * frozen.error / MARGIN / reach
    assert bent > 0.005
    assert share(1.0) == pytest.approx(FLOOR / MARGIN, rel=0.02)
    assert share(20.0) == pytest.approx((FLOOR + bent) / MARGIN, rel=0.02)


def test_no_wind_needs_no_model(ladder):
    estimates = ladder.estimates(WindClimate.steady(0.0, 0.2))
    assert choose(estimates, tolerance=1e-9).model == 'frozen'
