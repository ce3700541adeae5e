# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Running a method: when loads are taken, when a run ends, what is counted."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import single_segment, uniform_chain
from tree_sway_lab.methods.registry import method_named, METHODS
from tree_sway_lab.methods.trajectory import integrate, sample

IMPLICIT = ('implicit_midpoint', 'tr_bdf2', 'bdf2', 'newmark', 'radau_ggl')


def calm(method, n, steps):
    return np.zeros((steps, len(method.nodes), n, 2))


def test_loads_are_taken_at_the_nodes_of_every_step():
    loads = sample(lambda t: np.stack([t, -t], 1)[:, None], (0.0, 0.25, 1.0), 0.5, 3)
    assert loads.shape == (3, 3, 1, 2)
    assert loads[:, :, 0, 0] == pytest.approx(
        np.array([[0, 0.125, 0.5], [0.5, 0.625, 1], [1, 1.125, 1.5]])
    )
    assert loads[..., 1] == pytest.approx(-loads[..., 0])


@pytest.mark.parametrize('name', METHODS)
def test_free_decay_is_the_closed_form(name):
    """It is e^(-z w t) (cos + z w / wd sin) from 0.3 rad; without load one segment is linear."""
    chain, method, steps = single_segment(1.0, 0.05), method_named(name), 480
    run = integrate(method, chain, calm(method, 1, steps), 1 / steps, theta=[0.3])
    w, t = 2 * np.pi, np.arange(steps + 1) / steps
    wd = w * np.sqrt(1 - 0.05**2)
    exact = 0.3 * np.exp(-0.05 * w * t) * (np.cos(wd * t) + 0.05 * w / wd * np.sin(wd * t))
    slack = {1: 0.02, 2: 2e-4, 4: 1e-6, 5: 1e-8}[method.order] if 'exact' not in name else 1e-11
    assert np.abs(run.theta[:, 0] - exact).max() < slack


def test_rates_given_at_the_start_are_taken():
    chain, method = single_segment(1.0, 0.0), method_named('exact_foh')
    run = integrate(method, chain, calm(method, 1, 25), 0.01, omega=[2 * np.pi * 0.1])
    assert run.theta[-1, 0] == pytest.approx(0.1), 'a quarter of a period'


def test_a_run_that_explodes_stops_and_the_rest_is_not_a_number():
    chain, method = single_segment(10.0, 0.0), method_named('semi_implicit_euler')
    run = integrate(method, chain, calm(method, 1, 200), 0.1, theta=[0.1])
    known = np.isfinite(run.theta[:, 0])
    assert 1 < known.sum() < 200
    assert not known[known.sum() :].any()
    assert np.abs(run.theta[known]).max() < 1e6


@pytest.mark.parametrize('name', IMPLICIT)
def test_iterations_are_counted_and_failures_reported(name):
    chain, method = uniform_chain(2), method_named(name)
    loads = calm(method, 2, 5) + 0.5
    run = integrate(method, chain, loads, 0.01)
    assert run.failed == 0
    assert 5 <= run.iterations <= 60
    loads[3] = np.nan
    assert integrate(method, chain, loads, 0.01).failed >= 1


def test_explicit_methods_iterate_nothing_and_hand_back_their_state():
    chain, method = single_segment(), method_named('rk4')
    run = integrate(method, chain, calm(method, 1, 3), 0.01, theta=[0.1])
    assert (run.iterations, run.failed) == (0, 0)
    assert run.theta[0] == 0.1
    assert run.state.shape == (4, 1)


@pytest.mark.parametrize('name', ['bdf2', 'generalized_alpha'])
def test_the_load_before_the_first_step_makes_the_memory(name, swaying):
    """Their first step looks back: a wrong past costs accuracy at once."""
    method = method_named(name)
    loads = sample(swaying.wind, method.nodes, 1 / 60, 6)
    fair = integrate(method, swaying.chain, loads, 1 / 60, first=swaying.first)
    wrong = integrate(method, swaying.chain, loads, 1 / 60, first=swaying.first + 5.0)
    truth = swaying.truth.theta[np.round(np.arange(7) * 320 / 60).astype(int)]
    assert np.abs(fair.theta - truth).max() < np.abs(wrong.theta - truth).max()
