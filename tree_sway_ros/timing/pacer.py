# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A thread that works at a fixed rate, on a grid of absolute times of a ROS clock.

Ticks lie at whole multiples of the period since the clock's epoch, so two runs over the same
record tick at the same times. The number of periods since the last tick is counted from the clock,
not from the calls: a late tick reports how many it covers, and missed ones are skipped, without a
burst. Simulated time is followed: there are no ticks while it is paused, and the next tick reports
if it was set back.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
import threading
import time
from typing import Any, NamedTuple

import numpy as np

from tree_sway.worker import Worker
from tree_sway_ros.timing.clock_rate import ClockRate

LONGEST_STEP = 500_000_000
"""
Longest time of a tick [ns]: a clock that jumped forward is not a long step.

In simulated time it is a time of the machine, by which the publisher of the clock may be late and
then hurry, beside the time by which this thread is.

"""
PATIENCE = 10
"""Number of ticks that may fail one after another before the thread gives up."""
_BACK = 100_000_000
_WINDOW = 600
_APART = 50_000_000
"""Time that may pass between the readings of two clocks [ns]."""


class Tick(NamedTuple):
    """
    One tick: its time on the grid [ns], and the periods since the last one, 1 unless late.

    ``restarted`` is true for the first, and for the first after the clock was set back.
    """

    time: int
    periods: int
    restarted: bool


class Timing(NamedTuple):
    """
    Timing of the rate: rate [Hz], lateness [s], work [s], and counts since the start.

    `skipped` are missing frames of the grid; `clamped` are jumps of the clock forward, `restarts`
    jumps back, `silence` is the time since the last tick [s].
    """

    rate: float
    late_p50: float
    late_p95: float
    late_max: float
    work_mean: float
    ticks: int
    skipped: int
    clamped: int
    restarts: int
    silence: float


@dataclass(eq=False)
class Pacer(Worker):
    """
    Thread that calls `work` with each tick at a fixed rate [Hz], by a node's clock.

    After exceptions in `PATIENCE` consecutive ticks `on_error` is called, and the thread ends;
    before that `on_slip` is called, and the next tick follows.
    """

    clock: Any
    rate: float
    work: Callable[[Tick], None]
    on_error: Callable[[Exception], None]
    on_slip: Callable[[Exception], None] = lambda _error: None
    clock_rate: ClockRate = field(default_factory=ClockRate)

    def __post_init__(self) -> None:
        """Prepare the thread."""
        super().__init__('pacer')
        self.period = round(1e9 / self.rate)
        self._slips = self._last_steady = self._late = 0
        self._last: int | None = None
        self._wake = threading.Event()
        self._recent: deque[tuple[float, int, float]] = deque(maxlen=_WINDOW)
        self._ticks = self._skipped = self._clamped = self._restarts = 0
        self._jumps: Any = None

    def start(self) -> None:
        """Start ticking from the beginning; the counts continue."""
        from rclpy.clock import JumpThreshold
        from rclpy.duration import Duration

        self._last = None
        self._recent.clear()
        # Simulated time moves by jumps; each wakes the thread.
        smallest = Duration(nanoseconds=1)
        threshold = JumpThreshold(
            min_forward=smallest, min_backward=Duration(nanoseconds=-1), on_clock_change=True
        )
        self._jumps = self.clock.create_jump_callback(
            threshold, post_callback=lambda _jump: self._wake.set()
        )
        super().start()

    def stop(self) -> None:
        """Stop ticking, and wait for the work under way."""
        self._stopping.set()
        self._wake.set()
        super().stop()
        if self._jumps is not None:
            self._jumps.unregister()
            self._jumps = None

    @property
    def is_simulated(self) -> bool:
        """Whether the clock is simulated time, which may be paused."""
        return bool(self.clock.ros_time_is_active)

    def timing(self) -> Timing:
        """Return the timing over the last 600 ticks."""
        silence = 1e-9 * (time.monotonic_ns() - self._last_steady) if self._last_steady else 0.0
        counts = (self._ticks, self._skipped, self._clamped, self._restarts, silence)
        begin, late, work = np.array(list(self._recent) or [(0.0, 0, 0.0)]).T
        rate = (len(begin) - 1) / max(1e-9, begin[-1] - begin[0])
        p50, p95, most = np.quantile(1e-9 * late, (0.5, 0.95, 1.0)).tolist()
        return Timing(float(rate), p50, p95, most, float(work.mean()), *counts)

    def _run(self) -> None:
        while not self._stopping.is_set():
            try:
                self._go_on()
            except Exception as error:
                self._slips += 1
                if self._stopping.is_set():
                    return
                if self._slips >= PATIENCE:
                    return self.on_error(error)
                self.on_slip(error)

    def _go_on(self) -> None:
        """Work if a tick is due, else sleep until one may be."""
        self._wake.clear()
        now = self.clock.now().nanoseconds
        tick = self._due(now)
        if tick is None:
            self._wake.wait(self._until_next(now))
            return
        begin = time.perf_counter()
        self.work(tick)
        self._slips = 0
        self._recent.append((begin, now - tick.time, time.perf_counter() - begin))
        self._ticks += 1

    def _due(self, now: int) -> Tick | None:
        """Return the due tick, if there is one."""
        if now <= 0:  # simulated time that has not begun
            return None
        index = now // self.period
        if self._last is None or now < self._last * self.period - _BACK:
            self._restarts += self._last is not None
            self._last = index
            self._last_steady = time.monotonic_ns()
            self._late = now % self.period
            return Tick(index * self.period, 1, True)
        periods = index - self._last
        if periods <= 0:
            return None
        steady = time.monotonic_ns()
        since = steady - self._last_steady
        passed = since + self._late  # since the last tick's time on the grid
        self._last = index
        self._last_steady = steady
        self._late = now % self.period
        longest = LONGEST_STEP
        if self.is_simulated:  # in a fast replay much of it passes while a thread is late
            longest = round(self.clock_rate.largest_factor * (LONGEST_STEP + since))
        most = max(1, longest // self.period)
        if not self.is_simulated:
            # What a wall clock that was set forward adds is not skipped.
            jumped = periods * self.period > passed + LONGEST_STEP
            elapsed = passed if jumped else passed + _APART
            self._skipped += min(periods, max(1, round(elapsed / self.period))) - 1
            self._clamped += jumped
        elif periods > most:
            self._clamped += 1
        return Tick(index * self.period, min(periods, most), False)

    def _until_next(self, now: int) -> float | None:
        """Longest sleep in [s]; simulated time wakes the thread by itself."""
        if self.is_simulated or self._last is None:
            return 0.5
        return max(0.0, ((self._last + 1) * self.period - now) * 1e-9)
