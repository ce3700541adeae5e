# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Step rules and their limits."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.step_rules import growth, rule_propagator, stability_limit

from tree_sway.core.oscillators.propagator import propagator
from tree_sway.errors import ParameterError


def test_the_default_is_the_exact_propagator():
    args = np.array([0.5, 2.0]), np.array([0.1, 0.0]), np.array([30.0, 1e4])
    exact = propagator(*args, 1 / 60)
    assert rule_propagator('exact_foh', *args, 1 / 60) == pytest.approx(exact, rel=1e-15)


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
    assert stability_limit(name) == pytest.approx(limit, rel=1e-4)


def test_damping_lowers_the_limit_of_semi_implicit_euler():
    z = 0.3
    found = stability_limit('semi_implicit_euler', z)
    assert found == pytest.approx(2 * (np.sqrt(1 + z * z) - z), rel=1e-6)


def test_a_name_that_is_no_rule_is_refused():
    with pytest.raises(ParameterError, match="no integrator 'newmark' of eight coefficients"):
        rule_propagator('newmark', 1.0, 1.0, 1.0, 0.1)


def test_growth_of_rk4_is_its_polynomial():
    for ratio in (0.5, 2.0, 2.8, 3.5):
        z = 1j * ratio
        expected = abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24)
        assert growth('rk4', ratio, 0.0) == pytest.approx(expected, rel=1e-12)


def test_tr_bdf2_kills_what_is_stiff_and_the_midpoint_does_not():
    assert growth('tr_bdf2', 1e6, 0.0) < 1e-5
    assert growth('implicit_midpoint', 1e6, 0.0) == pytest.approx(1.0, abs=1e-9)
