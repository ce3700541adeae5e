# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The strength of unknown forces is told from motion by forces of a known one, beside noise."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.twin.gust_strength import BeyondModel, strength_of, UsualLaw
from tree_sway.twin.steady_filter import sway_law

DT, NOISE = 1.0 / 60.0, 0.5
LAW = UsualLaw(np.full(1, 39.5), np.full(1, 0.6), np.eye(1), 2.0, 1.0, DT)
ROWS = np.zeros((2, 3, 1))
ROWS[:, 0] = 10.0
"""East and north motion of 10 times the displacement of a coordinate of 1 Hz."""


def moved(strength: float, count: int) -> Floats:
    """Displacement of the coordinate by forces of a strength, (n,)."""
    law = sway_law(LAW.stiffness, LAW.damping, strength * LAW.covariance, LAW.time_constant, DT)
    driven = np.sqrt(law.driven[0, 0]) * np.random.default_rng(3).normal(size=count)
    step, state, found = law.matrix, np.zeros(3), np.empty(count)
    for k in range(count):
        state = step @ state
        state[2] += driven[k]
        found[k] = state[0]
    return found


@pytest.mark.parametrize('noise', [0.0, NOISE])
@pytest.mark.parametrize('strength', [0.1, 0.6, 5.0])
def test_the_strength_is_that_of_the_forces_and_not_of_the_noise(
    strength: float, noise: float
) -> None:
    sway = 10.0 * moved(strength, 36_000)
    noisy = noise * np.random.default_rng(4).normal(size=(len(sway), 2))
    found = strength_of([BeyondModel(sway[:, None] + noisy, ROWS, noise)], LAW)
    assert found == pytest.approx(min(strength, 1.0), rel=0.3)


def test_nothing_measured_leaves_the_usual_strength() -> None:
    assert strength_of([BeyondModel(np.zeros((0, 2)), ROWS, NOISE)], LAW) == 1.0
