"""Methods by name; those the solver can run, and those it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.integrators.chain import DAMPING, STIFFNESS, single_segment
from tree_sway_ros.core.integrators.registry import (
    DEFAULT,
    REAL_TIME,
    integrator_named,
    method_named,
    stability_limit,
)
from tree_sway_ros.core.oscillators import propagator
from tree_sway_ros.errors import ParameterError


def test_the_default_is_the_exact_propagator():
    args = np.array([0.5, 2.0]), np.array([0.1, 0.0]), np.array([30.0, 1e4])
    method = integrator_named(DEFAULT, *args, dt=1 / 60)
    assert method.propagator(*args, 1 / 60) == pytest.approx(propagator(*args, 1 / 60), rel=1e-15)


@pytest.mark.parametrize(("name", "limit"), [
    ("semi_implicit_euler", 2.0), ("verlet", 2.0), ("rk4", 8**0.5), ("implicit_midpoint", np.inf),
    ("tr_bdf2", np.inf), ("exact_zoh", np.inf), ("exact_foh", np.inf)])
def test_limits_are_those_of_theory(name, limit):
    assert stability_limit(method_named(name)) == pytest.approx(limit, rel=1e-4)
    assert method_named(name).limit == pytest.approx(limit, rel=1e-3)


def test_damping_lowers_the_limit_of_semi_implicit_euler():
    z = 0.3
    found = stability_limit(method_named("semi_implicit_euler"), z)
    assert found == pytest.approx(2 * (np.sqrt(1 + z * z) - z), rel=1e-6)


def test_a_step_beyond_the_limit_is_refused_with_the_limit():
    with pytest.raises(ParameterError, match=r"'rk4' is unstable for oscillator 1: w h is 3\.33, its limit 2\.8"):
        integrator_named("rk4", [1.0, 1.0], 0.0, [100.0, 4e4], 1 / 60)
    assert integrator_named("rk4", [1.0, 1.0], 0.0, [100.0, 2e4], 1 / 60).name == "rk4"


def test_names_that_are_no_integrator_or_cannot_run_live():
    with pytest.raises(ParameterError, match="unknown integrator 'euler'"):
        integrator_named("euler")
    for name in ("newmark", "radau_ggl"):
        with pytest.raises(ParameterError, match="not real-time capable"):
            integrator_named(name)
        with pytest.raises(ParameterError, match="not real-time capable"):
            method_named(name).propagator(np.ones(1), np.ones(1), np.ones(1), 0.1)


@pytest.mark.parametrize("name", REAL_TIME)
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
