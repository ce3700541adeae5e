# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The chain's matrices against energies of its motion, closed forms, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from tree_sway_lab.methods.chain import (
    DAMPING,
    INERTIA,
    MASS,
    PlanarChain,
    single_segment,
    STIFFNESS,
    uniform_chain,
)
from tree_sway_lab.methods.multiplier_form import place

from tree_sway.errors import ParameterError


def uneven(n=4, seed=0):
    """Segments of which no two are alike."""
    return PlanarChain(np.random.default_rng(seed).uniform(0.2, 2.0, (n, 6)))


def test_mass_matrix_is_twice_the_kinetic_energy():
    chain, rng = uneven(), np.random.default_rng(1)
    for _ in range(5):
        rate = rng.normal(size=4)
        _, v = place(chain.table, np.zeros(4), rate)
        velocity = v.reshape(4, 3)
        energy = chain.table[:, MASS] @ (velocity[:, 0] ** 2 + velocity[:, 1] ** 2)
        energy += chain.table[:, INERTIA] @ velocity[:, 2] ** 2
        assert rate @ chain.mass_matrix @ rate == pytest.approx(energy, rel=1e-13)


@pytest.mark.parametrize(
    ('column', 'name'), [(STIFFNESS, 'stiffness_matrix'), (DAMPING, 'damping_matrix')]
)
def test_joint_matrices_are_sums_over_the_joints(column, name):
    chain, angle = uneven(), np.array([0.3, -1.0, 0.2, 0.9])
    bend = np.diff(angle, prepend=0.0)
    assert angle @ getattr(chain, name) @ angle == pytest.approx(chain.table[:, column] @ bend**2)


def test_two_rods_swing_as_their_quadratic_says():
    """1 - 3 x + 7/36 x^2 = 0, x = w^2 m l^2 / k of one rod."""
    chain = uniform_chain(2, 1.0, 0.0, length=3.0, mass=5.0)
    scale = chain.table[0, STIFFNESS] / (2.5 * 1.5**2)
    x = np.sort(np.roots([7 / 36, -3.0, 1.0]))
    assert chain.frequencies == pytest.approx(np.sqrt(x * scale), rel=1e-12)


def test_many_rods_near_the_cantilever():
    """Second over first frequency goes to (4.694 / 1.875)^2."""
    beam = (4.69409113 / 1.87510407) ** 2
    coarse, fine = (
        uniform_chain(n).frequencies[1] / uniform_chain(n).frequencies[0] - beam for n in (20, 40)
    )
    assert abs(fine) < 0.001 * beam
    assert coarse / fine == pytest.approx(4.0, abs=0.2), 'the ratio converges with the square'


@pytest.mark.parametrize('n', [1, 3])
def test_undamped_free_motion_keeps_its_energy_over_any_step(n):
    chain = uniform_chain(n, 2.0, 0.0)
    row = chain.first_order_hold(0.37)
    assert row.shape == (2 * n, 4 * n)
    state = np.linspace(-0.5, 1.0, 2 * n)

    def energy(state):
        x, v = np.split(state, 2)
        return x @ chain.stiffness_matrix @ x + v @ chain.mass_matrix @ v

    start = energy(state)
    for _ in range(50):
        state = row[:, : 2 * n] @ state
    assert energy(state) == pytest.approx(start, rel=1e-11)


@pytest.mark.parametrize('n', [1, 3])
def test_the_propagator_is_a_group_and_ends_at_the_static_answer(n):
    chain = uniform_chain(n, 2.0, 0.3)
    first, last = np.linspace(1.0, 2.0, n), np.linspace(-3.0, 1.0, n)
    middle, start = 0.5 * (first + last), np.linspace(-0.2, 0.4, 2 * n)
    half = chain.first_order_hold(0.05)
    stepped = half @ [*(half @ [*start, *first, *middle]), *middle, *last]
    assert stepped == pytest.approx(
        chain.first_order_hold(0.1) @ [*start, *first, *last], abs=1e-11
    )
    settled = chain.first_order_hold(200.0) @ [*start, *last, *last]
    assert settled[:n] == pytest.approx(np.linalg.solve(chain.stiffness_matrix, last), rel=1e-9)
    assert settled[n:] == pytest.approx(0.0, abs=1e-9)


def test_closed_form_of_one_segment_is_the_matrix_exponential():
    chain, dt = single_segment(1.5, 0.2), 0.1
    inertia, row = chain.mass_matrix[0, 0], chain.table[0]
    a = np.zeros((4, 4))
    a[0, 1], a[2, 3] = dt, 1.0
    a[1, :3] = dt / inertia * np.array([-row[STIFFNESS], -row[DAMPING], 1.0])
    e = expm(a)[:2]
    expected = np.column_stack([e[:, :2], e[:, 2] - e[:, 3], e[:, 3]])
    assert chain.first_order_hold(dt) == pytest.approx(expected, rel=1e-11)


def test_a_single_segment_has_the_frequency_and_damping_asked_for():
    chain = single_segment(3.0, 0.1, length=2.0, mass=0.7)
    inertia, row = chain.mass_matrix[0, 0], chain.table[0]
    assert inertia == pytest.approx(0.7 * 4.0 / 3.0)
    assert np.sqrt(row[STIFFNESS] / inertia) == pytest.approx(6.0 * np.pi)
    assert row[DAMPING] / (2.0 * np.sqrt(row[STIFFNESS] * inertia)) == pytest.approx(0.1)


def test_precision_is_kept():
    assert single_segment().astype(np.longdouble).table.dtype == np.longdouble
    assert single_segment().astype(np.float32).table.dtype == np.float32


@pytest.mark.parametrize('value', [-1.0, np.nan, np.inf])
def test_a_bad_number_is_refused_with_its_segment(value):
    table = uniform_chain(3).table.copy()
    table[2, STIFFNESS] = value
    with pytest.raises(ParameterError, match='segment 2: value that is negative or not finite'):
        PlanarChain(table)


def test_a_massless_link_moves_only_what_it_carries():
    link = [0.0, 0.0, 0.5, 1.0, 1.0, 0.0]
    body = [1.0, 0.1, 0.5, 1.0, 1.0, 0.0]
    assert PlanarChain(np.array([link, body])).mass_matrix[0, 0] == pytest.approx(1.0)
    with pytest.raises(ParameterError, match='segment 1: no inertia about its node'):
        PlanarChain(np.array([body, link]))
    with pytest.raises(ParameterError, match='shape'):
        PlanarChain(np.empty((0, 6)))
