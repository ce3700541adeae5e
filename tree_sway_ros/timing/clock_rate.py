# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The rate of simulated time: seconds of a ROS clock per second of the machine.

Limits on the transport of a message are times of the machine. In a replay at 5x they are five
times as long on the clock that stamps and arrivals are read from.
"""

from __future__ import annotations

from collections import deque
from statistics import median_high
import time
from typing import Any

_RESOLUTION = 0.02
"""Shortest interval that is measured [s]."""
_INTERVALS, _FEWEST = 150, 5
"""Largest number of intervals that the rate is measured over, and the number that it needs."""
_FASTEST = 20.0
"""Rate that is allowed for until it is measured."""
_ALIKE = 2.0
"""Factor between an interval's rate and the median: outside, the clock was paused or set."""


class ClockRate:
    """
    Measured rate of a clock that follows ``/clock``; 1 where it is the machine's own.

    Intervals in which the clock was set or paused differ from the others, and are left out.
    """

    def __init__(self) -> None:
        self.rate = 1.0
        """Seconds of the clock per second of the machine."""
        self._last: tuple[float, float] | None = None
        self._intervals: deque[tuple[float, float]] = deque(maxlen=_INTERVALS)
        self._handle: Any = None

    def follow(self, clock: Any) -> None:
        """Read a ROS clock each time that it advances, until `close`."""
        from rclpy.clock import JumpThreshold
        from rclpy.duration import Duration

        smallest = Duration(nanoseconds=1)
        threshold = JumpThreshold(
            min_forward=smallest, min_backward=Duration(nanoseconds=-1), on_clock_change=False
        )
        self._handle = clock.create_jump_callback(
            threshold, post_callback=lambda _: self.note(time.monotonic(), clock.now().nanoseconds)
        )

    def close(self) -> None:
        """Stop reading; may be called twice."""
        if self._handle is not None:
            self._handle.unregister()
            self._handle = None

    @property
    def factor(self) -> float:
        """Factor by which limits in [s] of the machine are longer on the clock, at least 1."""
        return max(1.0, self.rate)

    @property
    def largest_factor(self) -> float:
        """Largest value that `factor` may have: a replay's rate is not known from its start."""
        return self.factor if len(self._intervals) >= _FEWEST else _FASTEST

    def note(self, now: float, nanoseconds: int) -> None:
        """Note the time of the clock [ns] at a time of the machine [s]."""
        shown = 1e-9 * nanoseconds
        if self._last is None:
            self._last = now, shown
            return
        passed = now - self._last[0]
        step = shown - self._last[1]
        if passed < _RESOLUTION:
            return
        self._last = now, shown
        self._intervals.append((passed, step))
        if len(self._intervals) < _FEWEST:
            return
        # One of the rates that were measured, so that some interval is like it.
        middle = median_high(step / passed for passed, step in self._intervals)
        alike = [
            (passed, step)
            for passed, step in self._intervals
            if middle / _ALIKE <= step / passed <= middle * _ALIKE
        ]
        if middle > 0.0:
            self.rate = sum(step for _, step in alike) / sum(passed for passed, _ in alike)
