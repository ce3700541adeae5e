# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The two forms of the equation say the same; their derivatives are those of differences."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods import minimal_form, multiplier_form
from tree_sway_lab.methods.chain import PlanarChain, single_segment, uniform_chain
from tree_sway_lab.methods.minimal import rk4
from tree_sway_lab.methods.operation_count import plain
from tree_sway_lab.methods.registry import method_named, METHODS

from tree_sway.errors import ParameterError

THETA, OMEGA = np.array([0.3, -0.5, 0.9]), np.array([1.0, -2.0, 0.5])
LOAD = np.array([[1.0, 2.0], [-0.5, 1.0], [0.2, 0.4]])
LAM = np.array([1.0, -2.0, 0.3, 0.7, -1.1, 0.4])


@pytest.fixture(scope='module')
def table():
    return uniform_chain(3, 2.0, 0.05).table


def derivative(f, at, h=1e-6):
    columns = [(f(at + h * e) - f(at - h * e)) / (2 * h) for e in np.eye(len(at))]
    return np.stack(columns, -1)


def test_accelerations_and_reactions_agree_between_the_forms(table):
    q, v = multiplier_form.place(table, THETA, OMEGA)
    accel, lam = multiplier_form.index1(table, q, v, LOAD, 0.0, 0.0)
    assert accel[2::3] == pytest.approx(
        minimal_form.acceleration(table, THETA, OMEGA, LOAD), rel=1e-10
    )
    reactions = minimal_form.reactions(table, THETA, OMEGA, LOAD)
    assert lam.reshape(3, 2) == pytest.approx(reactions, rel=1e-10)


@pytest.mark.parametrize('name', METHODS)
def test_every_form_recovers_the_joint_reaction(name):
    chain, method, load = single_segment(), method_named(name), np.array([[1.0, 3.0]])
    state = method.start(chain, np.array([0.4]), np.array([2.0]), load, 1e-3)
    m, _, c = chain.table[0, :3]
    a = minimal_form.acceleration(chain.table, np.array([0.4]), np.array([2.0]), load)[0]
    cos, sin = np.cos(0.4), np.sin(0.4)
    centre = c * np.array([-sin * a - cos * 4, cos * a - sin * 4])
    assert method.reactions(chain, state, load)[0] == pytest.approx(
        load[0] - m * centre, rel=1e-12
    )


def test_one_segment_is_the_papers_equation():
    row = single_segment(2.0, 0.05).table
    m, j, c, _, k1, k2 = row[0]
    px, py, angle, rate = 1.5, -2.0, 0.7, 3.0
    moment = c * (py * np.cos(angle) - px * np.sin(angle)) - k1 * angle - k2 * rate
    got = minimal_form.acceleration(row, np.array([angle]), np.array([rate]), np.array([[px, py]]))
    assert got[0] == pytest.approx(moment / (j + m * c * c), rel=1e-14)


def test_linearisation_against_differences(table):
    lin = minimal_form.linearised(table, THETA, OMEGA, LOAD)
    by_angle = derivative(lambda x: minimal_form.acceleration(table, x, OMEGA, LOAD), THETA)
    by_rate = derivative(lambda x: minimal_form.acceleration(table, THETA, x, LOAD), OMEGA)
    scale = np.abs(by_angle).max()
    assert lin[:, 1:4] == pytest.approx(by_angle, abs=1e-7 * scale)
    assert lin[:, 4:] == pytest.approx(by_rate, abs=1e-7 * scale)


def test_constraint_jacobians_against_differences(table):
    q, v = multiplier_form.place(table, THETA, OMEGA)
    g = multiplier_form.jacobian(table, q)
    assert np.abs(multiplier_form.constraint(table, q)).max() < 1e-15
    assert g @ v == pytest.approx(np.zeros(6), abs=1e-14)
    assert g == pytest.approx(
        derivative(lambda x: multiplier_form.constraint(table, x), q), abs=1e-8
    )
    rate = derivative(lambda x: multiplier_form.jacobian(table, x) @ v, q)[:, 2::3]
    assert multiplier_form.jacobian_rate(table, q, v) == pytest.approx(rate, abs=1e-7)
    slope = derivative(lambda x: multiplier_form.jacobian(table, x).T @ LAM, q)
    diagonal = np.zeros((9, 9))
    diagonal[range(2, 9, 3), range(2, 9, 3)] = multiplier_form.multiplier_slope(table, q, LAM)
    assert slope == pytest.approx(diagonal, abs=1e-7)


def test_the_two_references_agree(swaying):
    """Radau on multipliers and Runge-Kutta on angles in long double, at a twentieth."""
    step, steps = plain(rk4.step), 2400
    state = np.zeros((4, 1), np.longdouble)
    chain, dt = swaying.chain.astype(np.longdouble), np.longdouble(1) / steps
    times = (np.arange(steps)[:, None] + np.array([0, 0.5, 1])) / steps
    loads = swaying.wind(times.ravel()).reshape(steps, 3, 1, 2).astype(np.longdouble)
    for load in loads:
        step(chain.table, state, load, dt, None)
    assert abs(float(state[0, 0]) - swaying.truth.theta[-1, 0]) <= 1e-9


def test_the_chain_knows_its_modes_and_refuses_what_cannot_move():
    chain = uniform_chain(6, 2.0, 0.05)
    assert chain.frequencies[0] == pytest.approx(2 * np.pi * 2.0)
    assert chain.frequencies.shape == (6,)
    with pytest.raises(ParameterError, match='shape'):
        PlanarChain(np.zeros((2, 5)))
    with pytest.raises(ParameterError, match='segment 0: no inertia'):
        PlanarChain(np.array([[0.0, 0.0, 0.5, 1.0, 1.0, 0.0]]))
