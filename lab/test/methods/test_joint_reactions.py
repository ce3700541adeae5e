# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Newton's laws on the whole chain: force and moment at the joints, power, virtual work."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods import minimal_form, multiplier_form
from tree_sway_lab.methods.chain import PlanarChain, uniform_chain
from tree_sway_lab.methods.minimal.held_moment import rest_moment
from tree_sway_lab.methods.registry import method_named, METHODS
from tree_sway_lab.methods.trajectory import integrate

N = 4
RNG = np.random.default_rng(7)
CHAIN = PlanarChain(RNG.uniform(0.3, 2.0, (N, 6)))
TABLE = CHAIN.table
THETA, OMEGA, LOAD = RNG.normal(size=N), RNG.normal(size=N), RNG.normal(size=(N, 2))
# Newmark's multipliers ring from step to step for ever.
ON_CONSTRAINT = [
    name for name, kind in METHODS.items() if kind.form == 'multiplier' and name != 'newmark'
]


def along_the_motion(f, h=1e-5):
    """Rate of change of f(theta, omega) on the way the chain really takes."""
    accel = minimal_form.acceleration(TABLE, THETA, OMEGA, LOAD)

    def at(t):
        return f(THETA + t * OMEGA + 0.5 * t * t * accel, OMEGA + t * accel)

    return (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h)


def bodies(theta, omega):
    q, v = multiplier_form.place(TABLE, theta, omega)
    return q.reshape(N, 3), v.reshape(N, 3)


@pytest.mark.parametrize('joint', range(N))
def test_a_joint_carries_load_less_mass_times_acceleration(joint):
    def momentum(theta, omega):
        return (TABLE[joint:, :1] * bodies(theta, omega)[1][joint:, :2]).sum(axis=0)

    expected = LOAD[joint:].sum(axis=0) - along_the_motion(momentum)
    found = minimal_form.reactions(TABLE, THETA, OMEGA, LOAD)[joint]
    assert found == pytest.approx(expected, rel=1e-7)


def test_angular_momentum_about_the_root_changes_by_the_moments():
    def angular(theta, omega):
        q, v = bodies(theta, omega)
        orbit = TABLE[:, 0] * (q[:, 0] * v[:, 1] - q[:, 1] * v[:, 0])
        return np.sum(orbit + TABLE[:, 1] * omega)

    q, _ = bodies(THETA, OMEGA)
    moment = np.sum(q[:, 0] * LOAD[:, 1] - q[:, 1] * LOAD[:, 0])
    # Of springs and dampers, only the root's acts from outside.
    moment -= TABLE[0, 4] * THETA[0] + TABLE[0, 5] * OMEGA[0]
    assert along_the_motion(angular) == pytest.approx(moment, rel=1e-7)


def test_power_of_loads_and_dampers_is_the_rate_of_energy():
    def energy(theta, omega):
        _, v = bodies(theta, omega)
        kinetic = TABLE[:, 0] @ (v[:, 0] ** 2 + v[:, 1] ** 2) + TABLE[:, 1] @ omega**2
        return 0.5 * (kinetic + theta @ CHAIN.stiffness_matrix @ theta)

    _, v = bodies(THETA, OMEGA)
    power = np.sum(LOAD * v[:, :2]) - OMEGA @ CHAIN.damping_matrix @ OMEGA
    assert along_the_motion(energy) == pytest.approx(power, rel=1e-7)


def test_moments_are_the_loads_virtual_work(differences):
    def work(theta):
        return np.sum(LOAD * bodies(theta, OMEGA)[0][:, :2])

    assert minimal_form.moments(TABLE, THETA, LOAD) == pytest.approx(
        differences(work, THETA), rel=1e-9
    )


def test_forms_share_the_chains_matrices():
    assert minimal_form.coupling(TABLE) == pytest.approx(CHAIN.mass_matrix, rel=1e-14)
    assert minimal_form.joint(TABLE, 4, THETA) == pytest.approx(CHAIN.stiffness_matrix @ THETA)
    assert minimal_form.joint(TABLE, 5, OMEGA) == pytest.approx(CHAIN.damping_matrix @ OMEGA)


def test_the_moment_beside_the_straight_chains_own_closes_the_equation():
    accel = minimal_form.acceleration(TABLE, THETA, OMEGA, LOAD)
    straight = (
        CHAIN.mass_matrix @ accel + CHAIN.damping_matrix @ OMEGA + CHAIN.stiffness_matrix @ THETA
    )
    assert rest_moment(TABLE, THETA, OMEGA, LOAD) == pytest.approx(straight, rel=1e-9)
    one = TABLE[:1]
    assert rest_moment(one, THETA[:1], OMEGA[:1], LOAD[:1]) == minimal_form.moments(
        one, THETA[:1], LOAD[:1]
    )


def test_newtons_matrix_is_the_sum_of_its_parts():
    q, _ = multiplier_form.place(TABLE, THETA, OMEGA)
    g = multiplier_form.jacobian(TABLE, q)
    mass = np.diag(np.column_stack([TABLE[:, 0], TABLE[:, 0], TABLE[:, 1]]).ravel())
    a = multiplier_form.saddle(TABLE, g, 0.3)
    assert a == pytest.approx(np.block([[mass, 0.3 * g.T], [g, np.zeros((2 * N, 2 * N))]]))
    multiplier_form.add_joints(TABLE, 4, 2.0, a)
    assert a[2 : 3 * N : 3, 2 : 3 * N : 3] - np.diag(TABLE[:, 1]) == pytest.approx(
        2.0 * CHAIN.stiffness_matrix
    )


def test_baumgartes_terms_pull_the_gap_back():
    q, v = multiplier_form.place(TABLE, THETA, OMEGA)
    q, v = q + 1e-3 * np.cos(np.arange(3 * N)), v + 1e-2 * np.sin(np.arange(3 * N))
    accel, _ = multiplier_form.index1(TABLE, q, v, LOAD, 3.0, 5.0)
    g, rate = multiplier_form.jacobian(TABLE, q), multiplier_form.jacobian_rate(TABLE, q, v)
    second = g @ accel + rate @ v[2::3]
    expected = -6.0 * g @ v - 25.0 * multiplier_form.constraint(TABLE, q)
    assert second == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize('name', ON_CONSTRAINT)
def test_settled_joints_carry_the_loads_beyond_them(name):
    chain, dt = uniform_chain(2, 1.0, 0.6), 0.004
    method, load = method_named(name), np.array([[0.3, 2.0], [-0.5, 1.0]])
    loads = np.broadcast_to(load, (800, len(method.nodes), 2, 2)).copy()
    run = integrate(method, chain, loads, dt)
    carried = np.array([load.sum(axis=0), load[1]])
    assert method.reactions(chain, run.state, load) == pytest.approx(carried, abs=1e-3)
    assert run.state[3, :4].reshape(2, 2) == pytest.approx(carried, abs=1e-3)
    assert method.gap(chain, run.state) < 1e-3
