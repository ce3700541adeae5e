# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The implicit stage: its solution satisfies it, or it says so."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.minimal.newton import MAX_ITERATIONS, solve_stage
from tree_sway_lab.methods.minimal_form import acceleration
from tree_sway_lab.methods.registry import method_named

CHAIN = uniform_chain(3, 2.0, 0.05)
LOAD = np.array([[1.0, 2.0], [-0.5, 1.0], [0.2, 0.4]])


@pytest.mark.parametrize('step', [1e-3, 1 / 60, 0.05])
def test_the_solution_satisfies_the_stage(step):
    base, base_rate = np.array([0.1, 0.2, -0.1]), np.array([1.0, 0.0, -2.0])
    theta, omega = base.copy(), base_rate.copy()
    iterations = solve_stage(CHAIN.table, base, base_rate, LOAD, step, theta, omega)
    assert 1 <= iterations < MAX_ITERATIONS
    assert theta == pytest.approx(base + step * omega, abs=1e-14)
    accel = acceleration(CHAIN.table, theta, omega, LOAD)
    assert omega == pytest.approx(base_rate + step * accel, abs=1e-9)


def test_a_good_guess_is_worth_iterations():
    """Several iterations from rest; from the solution, two at most."""
    base, rate = np.zeros(3), np.zeros(3)
    theta, omega = np.zeros(3), np.zeros(3)
    assert solve_stage(CHAIN.table, base, rate, LOAD, 0.1, theta, omega) > 2
    assert solve_stage(CHAIN.table, base, rate, LOAD, 0.1, theta, omega) <= 2


@pytest.mark.parametrize('name', ['implicit_midpoint', 'tr_bdf2', 'bdf2'])
def test_what_cannot_be_solved_is_reported_and_leaves_the_state(name):
    method = method_named(name)
    state = method.start(CHAIN, np.full(3, 0.1), np.zeros(3), LOAD, 0.01)
    before, options = state.copy(), method.options(CHAIN, 0.01)
    loads = np.full((len(method.nodes), 3, 2), np.nan)
    assert type(method).kernel(CHAIN.table, state, loads, 0.01, options) == -1
    np.testing.assert_array_equal(state, before)
    loads[:] = LOAD
    assert type(method).kernel(CHAIN.table, state, loads, 0.01, options) > 0
