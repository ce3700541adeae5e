# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every branch an oscillator: the exact propagator, carried loads, the paper's equation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tree_sway.core.oscillators.step_guards import LOAD_MAX
from tree_sway.core.run.assembly import bank_of
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_named

WOOD = species_named('broadleaf')
DRAG = 0.5 * 1.225 * WOOD.drag_coefficient


def oscillators(tree, dt=1 / 60, **changes):
    chosen = {'model': 'branch', 'gravity': 0.0} | changes
    bank = bank_of(prepare(tree, WOOD, Settings(**chosen))).oscillators
    bank.set_step(dt)
    return bank


def test_a_planar_sway_is_the_papers_equation(stem):
    """I theta'' + k2 theta' + k1 theta = c (Py cos - Px sin), the drag met where it now is."""
    bank = oscillators(stem(length=1.0, base=0.003, cuts=4), dt=1 / 480, damping_ratio=0.1)
    branch = bank.branches[0]
    inertia, damping, stiffness = bank.inertia[0], bank.damping[0], bank.stiffness[0]
    push = np.linalg.norm(branch['load_mode'][0])
    flow, turn = (
        np.linalg.norm(branch['damping_mode'][0]),
        np.linalg.norm(branch['load_rotation'][0]),
    )

    def wind(t):
        return 4.0 + 1.5 * np.sin(5.0 * t)

    def rate(t, state):
        angle, speed = state
        # The wind sees the branch turned by its mean slope, and moving across itself; only what
        # crosses it pushes.
        seen = turn * angle
        across = wind(t) * np.cos(seen) - flow * speed
        # Pieces move faster and slower than their mean.
        beside = branch['spread'] * speed**2
        force = DRAG * branch['area'] * np.sqrt(across**2 + beside) * across
        px, pz = force * np.cos(seen), -force * np.sin(seen)
        moment = push * (px * np.cos(angle) - pz * np.sin(angle))
        return speed, (moment - damping * speed - stiffness * angle) / inertia

    truth = solve_ivp(rate, (0.0, 2.0), (0.0, 0.0), rtol=1e-9, atol=1e-11, dense_output=True)
    path = []
    for k in range(960):
        mean = 4.0 + 1.5 * (np.cos(5 * k / 480) - np.cos(5 * (k + 1) / 480)) * 96.0
        assert bank.advance_in(mean, 0.0, 0.0, DRAG) == 0
        path.append(bank.rotations().copy())
    angle = truth.sol(np.arange(1, 961) / 480)[0]
    assert np.abs(angle).max() > 0.1
    assert np.array(path)[:, 0] == pytest.approx(angle, abs=2e-3 * np.abs(angle).max())
    assert np.abs(np.array(path)[:, 1]).max() == 0.0


@pytest.mark.parametrize('dt', [1 / 240, 1 / 60, 1 / 15])
def test_still_air_takes_energy_and_never_gives(stem, dt):
    bank = oscillators(stem(length=1.0, base=0.004, cuts=4), dt, damping_ratio=0.0)
    bank.state[:2, :] = [[0.2, -0.1], [1.0, 3.0]]
    energy = []
    for _ in range(300):
        bank.advance_in(0.0, 0.0, 0.0, DRAG)
        x, v = bank.state[0], bank.state[1]
        energy.append(bank.stiffness[0] * x @ x + bank.inertia[0] * v @ v)
    assert energy[-1] < 0.95 * energy[0]
    assert np.diff(energy).max() < 0.02 * energy[0]


def test_a_load_beyond_what_is_followed_is_clamped_and_counted(fork):
    bank = oscillators(fork(), model='branch')
    assert bank.advance_in(5.0, 0.0, 0.0, DRAG) == 0
    # However heavy the air, at first a branch does no more than go along with it.
    assert bank.advance_in(5.0, 0.0, 0.0, 1e12) == 0
    clamped = [bank.advance_in(5.0, 0.0, 0.0, 1e12) for _ in range(500)]
    assert max(clamped) > 0
    # The most that a bounded moment can do, turned over at every swing; the margin is that of the
    # whole moment.
    z = WOOD.damping_bare
    most = 1.5 * LOAD_MAX / np.tanh(np.pi * z / (2.0 * np.sqrt(1.0 - z * z)))
    assert np.linalg.norm(bank.rotations().reshape(-1, 2), axis=1).max() < most


def test_reset_forgets_everything(fork):
    bank, fresh = (oscillators(fork(), model='branch') for _ in range(2))
    for k in range(20):
        bank.advance_in(9.0, 1.0 * k, 0.0, DRAG)
    bank.reset()
    for _ in range(5):
        for one in (bank, fresh):
            one.advance_in(3.0, 1.0, 0.0, DRAG)
    assert bank.rotations().tobytes() == fresh.rotations().tobytes()
