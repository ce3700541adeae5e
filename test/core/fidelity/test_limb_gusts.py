# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Estimates where gusts reach the crown limb by limb."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway_ros.core.fidelity.ladder import FidelityLadder
from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.wind.climate import WindClimate
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.study.example_trees import EXAMPLE_DENSITY, EXAMPLE_MODULUS
from tree_sway_ros.study.tip_error import record_tips
from tree_sway_ros.study.validation.crooked_trees import crooked_tree

WOOD = Species('example', 'example', EXAMPLE_MODULUS, EXAMPLE_DENSITY, damping_bare=0.05)
LIMB_WISE = Settings(twig_tolerance=-1.0, crown_coherence=0.3)
RATE = 60.0


@pytest.fixture(scope='module')
def tree():
    return crooked_tree(1)


@pytest.fixture(scope='module')
def ladder(tree):
    return FidelityLadder(tree, WOOD, LIMB_WISE)


def test_estimates_bound_the_error_in_gusts_limb_by_limb(tree, ladder):
    wind = simulate_turbulence(
        6.0, rate=RATE, duration=6.0, rng=np.random.default_rng(2), height=10.0
    )
    truth = make_simulator(
        tree, WOOD, model='segments', crown_coherence=0.3, damping_ratio=0.05, in_leaf=False
    )
    true_tips = record_tips(truth, tree, wind, 1.0 / RATE)
    shares = []
    for estimate in ladder.estimates(WindClimate.of_samples(wind, RATE)):
        model = SwaySimulator(
            tree, WOOD, LIMB_WISE, model=estimate.model, n_modes=max(estimate.n_modes, 1),
            calibrated=ladder.calibrated(estimate),
        )  # fmt: skip
        tips = record_tips(model, tree, wind, 1.0 / RATE)
        error = np.sqrt(np.square(tips - true_tips).sum(axis=-1).mean())
        assert error <= estimate.error, estimate.name
        shares.append(error / estimate.error)
    assert np.median(shares) >= 0.3


def test_limbs_by_themselves_move_tips_that_an_even_wind_moves_together(tree, ladder):
    whole = FidelityLadder(tree, WOOD, replace(LIMB_WISE, crown_coherence=1.0))
    slow = WindClimate.steady(6.0, 0.3, integral_time=1e4)
    quick = WindClimate.steady(6.0, 0.3, integral_time=0.3)
    for climate, least, most in ((slow, 0.97, 1.001), (quick, 0.3, 0.95)):
        limb_wise, even = (
            max(of.estimates(climate), key=lambda e: e.error).motion for of in (ladder, whole)
        )
        assert least < limb_wise / even < most
