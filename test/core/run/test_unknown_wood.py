# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The expected sway is that of all wood at once: as far in the mean, less at its frequencies."""

from __future__ import annotations

from typing import Any

from drawn_trees import crown
import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.run.bank import Tunable
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import WOOD_SPREAD

TREE = crown((4, 2), 4)
FAR: dict[str, Any] = {'anemometer_distance': 12.0}


def damping(sim: SwaySimulator) -> Floats:
    """Damping of the coordinates."""
    return sim.banks[0].oscillators.tunable.damping.copy()


def response(frequency: float, stiffness: Floats | float, ratio: float) -> complex:
    """Return the mean response of modes of stiffness about 1 at a frequency over theirs."""
    root = np.sqrt(stiffness)
    each = 1.0 / (stiffness - frequency**2 + 2j * ratio * root * frequency)
    return complex(np.mean(each))


@pytest.mark.parametrize('ratio', [0.02, 0.05, 0.2])
def test_a_mode_responds_as_the_mean_of_all_wood(ratio: float) -> None:
    tunable = Tunable(np.ones(1), np.full(1, 2.0 * ratio), 1.0, np.zeros(1), np.zeros(1))
    tunable.spread_wood(WOOD_SPREAD)
    mean_ratio = 0.5 * float(tunable.damping[0])
    wood = np.exp(WOOD_SPREAD * np.random.default_rng(1).normal(size=20_000))
    for frequency in (1e-3, 1.0, 3.0):
        wanted = response(frequency, wood, ratio)
        found = response(frequency, 1.0, mean_ratio)
        assert abs(found - wanted) < 0.12 * abs(wanted)
    assert abs(response(1.0, 1.0, ratio)) > 1.15 * abs(response(1.0, wood, ratio))


def test_only_the_expected_sway_of_a_tree_apart_is_of_unknown_wood() -> None:
    own = damping(make_simulator(TREE))
    expected = make_simulator(TREE, **FAR)
    assert (damping(expected) > 1.5 * own).all()
    np.testing.assert_allclose(expected.banks[0].oscillators.tunable.of_wood, own)
    others: tuple[dict[str, Any], ...] = {'gusts': 'sample'}, {'gusts': 'measured'}
    for other in others:
        np.testing.assert_array_equal(damping(make_simulator(TREE, **FAR, **other)), own)


def test_a_tuned_tree_keeps_what_stands_for_unknown_wood() -> None:
    tuned = make_simulator(TREE, **FAR)
    made, ratio = damping(tuned), tuned.check_tuning().damping_ratio
    tuned.tune(damping_ratio=2.0 * ratio)
    for _ in range(60):
        tuned.step((3.0, 0.0, 0.0), 1.0 / 60.0)
    added = damping(tuned) - made
    np.testing.assert_allclose(added, damping(make_simulator(TREE)), rtol=1e-6)
    tuned.banks[0].oscillators.tunable.spread_wood(0.0)
    np.testing.assert_allclose(damping(tuned), 2.0 * damping(make_simulator(TREE)), rtol=1e-6)
