# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The ball joint, and the two-axis kernel against it and against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from tree_sway_lab.battery.branch_runs import Branch, chord
from tree_sway_lab.methods.ball_joint import swing
from tree_sway_lab.methods.rebuilt_plane import run_in_rebuilt_plane

# Amplitude of the load and the goal for 10, 30 and 60 degrees, rms over the length.
GOALS = ((0.14, 10, 2e-4), (0.42, 30, 2e-3), (1.2, 60, 1e-2))


def gusts(size):
    def wind(t):
        e1 = 0.75 * np.sin(2 * np.pi * 0.23 * t) + 0.3 * np.sin(2 * np.pi * 0.7 * t)
        e2 = 0.75 * np.cos(2 * np.pi * 0.17 * t) - 0.3 * np.cos(2 * np.pi * 0.9 * t)
        return size * np.stack([0.2 * np.sin(1.9 * t), e1, e2], 1)

    return wind


@pytest.mark.parametrize(('size', 'degrees', 'goal'), GOALS)
@pytest.mark.parametrize('kind', [np.float64, np.float32])
def test_motion_in_space_meets_its_goal(size, degrees, goal, kind):
    branch, wind = Branch(2.0, 0.05), gusts(size)
    truth = branch.truth(wind, 1200)
    peak = np.degrees(np.arccos(truth[:, 0].min()))
    assert degrees <= peak <= 1.4 * degrees
    error = chord(branch.run(branch.means(wind, 1200), dtype=kind)) - truth
    assert np.sqrt((error**2).sum(1).mean()) <= goal


def test_the_ball_joint_keeps_its_energy():
    k = 100.0
    u, v = swing(
        np.zeros((120, 129, 3)),
        1 / 60,
        1.0,
        0.0,
        k,
        np.array([0.8, 0.0]),
        np.array([0.0, 5.0]),
        64,
    )
    energy = 0.5 * (v**2).sum(1) + 0.5 * k * np.arccos(u[:, 0]) ** 2
    assert energy == pytest.approx(np.full(121, energy[0]), rel=1e-8)


def test_static_deflection_is_keplers_equation():
    """It is psi - E with E + s sin E = psi, the load at the angle psi from the rest direction."""
    branch, s = Branch(2.0, 0.3), 0.9
    for psi in (0.4, 1.2, 2.0):
        load = s * np.array([np.cos(psi), np.sin(psi) * 0.6, np.sin(psi) * 0.8])
        state = branch.run(np.tile(load, (1200, 1)))[-1]
        anomaly = brentq(lambda e, psi=psi: e + s * np.sin(e) - psi, 0, np.pi)
        assert np.hypot(state[0], state[1]) == pytest.approx(psi - anomaly, abs=1e-9)


def test_free_elliptic_swing_precesses():
    """(2 pi / 3) a b a cycle, within 1 %."""
    a, b, frequency, dt = 0.2, 0.1, 2.0, 1 / 240
    branch = Branch(frequency, 0.0, dt)
    states = branch.run(np.zeros((24000, 3)), np.array([a, 0.0, 0.0, b * branch.w]))
    x, y = states[:, 0], states[:, 1]
    far = np.flatnonzero(np.diff(np.sign(np.diff(x**2 + y**2))) < 0) + 1
    angle = np.unwrap(2 * np.arctan2(y[far], x[far])) / 2
    # two far points a cycle
    turn = np.polyfit(np.arange(len(far)), angle, 1)[0] * 2
    assert abs(turn) == pytest.approx(2 * np.pi / 3 * a * b, rel=0.01)


def test_in_steady_wind_the_two_axes_move_in_the_papers_plane():
    branch = Branch()
    loads = np.tile([-0.1, 0.3, 0.4], (120, 1))
    planar = run_in_rebuilt_plane(loads * branch.stiffness, branch.row)
    assert chord(branch.run(loads)) == pytest.approx(planar, abs=1e-8)
