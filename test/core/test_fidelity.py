"""The error of every rung, told before a step is taken, and the choice it leads to."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.fidelity import Estimate, FidelityLadder, choose, tolerance_in_metres
from tree_sway_ros.core.reference.articulated import ArticulatedTree
from tree_sway_ros.core.reference.example_trees import (
    EXAMPLE_DENSITY,
    EXAMPLE_MODULUS,
    RATIOS,
    forked_tree,
)
from tree_sway_ros.core.reference.measure import record_tips
from tree_sway_ros.core.settings import SimulatorSettings
from tree_sway_ros.core.simulator import SwaySimulator
from tree_sway_ros.core.species import Species
from tree_sway_ros.core.turbulence import simulate_turbulence
from tree_sway_ros.core.wind_climate import WindClimate
from tree_sway_ros.errors import ParameterError

DAMPING = 0.05
WOOD = Species("example", "example", EXAMPLE_MODULUS, EXAMPLE_DENSITY, damping_bare=DAMPING)
NO_WEIGHT = SimulatorSettings(gravity=0.0)
RATE, SETTLED = 60, 240
LADDER = (
    Estimate("frozen", 0, 0.05, 0.04, 5.0),
    Estimate("branch", 0, 0.04, 0.04, 10.0),
    Estimate("modes", 6, 0.004, 0.04, 20.0),
    Estimate("coupled", 0, 0.001, 0.04, 90.0),
)


def gusty(seconds: int) -> np.ndarray:
    return simulate_turbulence(
        4.0, rate=RATE, duration=seconds, rng=np.random.default_rng(5), height=10.0
    )


@pytest.mark.parametrize(("length_ratio", "diameter_ratio"), RATIOS)
def test_estimates_bound_the_true_error_and_are_not_idle(length_ratio, diameter_ratio):
    tree = forked_tree(length_ratio, diameter_ratio)
    wind = gusty(12)
    ladder = FidelityLadder(tree, WOOD, NO_WEIGHT)
    truth = ArticulatedTree(
        tree, EXAMPLE_MODULUS, EXAMPLE_DENSITY, DAMPING, 1.2, subdivisions=1, twist_ratio=1 / 1.3
    )
    true_tips = record_tips(truth, tree, wind, 1.0 / RATE, substeps=2)[SETTLED:]
    effectivity = []
    for estimate in ladder.estimates(WindClimate.of_samples(wind, RATE)):
        model = SwaySimulator(
            tree, WOOD, NO_WEIGHT, rung=estimate.rung, n_modes=max(estimate.n_modes, 1)
        )
        tips = record_tips(model, tree, wind, 1.0 / RATE)[SETTLED:]
        error = np.sqrt(np.square(tips - true_tips).sum(axis=-1).mean())
        assert error <= estimate.error, estimate.name
        effectivity.append(error / estimate.error)
    assert np.median(effectivity) >= 0.3


def test_a_rung_with_more_modes_errs_less():
    ladder = FidelityLadder(forked_tree(0.5, 0.6), WOOD, NO_WEIGHT)
    found = {e.name: e for e in ladder.estimates(WindClimate.steady(6.0, 0.3))}
    errors = [found[name].error for name in ("subtree", "modes 3", "modes 6", "modes 12", "coupled")]
    assert errors == sorted(errors, reverse=True)
    assert found["frozen"].error > found["frozen"].motion


def test_no_wind_needs_no_model():
    ladder = FidelityLadder(forked_tree(0.5, 0.6), WOOD, NO_WEIGHT)
    estimates = ladder.estimates(WindClimate.steady(0.0, 0.2))
    assert choose(estimates, tolerance=1e-9).rung == "frozen"


@pytest.mark.parametrize(
    ("tolerance", "budget", "name"),
    [
        (0.1, None, "frozen"),
        (0.045, None, "branch"),
        (0.01, None, "modes 6"),
        (0.002, None, "coupled"),
        (None, 15.0, "branch"),
        (None, 50.0, "modes 6"),
        (0.045, 50.0, "branch"),
    ],
)
def test_the_least_that_will_do(tolerance, budget, name):
    assert choose(LADDER, tolerance=tolerance, budget=budget).name == name


def test_what_nobody_can_meet_names_the_nearest():
    with pytest.raises(ParameterError, match=r"allow 0.001 m for 'coupled'"):
        choose(LADDER, tolerance=1e-4)
    with pytest.raises(ParameterError, match=r"allow 5 us for 'frozen'"):
        choose(LADDER, budget=1.0)


def test_pixels_become_metres():
    assert tolerance_in_metres(0.5, 20.0, 1000.0) == pytest.approx(0.01)
    with pytest.raises(ParameterError, match="above 0"):
        tolerance_in_metres(0.5, 0.0, 1000.0)
