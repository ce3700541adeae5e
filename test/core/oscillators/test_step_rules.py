# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The step rules that the solver runs, their limits, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.oscillators.propagator import propagator
from tree_sway_ros.core.oscillators.step_rules import (
    DEFAULT,
    fill_steps,
    growth,
    rule_propagator,
    stability_limit,
    stable_steps,
)
from tree_sway_ros.errors import ParameterError


def test_the_default_is_the_exact_propagator():
    args = np.array([0.5, 2.0]), np.array([0.1, 0.0]), np.array([30.0, 1e4])
    exact = propagator(*args, 1 / 60)
    assert rule_propagator(DEFAULT, *args, 1 / 60) == pytest.approx(exact, rel=1e-15)
    filled = np.empty((2, 8))
    fill_steps(DEFAULT, *args, 1 / 60, filled)
    assert filled == pytest.approx(exact, rel=1e-15)


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


def test_a_step_beyond_the_limit_is_refused_with_the_limit():
    with pytest.raises(
        ParameterError, match=r"'rk4' is unstable for oscillator 1: w h is 3\.33, its limit 2\.8"
    ):
        stable_steps('rk4', [1.0, 1.0], 0.0, [100.0, 4e4], 1 / 60)
    assert stable_steps('rk4', [1.0, 1.0], 0.0, [100.0, 2e4], 1 / 60).shape == (2, 8)


def test_a_name_that_is_no_rule_is_refused():
    with pytest.raises(ParameterError, match="no integrator 'newmark' that the solver can run"):
        rule_propagator('newmark', 1.0, 1.0, 1.0, 0.1)


def test_growth_of_rk4_is_its_polynomial():
    for ratio in (0.5, 2.0, 2.8, 3.5):
        z = 1j * ratio
        expected = abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24)
        assert growth('rk4', ratio, 0.0) == pytest.approx(expected, rel=1e-12)


def test_tr_bdf2_kills_what_is_stiff_and_the_midpoint_does_not():
    assert growth('tr_bdf2', 1e6, 0.0) < 1e-5
    assert growth('implicit_midpoint', 1e6, 0.0) == pytest.approx(1.0, abs=1e-9)
