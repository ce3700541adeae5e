# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One loop steps every live tree: its grid of time, its gate, its wind, its jumps of clocks."""

from __future__ import annotations

import time

import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.run import LONGEST_JUMP, Run
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.wind.averaging import WindAverage
from tree_sway.errors import ParameterError

SECOND = 10**9
PERIOD = round(1e9 / 60)
START = 1_700_000_000 * 10**9 // PERIOD * PERIOD
TREE = tree_from_segments(
    [[0, 0, 0], [0, 0, 1], [0, 0, 2]], [[0, 0, 1], [0, 0, 2], [0, 0, 3]], [0.05, 0.04, 0.03]
)


class Recorder:
    """A simulator that only writes down its steps."""

    def __init__(self, cost=0.0):
        self.steps = []
        self.resets = 0
        self.cost = cost

    simulators = ()

    def step(self, wind, dt):
        self.steps.append((float(wind[0]), dt))
        if self.cost:
            time.sleep(self.cost)
        return 0

    def place(self, out=None):
        return out

    def reset(self):
        self.resets += 1


def running(simulator, timer=time.perf_counter, **options):
    made = Run(simulator, make_wind=lambda: WindAverage(**options), timer=timer)
    made.restart(START + PERIOD)
    simulator.resets = 0
    return made


def play(made, lateness):
    """Drive through ten seconds of wind, by ticks of these numbers of periods in turn."""
    index, sample = 0, 0
    for periods in lateness:
        index += periods
        now = START + index * PERIOD
        while START + sample * 50_000_000 <= now:
            wind = 5.0 + 3.0 * np.sin(0.3 * sample)
            made.offer(START + sample * 50_000_000, (wind, 0.0, 0.0))
            sample += 1
        made.advance(now, delay=0.02, most=periods)


def test_each_period_is_a_step():
    simulator = Recorder()
    running(simulator).advance(START + 3 * PERIOD)
    assert [dt for _, dt in simulator.steps] == pytest.approx([1 / 60] * 3, rel=1e-6)


def test_late_ticks_leave_no_trace_in_the_motion():
    poses = []
    for lateness in ([1] * 600, [4] * 150, [1, 7, 2, 20, 3, 5, 8, 4] * 12):
        simulator = make_simulator(TREE, model='branch')
        made = running(simulator, timer=lambda: 0.0)  # expensive steps would be joined
        play(made, lateness)
        poses.append(simulator.place().copy())
    np.testing.assert_array_equal(poses[0], poses[1])
    np.testing.assert_array_equal(poses[0], poses[2])
    assert np.abs(poses[0] - make_simulator(TREE).place()).max() > 1e-4


def test_a_slow_simulator_takes_one_long_step_instead_of_a_backlog():
    simulator = Recorder(cost=0.012)
    made = running(simulator)
    made._cost = 0.012
    made.advance(START + 20 * PERIOD)
    assert [dt for _, dt in simulator.steps] == pytest.approx([20 / 60], rel=1e-6)


def test_pausing_stops_the_motion_and_not_the_wind():
    simulator = Recorder()
    made = running(simulator)
    made.is_paused = True
    play(made, [1] * 60)
    assert simulator.steps == []
    assert made.wind_state == 'live'


def test_a_restart_forgets_wind_and_motion():
    simulator = Recorder()
    made = running(simulator)
    play(made, [1] * 60)
    made.offer(START + 10**12, (9.0, 0.0, 0.0))
    made.restart(START - 10**12)
    made.advance(START - 10**12)
    assert simulator.resets == 1
    assert simulator.steps[-1][0] == 0.0
    assert made.wind_state == 'none'


def test_no_wind_is_calm():
    simulator = Recorder()
    made = running(simulator)
    made.advance(START + PERIOD)
    assert simulator.steps == [(0.0, pytest.approx(1 / 60, rel=1e-6))]
    assert made.wind_state == 'none'


def test_the_wind_is_clamped_then_dies():
    simulator = Recorder()
    made = running(simulator, timeout=0.5, decay=0.2)
    play(made, [1] * 60)
    states, winds = [], []
    for tick in range(61, 61 + 180):
        made.advance(START + tick * PERIOD)
        states.append(made.wind_state)
        winds.append(simulator.steps[-1][0])
    assert [s for i, s in enumerate(states) if s not in states[:i]] == [
        'live',
        'holding',
        'decaying',
        'stale',
    ]
    assert abs(winds[-1]) < 1e-3
    assert np.abs(np.diff(winds)).max() < 1.0


def test_requests_are_done_before_the_next_step():
    made = running(Recorder())
    done = []
    made.request(lambda: done.append(1))
    assert done == []
    made.advance(START + PERIOD)
    assert done == [1]


def test_a_request_that_fails_is_counted_and_reported_and_the_steps_continue():
    simulator = Recorder()
    made, reasons, done = running(simulator), [], []

    def refuse():
        raise ParameterError('a tree that buckles', cure='give more stiffness')

    made.request(refuse, reasons.append)
    made.request(lambda: 1 / 0, reasons.append)
    made.request(lambda: [][0])
    made.request(lambda: done.append(1), reasons.append)
    assert made.advance(START + PERIOD) == 1
    assert len(simulator.steps) == done[0] == 1
    assert made.refused_requests == 3
    assert 'a tree that buckles' in reasons[0]
    assert reasons[1:] == ['it failed (ZeroDivisionError: division by zero)']


def test_a_jump_of_the_clock_is_no_long_wind():
    simulator = Recorder()
    made = running(simulator)
    made.offer(START, (5.0, 0.0, 0.0))
    made.advance(START + PERIOD)
    most = LONGEST_JUMP // PERIOD
    assert made.advance(START + 60 * SECOND) == most
    assert made.advance(2**62) == most
    assert made.clamped == 2
    assert made.advance(START + 61 * SECOND) == 1  # set back: it begins again
    assert len(simulator.steps) == 2 * most + 2


def test_a_sample_that_says_2038_holds_nothing():
    simulator = Recorder()
    made = running(simulator)
    for tick in range(1, 181):
        now = START + tick * PERIOD
        stamp = 2_147_483_647 * SECOND if tick == 60 else now
        made.offer(stamp, (5.0, 0.0, 0.0), now)
        assert made.advance(now) == 1
    assert made.counts.future_stamp == 1
    assert simulator.steps[-1][0] == pytest.approx(5.0)


def test_a_dropout_is_clamped_then_fades_and_the_wind_comes_back_without_a_step():
    simulator = Recorder()
    made = running(simulator)
    for tick in range(1, 60 * 30):
        now = START + tick * PERIOD
        if tick % 3 == 0 and not 300 < tick < 1200:
            made.offer(now, (8.0, 0.0, 0.0))
        made.advance(now)
    winds = np.array([wind for wind, _ in simulator.steps])
    assert winds[350] == pytest.approx(8.0)  # the last wind
    assert 0.0 < winds[1190] < 0.2  # after 13 s of tau 3 s
    assert winds[-1] == pytest.approx(8.0)
    assert np.abs(np.diff(winds[10:])).max() < 0.5


def sampled(made, times):
    for number in times:
        made.offer(START + number * 50_000_000, (5.0, 0.0, 0.0))


def test_a_sample_that_is_due_is_missed_until_it_arrives():
    made = running(Recorder())
    sampled(made, range(5))
    made.advance(START + 200_000_000)
    newest = START + 200_000_000
    assert not made.lacks_wind(newest + 40_000_000)
    assert made.lacks_wind(newest + 50_000_000)
    assert not made.lacks_wind(newest + 50_000_000, delay=0.02)
    sampled(made, (5,))
    assert not made.lacks_wind(newest + 50_000_000)


def test_nothing_is_missed_of_a_sensor_that_nobody_has_heard():
    made = running(Recorder())
    assert not made.lacks_wind(START + 10 * SECOND)


def test_before_the_period_is_known_any_sample_is_the_next():
    made = running(Recorder())
    sampled(made, (0,))
    assert not made.lacks_wind(START - 1)
    assert made.lacks_wind(START)
    assert not made.lacks_wind(START, delay=0.1)
    sampled(made, (1,))
    assert not made.lacks_wind(START)


def test_samples_after_the_step_of_their_time_are_counted():
    made = running(Recorder())
    sampled(made, range(5))
    made.advance(START + 300_000_000, delay=0.02)
    assert made.late == 0
    sampled(made, (5,))  # at 250 ms, where the steps are at 280 ms
    assert made.late == 1
    sampled(made, (6,))
    assert made.late == 1
    made.restart(START)
    assert made.late == 0
