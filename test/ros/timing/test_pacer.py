# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

from rclpy.clock import ROSClock  # noqa: E402
from rclpy.time import Time  # noqa: E402

from tree_sway_ros.timing import pacer  # noqa: E402
from tree_sway_ros.timing.clock_rate import ClockRate  # noqa: E402
from tree_sway_ros.timing.pacer import LONGEST_STEP, Pacer, PATIENCE  # noqa: E402

DEADLINE = 10.0
PERIOD = 20_000_000  # of 50 Hz


class Ticks:
    """A pacer with its ticks, on a clock of ours or on the wall's."""

    def __init__(self, rate=50.0, work=None):
        self.clock = ROSClock()
        self.seen = []
        self.errors, self.slips = [], []
        self._more = threading.Condition()
        self._work = work
        self.pacer = Pacer(self.clock, rate, self._take, self.errors.append, self.slips.append)

    def _take(self, tick):
        if self._work is not None:
            self._work()
        with self._more:
            self.seen.append(tick)
            self._more.notify_all()

    def simulate(self):
        self.clock._set_ros_time_is_active(True)
        self.pacer.start()
        return self

    def set(self, nanoseconds, wait_for=None):  # noqa: A003
        self.clock.set_ros_time_override(
            Time(nanoseconds=nanoseconds, clock_type=self.clock.clock_type)
        )
        if wait_for is not None:
            self.wait(wait_for)

    def wait(self, n):
        with self._more:
            assert self._more.wait_for(lambda: len(self.seen) >= n, DEADLINE), self.seen


@pytest.fixture
def ticks():
    made = []

    def make(**options):
        made.append(Ticks(**options))
        return made[-1]

    yield make
    for item in made:
        item.pacer.stop()


def test_wall_time_ticks_on_the_grid(ticks):
    paced = ticks(rate=200.0)
    paced.pacer.start()
    paced.wait(100)
    paced.pacer.stop()
    timing = paced.pacer.timing()
    times = np.array([tick.time for tick in paced.seen])
    periods = np.array([tick.periods for tick in paced.seen])
    assert (times % paced.pacer.period == 0).all()
    # Whatever the load: time is counted from the clock, so no period is lost or made up.
    np.testing.assert_array_equal(np.diff(times), periods[1:] * paced.pacer.period)
    assert timing.ticks >= 100
    assert timing.skipped == (periods - 1).sum()


def test_the_rate_that_is_reported_is_that_of_the_ticks(monkeypatch):
    wall = Wall(monkeypatch)
    monkeypatch.setattr(pacer.time, 'perf_counter', lambda: 1e-9 * wall.steady)
    monkeypatch.setattr(wall, 'now', lambda: SimpleNamespace(nanoseconds=wall.wall), raising=False)
    paced = Pacer(wall, 200.0, print, print)
    for _ in range(100):
        paced._go_on()
        wall.go(0.005)
    assert paced.timing().rate == pytest.approx(200.0)
    assert paced.timing().ticks == 100


def test_simulated_time_is_followed(ticks):
    paced = ticks().simulate()
    for k in range(5):
        paced.set(10**9 + k * PERIOD, wait_for=k + 1)
    assert [tick.time for tick in paced.seen] == [10**9 + k * PERIOD for k in range(5)]
    assert [tick.restarted for tick in paced.seen] == [True] + [False] * 4
    assert paced.pacer.timing().skipped == 0


def test_paused_time_ticks_nothing(ticks):
    paced = ticks().simulate()
    paced.set(10**9, wait_for=1)
    paced.set(10**9 + PERIOD // 2)
    paced.set(10**9 + PERIOD // 2 + 1)
    assert len(paced.seen) == 1
    paced.set(10**9 + PERIOD, wait_for=2)
    assert len(paced.seen) == 2


def test_time_that_has_not_begun_ticks_nothing(ticks):
    paced = ticks().simulate()
    paced.set(0)
    paced.set(5 * 10**9, wait_for=1)
    assert [tick.time for tick in paced.seen] == [5 * 10**9]


def test_a_coarse_clock_is_counted_in_periods(ticks):
    paced = ticks().simulate()
    paced.set(10**9, wait_for=1)
    paced.set(10**9 + 3 * PERIOD, wait_for=2)
    assert paced.seen[1].periods == 3
    assert not paced.seen[1].restarted


def test_a_jump_back_restarts_at_once(ticks):
    paced = ticks().simulate()
    paced.set(100 * 10**9, wait_for=1)
    paced.set(10**9, wait_for=2)
    assert paced.seen[1] == (10**9, 1, True)
    assert paced.pacer.timing().restarts == 1


def test_a_jump_forward_is_no_long_step(ticks):
    paced = ticks().simulate()
    paced.set(10**9, wait_for=1)
    paced.set(1000 * 10**9, wait_for=2)
    assert paced.seen[1].periods * PERIOD <= 0.1 * 999 * 10**9
    assert paced.pacer.timing().clamped == 1


def test_a_late_thread_in_a_fast_replay_skips_nothing(monkeypatch):
    """At 20x, 0.2 s of the machine are 4 s of the clock; 3600 s in the same time are a jump."""
    paced, wall = replayed(monkeypatch, 20.0)
    assert paced._due(wall.go(0.2, wall=4.0)).periods == 200
    assert paced.timing().clamped == 0
    assert paced._due(wall.go(0.2, wall=3600.0)).periods <= 50 * 20.0 * (0.2 + 0.5)
    assert paced.timing().clamped == 1


def replayed(monkeypatch, rate):
    """Return a pacer and its clock, in a replay whose rate was measured."""
    wall, measured = Wall(monkeypatch), ClockRate()
    wall.ros_time_is_active = True
    for count in range(10):
        measured.note(0.05 * count, round(1e9 * rate * 0.05 * count))
    paced = Pacer(wall, 50.0, print, print, clock_rate=measured)
    paced._due(wall.wall)
    return paced, wall


def test_a_player_that_is_late_and_then_hurries_skips_nothing(monkeypatch):
    """At 2x, what it lacks after 0.4 s without a tick comes within a hundredth of a second."""
    paced, wall = replayed(monkeypatch, 2.0)
    assert paced._due(wall.go(0.01, wall=0.8)).periods == 40
    assert paced.timing().clamped == 0


def test_a_wait_at_the_start_of_a_fast_replay_skips_nothing(monkeypatch):
    """The first wind is waited for while ticks of the clock are too few to tell its rate."""
    wall = Wall(monkeypatch)
    wall.ros_time_is_active = True
    paced = Pacer(wall, 50.0, print, print)
    paced._due(wall.wall)
    assert paced._due(wall.go(1.0, wall=5.0)).periods == 250
    assert paced.timing().clamped == 0


def test_work_that_takes_too_long_skips_frames_without_a_backlog(ticks):
    paced = ticks(rate=100.0, work=lambda: time.sleep(0.025))
    paced.pacer.start()
    paced.wait(12)
    late = [tick.periods for tick in paced.seen[1:]]
    assert min(late) >= 2
    assert max(late) <= LONGEST_STEP / paced.pacer.period
    timing = paced.pacer.timing()
    assert timing.skipped > 0
    assert timing.late_p50 < 0.01  # of the newest period: nothing queues up


def test_one_tick_that_fails_is_reported_and_the_next_comes(ticks):
    failing = iter([True, False, True] + [False] * 100)

    def fail():
        if next(failing):
            raise ValueError('no')

    paced = ticks(rate=200.0, work=fail)
    paced.pacer.start()
    paced.wait(5)
    assert [str(error) for error in paced.slips] == ['no', 'no']
    assert paced.errors == []


def test_an_error_in_tick_after_tick_ends_the_thread(ticks):
    def fail():
        raise ValueError('no')

    paced = ticks(rate=200.0, work=fail)
    paced.pacer.start()
    paced.pacer._thread.join(DEADLINE)
    assert [str(error) for error in paced.errors] == ['no']
    assert len(paced.slips) == PATIENCE - 1


class Wall:
    """The wall's clock and the steady one, in the hand of the test."""

    ros_time_is_active = False

    def __init__(self, monkeypatch):
        self.wall, self.steady = 10**18, 10**9
        monkeypatch.setattr(pacer.time, 'monotonic_ns', lambda: self.steady)

    def go(self, seconds, wall=None):
        self.steady += round(seconds * 1e9)
        self.wall += round((seconds if wall is None else wall) * 1e9)
        return self.wall


def test_what_is_skipped_is_counted_whatever_its_length(monkeypatch):
    """1.2 frames in a second where 60 were asked for: 98 of 100 are skipped."""
    wall = Wall(monkeypatch)
    paced = Pacer(wall, 60.0, print, print)
    paced._due(wall.wall)
    seen = [paced._due(wall.go(1.0 / 1.2)) for _ in range(12)]
    assert paced.timing().skipped == pytest.approx(600 - 12, abs=1)
    assert paced.timing().clamped == 0
    assert all(tick.periods * paced.period <= LONGEST_STEP for tick in seen)
    assert paced.timing().silence == 0.0
    wall.go(3.0)
    assert paced.timing().silence == pytest.approx(3.0)


def test_a_wall_clock_set_forward_skips_nothing(monkeypatch):
    wall = Wall(monkeypatch)
    paced = Pacer(wall, 50.0, print, print)
    paced._due(wall.wall)
    paced._due(wall.go(0.02, wall=3600.0))
    assert (paced.timing().skipped, paced.timing().clamped) == (0, 1)


def test_an_interruption_between_the_readings_of_two_clocks_loses_no_frame(monkeypatch):
    """The steady clock is read 4 ms after the wall's at one tick, and at once at the next."""
    wall = Wall(monkeypatch)
    paced = Pacer(wall, 200.0, print, print)
    paced._due(wall.go(0.004, wall=0.0))
    assert paced._due(wall.go(0.006, wall=0.01)).periods == 2
    assert (paced.timing().skipped, paced.timing().clamped) == (1, 0)


def test_stopping_twice_or_before_the_start_is_harmless(ticks):
    paced = ticks()
    paced.pacer.stop()
    paced = ticks()
    paced.pacer.start()
    paced.pacer.stop()
    paced.pacer.stop()
    assert not paced.pacer._thread.is_alive()


def test_a_pace_of_nothing_is_zero(ticks):
    assert ticks().pacer.timing() == (0.0,) * 5 + (0,) * 4 + (0.0,)
