# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a live stream throws at a simulator: bad winds, storms, stalls, any step, restarts."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from simulators import FULL, OBSERVED, swaying

from tree_sway.core.run.outcome import Outcome
from tree_sway.core.scene.make import make_simulator
from tree_sway.errors import ParameterError

DT = 1.0 / 60.0


def gusts(n):
    rng = np.random.default_rng(3)
    return np.array([6.0, 2.0, 0.5]) + np.cumsum(rng.normal(0.0, 0.6, (n, 3)), axis=0)


def run(sim, winds):
    """Poses after each wind, (k, n, 7)."""
    frames = []
    for wind in winds:
        sim.step(wind, DT)
        frames.append(sim.place().copy())
    return np.array(frames)


@pytest.fixture(params=[4, 'branch', *FULL, *OBSERVED])
def model(request):
    return request.param


@pytest.mark.parametrize(
    ('bad', 'axis'),
    [(np.nan, 0), (np.inf, 1), (-np.inf, 2), (1e300, 0), (1e6, 1), (-1e6, 2)],
)
def test_a_wind_that_cannot_be_is_refused_and_the_last_one_held(fork, model, bad, axis):
    winds = gusts(40)
    undisturbed, struck = swaying(fork(), model), swaying(fork(), model)
    for k, wind in enumerate(winds):
        blow = np.array(wind)
        if k == 20:
            wind = winds[19]
            blow[axis] = bad
        assert undisturbed.step(wind, DT) == Outcome.OK
        assert struck.step(blow, DT) == (Outcome.WIND_REFUSED if k == 20 else Outcome.OK)
        assert struck.place().tobytes() == undisturbed.place().tobytes()
    counts = struck.counts.refused, struck.counts.steps, undisturbed.counts.refused
    assert counts == (1, 40, 0)


def test_bad_wind_from_the_start_is_no_wind(fork, model):
    sim = swaying(fork(), model)
    rest = sim.place().copy()
    assert sim.step([np.nan, 0.0, 0.0], DT) == Outcome.WIND_REFUSED
    assert (sim.place() == rest).all()


@given(st.lists(st.floats(width=64, allow_nan=True, allow_infinity=True), min_size=3, max_size=3))
@settings(deadline=None, max_examples=80)
def test_no_wind_ever_poisons_a_tree(wild_sim, wind):
    for dt in (DT, 0.5):
        wild_sim.step(wind, dt)
        wild_sim.step([150.0 * (-1) ** wild_sim.counts.steps, 0.0, 0.0], dt)
    poses = wild_sim.place()
    assert np.isfinite(poses).all()
    tree = wild_sim.tree
    assert np.linalg.norm(poses[:, :3] - tree.start[0], axis=1).max() <= tree.length.sum()


@pytest.fixture(scope='module')
def wild_sim(fork):
    return make_simulator(fork(), model='branch', gravity=0.0)


def test_late_and_uneven_steps_end_at_the_same_place(fork, model):
    even, uneven = (swaying(fork(), model, damping_ratio=0.3) for _ in range(2))
    rng = np.random.default_rng(0)
    run(even, [[5.0, 1.0, 0.0]] * 1800)
    for k in range(600):
        uneven.step([5.0, 1.0, 0.0], 0.5 if k % 60 == 59 else rng.uniform(0.005, 0.08))
    assert np.abs(even.tip_displacement).max() > 1e-3
    assert uneven.place() == pytest.approx(even.place(), abs=1e-12)


def test_a_stall_is_one_long_step(stem):
    """Free decay in still air, a breath of it: one step of a time is as many as fit in it."""
    split, whole = (swaying(stem(), 'branch', gravity=0.0) for _ in range(2))
    for sim in (split, whole):
        sim.step([0.01, 0.0, 0.0], DT)
        sim.step([0.0, 0.0, 0.0], DT)
    for _ in range(30):
        split.step([0.0, 0.0, 0.0], DT)
    whole.step([0.0, 0.0, 0.0], 30 * DT)
    one, other = split.place() - whole.place(), split.place()
    moved = np.abs(other[:, 0] - split.tree.start[:, 0]).max()
    assert moved > 0.0
    # Air drag at a micrometre a second is what is left.
    assert np.abs(one).max() < 1e-3 * moved


def test_a_change_of_step_does_not_move_the_tree(fork, model):
    """Half steps, then whole ones: the same motion to the second order of the step."""

    def wind(t):
        return np.array([5.0 + 2.0 * np.sin(3.0 * t), 0.0, 0.0])

    ends = []
    for plan in ([DT / 8] * 960, [DT / 2] * 120 + [DT] * 60):
        sim, t = swaying(fork(), model), 0.0
        for dt in plan:
            sim.step(wind(t + dt / 2), dt)
            t += dt
        sim.place()
        ends.append(sim.tip_displacement.copy())
    assert ends[0] == pytest.approx(ends[1], abs=0.01 * np.abs(ends[0]).max())


def test_reset_goes_back_to_rest_and_repeats(fork, model):
    sim = swaying(fork(), model)
    winds = gusts(30)
    first = run(sim, winds)
    sim.reset()
    assert sim.place()[:, :3] == pytest.approx(sim.tree.start, abs=1e-12)
    assert sim.step([np.nan] * 3, DT) == Outcome.WIND_REFUSED
    assert sim.tip_displacement == pytest.approx(np.zeros(3), abs=1e-12)
    sim.reset()
    assert run(sim, winds).tobytes() == first.tobytes()
    assert sim.counts.steps == 61


def test_a_storm_that_is_held_says_so(stem):
    sim = make_simulator(stem(length=1.0, base=0.002, cuts=4), model='branch', gravity=0.0)
    status = [sim.step([140.0, 0.0, 0.0], DT) for _ in range(30)]
    assert set(status) <= {Outcome.OK, Outcome.LOAD_CLAMPED}
    assert Outcome.LOAD_CLAMPED in status
    assert sim.counts.clamped >= status.count(Outcome.LOAD_CLAMPED)


@pytest.mark.parametrize('dt', [0.0, -0.1, 0.51, 10.0, float('nan'), float('inf')])
def test_a_step_that_is_none_is_refused(fork, dt):
    sim = swaying(fork(), 'branch')
    sim.step([5.0, 0.0, 0.0], DT)
    before = sim.place().copy()
    with pytest.raises(ParameterError, match=r'step: time step of .*; give a finite one above 0'):
        sim.step([5.0, 0.0, 0.0], dt)
    assert (sim.place() == before).all()
