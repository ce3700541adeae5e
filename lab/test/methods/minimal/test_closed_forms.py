# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What each method on the angles keeps, kills or gets exactly right, by its own theory."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.chain import (
    DAMPING,
    LEVER,
    single_segment,
    STIFFNESS,
    uniform_chain,
)
from tree_sway_lab.methods.minimal_form import linearised
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate

MINIMAL = (
    'semi_implicit_euler',
    'verlet',
    'rk4',
    'implicit_midpoint',
    'tr_bdf2',
    'bdf2',
    'exact_zoh',
    'exact_foh',
    'exact_about_equilibrium',
)


def step(method, chain, state, load, dt):
    loads = np.broadcast_to(load, (len(method.nodes), chain.n_segments, 2)).copy()
    type(method).kernel(chain.table, state, loads, dt, method.options(chain, dt))


def free(name, dt, steps=300):
    """Angles and rates of a segment of 1 rad/s without damping, set free."""
    chain, method = single_segment(0.5 / np.pi, 0.0), method_named(name)
    state = method.start(chain, np.array([0.3]), np.array([0.2]), np.zeros((1, 2)), dt)
    out = [state[:2, 0].copy()]
    for _ in range(steps):
        step(method, chain, state, 0.0, dt)
        out.append(state[:2, 0].copy())
    return np.array(out).T


@pytest.mark.parametrize(
    ('name', 'energy'),
    [
        ('semi_implicit_euler', lambda x, v, h: v * v + x * x - h * x * v),
        ('verlet', lambda x, v, h: v * v + x * x * (1 - h * h / 4)),
        ('implicit_midpoint', lambda x, v, h: v * v + x * x),
        ('exact_foh', lambda x, v, h: v * v + x * x),
        ('exact_zoh', lambda x, v, h: v * v + x * x),
        ('exact_about_equilibrium', lambda x, v, h: v * v + x * x),
    ],
)
def test_a_free_oscillator_keeps_the_energy_of_the_method(name, energy):
    h = 0.4
    stored = energy(*free(name, h), h)
    assert stored == pytest.approx(np.full(301, stored[0]), rel=1e-9)


@pytest.mark.parametrize('name', ['rk4', 'tr_bdf2', 'bdf2'])
def test_what_damps_by_itself_loses_energy(name):
    x, v = free(name, 0.4)
    energy = x * x + v * v
    assert energy[-1] < 0.99 * energy[0]
    assert energy.max() <= 1.02 * energy[0]


@pytest.mark.parametrize(
    ('name', 'n', 'slack'),
    [
        # Verlet only where no centrifugal force needs the rate it predicts: a segment alone.
        ('verlet', 1, 1e-12),
        ('implicit_midpoint', 3, 1e-10),
        ('rk4', 1, 1e-3),
    ],
)
def test_symmetric_methods_run_backwards(name, n, slack):
    chain, method = uniform_chain(n, 1.0, 0.0), method_named(name)
    theta, omega = np.array([0.3, -0.1, 0.2])[:n], np.zeros(n)
    load = np.array([[0.3, 0.1], [-0.2, 0.4], [0.1, 0.1]])[:n]
    state = method.start(chain, theta, omega, load, 0.01)
    for _ in range(2):
        for _ in range(40):
            step(method, chain, state, load, 0.01)
        moved = np.abs(state[0] - theta).max()
        state[1] *= -1.0
    assert moved < slack
    assert name != 'rk4' or moved > 1e-11, 'of an even order, but not symmetric'


@pytest.mark.parametrize('name', MINIMAL)
def test_equilibrium_under_a_steady_load_is_kept(name):
    chain, method = single_segment(1.0, 0.05), method_named(name)
    row, angle = chain.table[0], 0.4
    load = np.array([[-2.0, 0.0]])
    load[0, 1] = (row[STIFFNESS] * angle / row[LEVER] + load[0, 0] * np.sin(angle)) / np.cos(angle)
    state = method.start(chain, np.array([angle]), np.zeros(1), load, 0.02)
    for _ in range(20):
        step(method, chain, state, load, 0.02)
    assert state[:2, 0] == pytest.approx([angle, 0.0], abs=1e-9)


def test_motion_about_a_bent_state_has_its_own_frequency():
    """A load of many times the stiffness pulls straight: the bent branch swings much faster."""
    chain, method, dt = single_segment(1.0, 0.0), method_named('exact_about_equilibrium'), 0.05
    load = np.array([[0.0, 20.0 * chain.table[0, STIFFNESS]]])
    angle = np.zeros(1)
    for _ in range(30):
        lin = linearised(chain.table, angle, np.zeros(1), load)
        angle -= np.clip(lin[0, 0] / lin[0, 1], -0.3, 0.3)
    w = np.sqrt(-lin[0, 1])
    assert w > 2.5 * 2 * np.pi
    tiny = 1e-5
    state = method.start(chain, angle + tiny, np.zeros(1), load, dt)
    found = []
    for _ in range(40):
        step(method, chain, state, load, dt)
        found.append((state[0, 0] - angle[0]) / tiny)
    assert found == pytest.approx(np.cos(w * dt * np.arange(1, 41)), abs=2e-3)


def test_zero_order_hold_is_late_by_half_a_step():
    """Under a moment that rises evenly, the exact answer lags by what the hold leaves out."""
    chain, dt = single_segment(1.0, 0.7), 0.05
    k, c = chain.table[0, [STIFFNESS, DAMPING]]
    rate, lever = 1e-4 * k, chain.table[0, LEVER]

    def ramp(name):
        method = method_named(name)
        times = dt * (np.arange(400)[:, None] + np.asarray(method.nodes))
        loads = np.zeros((*times.shape, 1, 2))
        loads[..., 0, 1] = rate * times / lever
        return integrate(method, chain, loads, dt).theta[-1, 0]

    exact = rate * (400 * dt - c / k) / k
    assert ramp('exact_foh') == pytest.approx(exact, abs=2e-8)
    assert ramp('exact_zoh') == pytest.approx(exact - rate * 0.5 * dt / k, abs=2e-8)
