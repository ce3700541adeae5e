# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The gains against scipy's Riccati solver, and the estimates against a motion that is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import linalg

from tree_sway.twin.steady_filter import (
    predicted_covariance,
    stationary_covariance,
    steady_filter,
    sway_law,
    SwayLaw,
    told_shares,
)

M, DT = 5, 1.0 / 60.0
NOISE = np.array([0.02, 0.05, 0.1])


@pytest.fixture
def law() -> SwayLaw:
    rng = np.random.default_rng(4)
    root = rng.normal(size=(M, M))
    return sway_law(np.geomspace(9.0, 400.0, M), np.linspace(0.4, 2.0, M), root @ root.T, 0.6, DT)


@pytest.fixture
def sensed() -> np.ndarray:
    return np.random.default_rng(5).normal(size=(3, 3 * M))


def driven(law: SwayLaw) -> np.ndarray:
    whole = np.zeros((3 * M, 3 * M))
    whole[2 * M :, 2 * M :] = law.driven
    return whole


def test_the_law_is_the_exponential_of_the_equation_of_motion() -> None:
    law = sway_law(np.array([30.0]), np.array([0.8]), np.eye(1), 0.5, DT)
    motion = np.array([[0.0, 1.0, 0.0], [-30.0, -0.8, 1.0], [0.0, 0.0, 0.0]])
    exact = linalg.expm(DT * motion)
    exact[2, 2] = np.exp(-DT / 0.5)
    np.testing.assert_allclose(law.matrix, exact, atol=1e-14)
    np.testing.assert_allclose(law.ahead(7)[:, :, 0], np.linalg.matrix_power(exact, 7))


def test_the_covariance_is_that_of_scipy(law: SwayLaw, sensed: np.ndarray) -> None:
    found = predicted_covariance(law.matrix, sensed, driven(law), NOISE)
    noise = np.diag(np.square(NOISE))
    known = linalg.solve_discrete_are(law.matrix.T, sensed.T, driven(law), noise)
    np.testing.assert_allclose(found, known, rtol=1e-9, atol=1e-12 * np.abs(known).max())


def test_the_covariance_without_sensors_is_that_of_scipy(law: SwayLaw) -> None:
    known = linalg.solve_discrete_lyapunov(law.matrix, driven(law))
    np.testing.assert_allclose(stationary_covariance(law), known, rtol=1e-8)


def test_a_sensor_of_one_coordinate_tells_nothing_of_those_it_shares_no_force_with(
    law: SwayLaw,
) -> None:
    apart = SwayLaw(law.step, np.diag(np.diag(law.driven)))
    one = np.zeros((1, 3 * M))
    one[0, 2] = 1.0
    gains = steady_filter(apart, one, NOISE[:1])
    told = told_shares(gains, apart, NOISE[:1])
    alone = np.diag(linalg.solve_discrete_lyapunov(apart.matrix, driven(apart)))
    assert told[2] == pytest.approx(1.0 - gains.covariance[2, 2] / alone[2], rel=1e-6)
    assert told[2] > 0.05
    np.testing.assert_allclose(np.delete(told, 2), 0.0, atol=1e-8)


def test_gains_for_a_shared_force_do_harm_where_each_coordinate_has_its_own(
    law: SwayLaw,
) -> None:
    whole = np.ones((M, M)) + 1e-3 * np.eye(M)
    shared, apart = (SwayLaw(law.step, each) for each in (whole, np.diag(np.diag(whole))))
    one = np.zeros((1, 3 * M))
    one[0, 0] = 1.0
    noise = np.array([1e-3])
    gains = steady_filter(shared, one, noise)
    believed, told = (told_shares(gains, each, noise) for each in (shared, apart))
    assert believed.min() > 0.5
    assert told[0] > 0.5
    assert told[1:].max() < 0.0
    # The state and its estimate as one system.
    step, gain = apart.matrix, gains.gain @ one
    kept = np.eye(3 * M) - gain
    both = np.block([[step, np.zeros_like(step)], [gain @ step, kept @ step]])
    by_force = np.vstack([np.eye(3 * M), gain])
    by_noise = np.vstack([np.zeros_like(gains.gain), gains.gain]) * noise
    added = by_force @ driven(apart) @ by_force.T + by_noise @ by_noise.T
    found = linalg.solve_discrete_lyapunov(both, added)
    error = np.hstack([np.eye(3 * M), -np.eye(3 * M)])
    left = np.diag(error @ found @ error.T)[:M]
    np.testing.assert_allclose(told, 1.0 - left / np.diag(found)[:M], rtol=1e-6)


def test_errors_are_as_large_as_the_covariance_says(law: SwayLaw, sensed: np.ndarray) -> None:
    noise = 10.0 * NOISE
    sensed = np.hstack([np.zeros((3, M)), sensed[:, M : 2 * M], np.zeros((3, M))])
    gains = steady_filter(law, sensed, noise)
    rng = np.random.default_rng(6)
    root = np.linalg.cholesky(law.driven)
    true, found = np.zeros(3 * M), np.zeros(3 * M)
    errors = []
    for _ in range(20_000):
        true = law.matrix @ true
        true[2 * M :] += root @ rng.normal(size=M)
        found = law.matrix @ found
        innovation = sensed @ (true - found) + noise * rng.normal(size=3)
        found = found + gains.gain @ innovation
        errors.append(found - true)
    measured = np.sqrt(np.mean(np.square(errors[500:]), axis=0))
    np.testing.assert_allclose(measured, np.sqrt(np.diag(gains.covariance)), rtol=0.15)
