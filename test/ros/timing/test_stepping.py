# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import time

import numpy as np
import pytest

from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.building import tree_from_segments
from tree_sway_ros.core.wind.averaging import WindAverage
from tree_sway_ros.ros.timing.stepping import Divider, Stepper

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

    def step(self, wind, dt):
        self.steps.append((float(wind[0]), dt))
        if self.cost:
            time.sleep(self.cost)
        return 0

    def place(self, out=None):
        return out

    def reset(self):
        self.resets += 1


def stepper(simulator, **options):
    made = Stepper(simulator, lambda: WindAverage(**options), PERIOD)
    made.restart(START)
    return made


def play(made, lateness):
    """Drive through ten seconds of wind, by ticks that stand for so many periods in turn."""
    index, sample = 0, 0
    for periods in lateness:
        index += periods
        now = START + index * PERIOD
        while START + sample * 50_000_000 <= now:
            wind = 5.0 + 3.0 * np.sin(0.3 * sample)
            made.add_wind(START + sample * 50_000_000, (wind, 0.0, 0.0))
            sample += 1
        made.advance(now, periods, 0.02)


def test_each_period_is_a_step():
    simulator = Recorder()
    stepper(simulator).advance(START + 3 * PERIOD, 3, 0.0)
    assert [dt for _, dt in simulator.steps] == pytest.approx([1 / 60] * 3, rel=1e-6)


def test_late_ticks_leave_no_trace_in_the_motion():
    poses = []
    for lateness in ([1] * 600, [4] * 150, [1, 7, 2, 20, 3, 5, 8, 4] * 12):
        simulator = SwaySimulator(TREE, model='subtree')
        made = stepper(simulator)
        made.warm_up()
        play(made, lateness)
        poses.append(simulator.place().copy())
    np.testing.assert_array_equal(poses[0], poses[1])
    np.testing.assert_array_equal(poses[0], poses[2])
    assert np.abs(poses[0] - SwaySimulator(TREE).place()).max() > 1e-4


def test_a_slow_simulator_takes_one_long_step_instead_of_a_backlog():
    simulator = Recorder(cost=0.012)
    made = stepper(simulator)
    made._cost = 0.012
    made.advance(START + 20 * PERIOD, 20, 0.0)
    assert [dt for _, dt in simulator.steps] == pytest.approx([20 / 60], rel=1e-6)


def test_pausing_stops_the_motion_and_not_the_wind():
    simulator = Recorder()
    made = stepper(simulator)
    made.is_paused = True
    play(made, [1] * 60)
    assert simulator.steps == []
    assert made.wind_state == 'live'


def test_a_restart_forgets_wind_and_motion():
    simulator = Recorder()
    made = stepper(simulator)
    play(made, [1] * 60)
    made.add_wind(START + 10**12, (9.0, 0.0, 0.0))
    made.restart(START - 10**12)
    made.advance(START - 10**12 + PERIOD, 1, 0.0)
    assert simulator.resets == 2
    assert simulator.steps[-1][0] == 0.0
    assert made.wind_state == 'none'


def test_no_wind_is_calm():
    simulator = Recorder()
    made = stepper(simulator)
    made.advance(START + PERIOD, 1, 0.0)
    assert simulator.steps == [(0.0, pytest.approx(1 / 60, rel=1e-6))]
    assert made.wind_state == 'none'


def test_the_wind_is_held_then_dies():
    simulator = Recorder()
    made = stepper(simulator, timeout=0.5, decay=0.2)
    play(made, [1] * 60)
    states, winds = [], []
    for tick in range(61, 61 + 180):
        made.advance(START + tick * PERIOD, 1, 0.0)
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
    made = stepper(Recorder())
    done = []
    made.request(lambda: done.append(1))
    assert done == []
    made.advance(START + PERIOD, 1, 0.0)
    assert done == [1]


def test_warming_up_leaves_a_tree_at_rest():
    simulator = SwaySimulator(TREE)
    rest = simulator.place().copy()
    Stepper(simulator, WindAverage, PERIOD).warm_up()
    np.testing.assert_array_equal(simulator.place(), rest)


@pytest.mark.parametrize('every', [1, 2, 3, 7])
def test_the_divider_lets_one_in_so_many_pass(every):
    divider = Divider()
    due = [divider.is_due(index, every) for index in range(100, 100 + 10 * every)]
    assert sum(due) in (10, 11)


def test_the_divider_loses_no_frame_to_a_late_tick():
    divider = Divider()
    assert [divider.is_due(index, 3) for index in (0, 1, 4, 5, 7, 20)] == [
        True,
        False,
        True,
        False,
        True,
        True,
    ]
