# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The noise of a sensor is found with what the coordinates of its filter cannot have."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.twin.missed_motion import missed_noise
from tree_sway.twin.steady_filter import sway_law

DT, COUNT = 1.0 / 60.0, 3600
LAW = sway_law(np.array([30.0, 90.0]), np.array([0.5, 0.8]), 9.0 * np.eye(2), 1.0, DT)
SENSED = np.random.default_rng(21).normal(size=(6, 6))
NOISE = np.full(6, 0.2)


def measured(noise: Floats) -> Floats:
    """Measurements of a sway by the law, (n, p), with a noise."""
    rng = np.random.default_rng(22)
    step, state, found = LAW.matrix, np.zeros(6), np.empty((COUNT, 6))
    for row in found:
        state = step @ state
        state[4:] += np.sqrt(np.diag(LAW.driven)) * rng.normal(size=2)
        row[:] = SENSED @ state + noise * rng.normal(size=6)
    return found


def test_without_more_it_is_the_noise_of_the_samples() -> None:
    found = missed_noise(LAW, SENSED, NOISE, NOISE, measured(NOISE))
    assert found == pytest.approx(NOISE, rel=0.05)


def test_it_is_found_for_each_quantity() -> None:
    true = NOISE * np.repeat([1.0, 8.0], 3)
    found = missed_noise(LAW, SENSED, NOISE, NOISE, measured(true))
    assert found == pytest.approx(true, rel=0.15)


def test_a_fast_mode_of_its_own_counts_as_noise() -> None:
    own = np.zeros((COUNT, 6))
    own[:, 0] = 2.0 * np.sin(2.0 * np.pi * 7.0 * DT * np.arange(COUNT))
    found = missed_noise(LAW, SENSED, NOISE, NOISE, measured(NOISE) + own)
    missed = np.square(found) - np.square(NOISE)
    power = np.square(own[:, :3]).mean()
    assert 0.5 * power < missed[0] < power
    assert np.abs(missed[3:]).max() < 0.1


def test_it_becomes_less_again() -> None:
    found = missed_noise(LAW, SENSED, NOISE, 10.0 * NOISE, measured(NOISE))
    assert found == pytest.approx(NOISE, rel=0.3)


def test_few_measurements_leave_what_was_found_before() -> None:
    found = missed_noise(LAW, SENSED, NOISE, 3.0 * NOISE, measured(NOISE)[:299])
    np.testing.assert_array_equal(found, 3.0 * NOISE)
    np.testing.assert_array_equal(missed_noise(LAW, SENSED, NOISE, NOISE, np.zeros((0, 6))), NOISE)


def test_a_push_is_little_noise() -> None:
    pushed = measured(NOISE)
    pushed[2000:2600] += 40.0
    found = missed_noise(LAW, SENSED, NOISE, NOISE, pushed)
    assert (found < 5.0 * NOISE).all()  # 80 by the mean of all squares


def test_measurements_that_are_missing_are_left_out() -> None:
    known = measured(NOISE)
    known[1500, 4] = np.nan
    found = missed_noise(LAW, SENSED, NOISE, NOISE, known)
    assert found == pytest.approx(NOISE, rel=0.1)
