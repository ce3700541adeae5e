# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Accelerations under constraints that repeat, contradict nothing and may be none the wiser."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.multiplier_form import (
    forces,
    index1,
    jacobian,
    jacobian_rate,
    place,
)
from tree_sway_lab.methods.redundant import solve_regularised


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), copies=st.integers(0, 3))
def test_any_repetition_gives_the_same_accelerations(seed, copies):
    rng = np.random.default_rng(seed)
    mass, g, force = rng.uniform(0.5, 2.0, 6), rng.normal(size=(2, 6)), rng.normal(size=6)
    bias = rng.normal(size=2)
    mix = np.vstack([np.eye(2), rng.normal(size=(copies, 2))])
    saddle = np.block([[np.diag(mass), g.T], [g, np.zeros((2, 2))]])
    expected = np.linalg.solve(saddle, [*force, *bias])
    accel, lam = solve_regularised(mass, mix @ g, force, mix @ bias)
    assert accel == pytest.approx(expected[:6], abs=1e-6)
    assert (mix @ g).T @ lam == pytest.approx(g.T @ expected[6:], abs=1e-6)


def test_the_multipliers_are_the_smallest_that_fit():
    g = np.array([[1.0, 0.0], [2.0, 0.0], [0.0, 0.0]])
    accel, lam = solve_regularised(np.ones(2), g, np.array([5.0, 1.0]), np.zeros(3))
    assert accel == pytest.approx([0.0, 1.0], abs=1e-9)
    assert lam == pytest.approx([1.0, 2.0, 0.0], abs=1e-6), '5 along (1, 2) / 5'


def test_a_chain_with_every_joint_said_twice_moves_as_the_chain():
    chain = uniform_chain(3, 2.0, 0.05)
    theta, omega = np.array([0.2, 0.5, -0.3]), np.array([1.0, -1.0, 2.0])
    load = np.array([[1.0, 0.0], [0.0, 2.0], [0.5, 0.5]])
    q, v = place(chain.table, theta, omega)
    expected, _ = index1(chain.table, q, v, load, 0.0, 0.0)
    g, bias = jacobian(chain.table, q), -jacobian_rate(chain.table, q, v) @ omega
    mass = chain.table[:, [0, 0, 1]].ravel()
    force = forces(chain.table, q, v, load)
    accel, _ = solve_regularised(mass, np.vstack([g, g]), force, np.tile(bias, 2))
    assert accel == pytest.approx(expected, rel=1e-8)
    rough, _ = solve_regularised(
        mass, np.vstack([g, g]), force, np.tile(bias, 2), relative=1e-3, rounds=1
    )
    assert np.abs(rough - expected).max() > 1e-5, 'the corrections do the work'
