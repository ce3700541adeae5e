# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Methods by name, and that what the solver runs is the method's own step."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import DAMPING, single_segment, STIFFNESS
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.step_rules import REAL_TIME, stability_limit

from tree_sway.errors import ParameterError


@pytest.mark.parametrize('name', REAL_TIME)
def test_declared_limits_are_those_of_the_rule(name):
    assert method_named(name).limit == pytest.approx(stability_limit(name), rel=1e-3)


def test_names_that_are_no_method_or_cannot_run_live():
    with pytest.raises(ParameterError, match="unknown integrator 'euler'"):
        method_named('euler')
    for name in ('newmark', 'radau_ggl'):
        with pytest.raises(ParameterError, match=r'no integrator .* of eight coefficients'):
            method_named(name).propagator(np.ones(1), np.ones(1), np.ones(1), 0.1)


@pytest.mark.parametrize('name', REAL_TIME)
def test_what_the_solver_runs_is_the_methods_own_step(name):
    """Coefficients are the derivative of the nonlinear step at rest."""
    chain, method, dt, tiny = single_segment(2.0, 0.1), method_named(name), 1 / 60, 1e-7
    inertia, row = chain.mass_matrix[0], chain.table[0]
    expected = method.propagator(inertia, row[[DAMPING]], row[[STIFFNESS]], dt)[0]
    found = np.empty((2, 4))
    for column in range(4):
        x, v, m0, m1 = tiny * np.eye(4)[column]
        state = np.array([[x], [v], [0.0], [0.0]])
        load = np.zeros((len(method.nodes), 1, 2))
        load[:, 0, 1] = [(m0 + node * (m1 - m0)) / row[2] for node in method.nodes]
        type(method).kernel(chain.table, state, load, dt, method.options(chain, dt))
        found[:, column] = state[:2, 0] / tiny
    assert found.ravel() == pytest.approx(expected, rel=1e-6, abs=1e-9)
