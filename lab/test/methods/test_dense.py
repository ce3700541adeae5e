# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Small dense algebra against numpy and scipy, compiled and plain."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from tree_sway_lab.methods.dense import exponential, multiply, solve
from tree_sway_lab.methods.operation_count import plain
from tree_sway_lab.methods.redundant import solve_regularised


@pytest.mark.parametrize('run', [solve, plain(solve)])
def test_solve_agrees_with_numpy(run):
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(7, 7)), rng.normal(size=(7, 2))
    a[0, 0] = 0.0  # needs a pivot
    expected = np.linalg.solve(a, b)
    assert run(a.copy(), b)
    assert b == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize('entry', [0.0, np.nan])
def test_a_singular_matrix_is_reported(entry):
    assert not solve(np.full((3, 3), entry), np.ones((3, 1)))


@pytest.mark.parametrize('scale', [1e-6, 0.3, 8.0])
def test_exponential_agrees_with_scipy(scale):
    a = scale * np.random.default_rng(2).normal(size=(5, 5))
    expected = expm(a)
    assert exponential(a) == pytest.approx(expected, abs=1e-12 * np.abs(expected).max())


def test_repeated_constraints_share_the_multiplier():
    mass, g = np.array([1.0, 2.0]), np.array([[1.0, 1.0], [1.0, 1.0]])
    accel, lam = solve_regularised(mass, g, np.array([3.0, 0.0]), np.zeros(2))
    assert g @ accel == pytest.approx([0.0, 0.0], abs=1e-12)
    assert mass * accel + g.T @ lam == pytest.approx([3.0, 0.0], abs=1e-12)
    assert lam[0] == pytest.approx(lam[1])


@pytest.mark.parametrize('run', [multiply, plain(multiply)])
def test_products_agree_with_numpy_zeros_or_not(run):
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(4, 6)), rng.normal(size=(4, 3))
    square = a @ a.T
    square[1] = 0.0
    b[:, 2] = 0.0
    assert run(square, b) == pytest.approx(square @ b, rel=1e-13)


def test_an_exponential_of_rotation_is_a_turn_whatever_the_angle():
    for angle in (1e-9, 1.0, 40.0):
        turn = exponential(np.array([[0.0, -angle], [angle, 0.0]]))
        expected = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        assert turn == pytest.approx(np.array(expected), abs=1e-12)
