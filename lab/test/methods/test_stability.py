# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Growth of free motion under each method, and the limit of its step, against theory."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.stability import free_step, growth, stability_limit

from tree_sway.core.oscillators.propagation import propagator


def test_the_step_of_the_default_is_the_exact_propagator():
    chain = single_segment(2.0, 0.05)
    inertia, stiffness = chain.mass_matrix[0, 0], chain.stiffness_matrix[0, 0]
    damping = chain.damping_matrix[0, 0]
    exact = propagator(inertia, damping, stiffness, 1 / 60)[0, [0, 1, 4, 5]].reshape(2, 2)
    found = free_step(method_named('exact_foh'), chain, 1 / 60)
    assert found == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize(
    ('name', 'limit'),
    [
        ('semi_implicit_euler', 2.0),
        ('verlet', 2.0),
        ('rk4', 8**0.5),
        ('implicit_midpoint', np.inf),
        ('tr_bdf2', np.inf),
        ('exact_zoh', np.inf),
        ('exact_foh', np.inf),
    ],
)
def test_limits_are_those_of_theory(name, limit):
    method = method_named(name)
    assert stability_limit(method) == pytest.approx(limit, rel=1e-4)
    assert method.limit == pytest.approx(limit, rel=1e-3)


def test_damping_lowers_the_limit_of_semi_implicit_euler():
    z = 0.3
    found = stability_limit(method_named('semi_implicit_euler'), z)
    assert found == pytest.approx(2 * (np.sqrt(1 + z * z) - z), rel=1e-6)


def test_growth_of_rk4_is_its_polynomial():
    for ratio in (0.5, 2.0, 2.8, 3.5):
        z = 1j * ratio
        expected = abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24)
        assert growth(method_named('rk4'), ratio) == pytest.approx(expected, rel=1e-12)


def test_tr_bdf2_damps_what_is_stiff_and_the_midpoint_does_not():
    assert growth(method_named('tr_bdf2'), 1e4) < 1e-3
    assert growth(method_named('implicit_midpoint'), 1e4) == pytest.approx(1.0, abs=1e-9)
