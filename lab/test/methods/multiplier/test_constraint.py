# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How each method on the paper's coordinates holds the joints together, or fails to."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods import multiplier_form as form
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.multiplier.baumgarte import Baumgarte
from tree_sway_lab.methods.multiplier.index3_newton import solve_index3
from tree_sway_lab.methods.multiplier.project import project_position, project_velocity
from tree_sway_lab.methods.multiplier.projection import Projection
from tree_sway_lab.methods.registry import method_named, METHODS
from tree_sway_lab.methods.trajectory import integrate

CHAIN = uniform_chain(2, 1.0, 0.0)
MASS = CHAIN.table[:, [0, 0, 1]].ravel()
THETA, OMEGA = np.array([0.4, 0.9]), np.array([1.0, -3.0])
LOAD = np.array([[1.0, 2.0], [-0.5, 1.0]])
CLAMPED = ('projection', 'rattle', 'radau_ggl', 'newmark', 'generalized_alpha')


def run(method, seconds, dt=0.01):
    loads = np.zeros((round(seconds / dt), len(method.nodes), 2, 2))
    return integrate(method, CHAIN, loads, dt, theta=THETA, omega=OMEGA).state


def speed_gap(state):
    return np.abs(form.jacobian(CHAIN.table, state[0]) @ state[1]).max()


@pytest.mark.parametrize('name', CLAMPED)
def test_positions_stay_on_the_constraint_to_rounding(name):
    method = method_named(name)
    assert method.gap(CHAIN, run(method, 5.0)) < 1e-12


@pytest.mark.parametrize('name', ['projection', 'rattle', 'radau_ggl'])
def test_velocities_too_where_the_method_says_so(name):
    assert speed_gap(run(method_named(name), 5.0)) < 1e-11


def test_a_bare_index_1_form_drifts():
    drift = [
        method_named('multiplier_rk4').gap(CHAIN, run(method_named('multiplier_rk4'), t))
        for t in (4, 16)
    ]
    assert drift[1] > 4 * drift[0] > 1e-9
    by_velocity = Projection(position=False)
    assert 1e-10 < by_velocity.gap(CHAIN, run(by_velocity, 16)) < drift[1]
    assert speed_gap(run(by_velocity, 4)) < 1e-11
    assert speed_gap(run(Projection(velocity=False), 4)) > 1e-9


@pytest.mark.parametrize('base', ['rk4', 'semi_implicit_euler'])
def test_baumgarte_heals_a_gap_at_the_pace_of_its_gains(base):
    """With alpha = beta the gap is critically damped: (1 + alpha t) e^(-alpha t)."""
    dt, method = 1e-3, Baumgarte(alpha=0.02, beta=0.02, base=base)
    state = method.start(CHAIN, np.zeros(2), np.zeros(2), np.zeros((2, 2)), dt)
    state[0, 1] += 1e-5
    start = form.constraint(CHAIN.table, state[0])
    options = method.options(CHAIN, dt)
    assert options[:2] == pytest.approx([20.0, 20.0])
    for _ in range(100):
        type(method).kernel(CHAIN.table, state, np.zeros((3, 2, 2)), dt, options)
    expected = (1 + 2.0) * np.exp(-2.0) * start
    assert form.constraint(CHAIN.table, state[0]) == pytest.approx(
        expected, abs=2e-2 * np.abs(start).max()
    )


def test_projection_is_the_shortest_way_in_the_mass_metric():
    method = method_named('projection')
    state = method.start(CHAIN, THETA, OMEGA, LOAD, 0.01)
    state[0] += 1e-3 * np.cos(np.arange(6.0))
    state[1] += 0.1 * np.sin(np.arange(6.0))
    before = state.copy()
    assert 1 < project_position(CHAIN.table, state) < 10
    assert method.gap(CHAIN, state) < 1e-13
    g = form.jacobian(CHAIN.table, state[0])
    # The way there has, to first order, no part along the motions that the joints allow.
    free = np.linalg.svd(g)[2][4:]
    assert free @ (MASS * (state[0] - before[0])) == pytest.approx(0.0, abs=1e-6)
    project_velocity(CHAIN.table, state)
    assert g @ state[1] == pytest.approx(0.0, abs=1e-13)
    assert free @ (MASS * (state[1] - before[1])) == pytest.approx(0.0, abs=1e-13)
    stored = state.copy()
    project_velocity(CHAIN.table, state)
    assert state == pytest.approx(stored, abs=1e-13), 'once there, it stays'


def test_index_3_solution_satisfies_its_equations():
    chain, h = uniform_chain(2, 1.0, 0.3), 0.02
    q, v = form.place(chain.table, THETA, OMEGA)
    accel, lam = np.zeros(6), np.zeros(4)
    args = (chain.table, q, 0.25 * h * h, v, 0.5 * h, q + h * v, 0.5 * h * h)
    assert 1 < solve_index3(*args, LOAD, accel, lam) < 10
    q1, v1 = q + 0.25 * h * h * accel, v + 0.5 * h * accel
    pull = form.jacobian(chain.table, q1).T @ lam
    assert MASS * accel + pull == pytest.approx(form.forces(chain.table, q1, v1, LOAD), abs=1e-8)
    assert form.constraint(chain.table, q + h * v + 0.5 * h * h * accel) == pytest.approx(
        0.0, abs=1e-13
    )
    assert solve_index3(*args, LOAD * np.nan, accel, lam) == -1


@pytest.mark.parametrize('name', ['newmark', 'generalized_alpha', 'radau_ggl'])
def test_a_step_that_fails_is_reported_and_leaves_the_state(name):
    method = method_named(name)
    state = method.start(CHAIN, THETA, OMEGA, LOAD, 0.01)
    before = state.copy()
    loads = np.full((len(method.nodes), 2, 2), np.nan)
    assert type(method).kernel(CHAIN.table, state, loads, 0.01, method.options(CHAIN, 0.01)) == -1
    assert np.array_equal(state, before)


def test_rattle_runs_backwards():
    method = METHODS['rattle']()
    state = method.start(CHAIN, THETA, OMEGA, LOAD, 0.01)
    for _ in range(2):
        for _ in range(50):
            method.kernel(
                CHAIN.table, state, np.stack([LOAD, LOAD]), 0.01, method.options(CHAIN, 0.01)
            )
        moved = method.angles(state).copy()
        state[1] *= -1.0
    assert moved == pytest.approx(THETA, abs=1e-10)
    assert method.rates(state) == pytest.approx(OMEGA, abs=1e-9)
