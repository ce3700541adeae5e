# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The rate of simulated time: seconds of a ROS clock per second of the machine.

Limits on the transport of a message are times of the machine. In a replay at 5x they are five
times as long on the clock that stamps and arrivals are read from.
"""

from __future__ import annotations

from collections import deque
import time
from typing import Any

_SPAN = 3.0
"""Time over which the rate is measured [s]."""
_SHORTEST = 0.1
"""Time after which it is known [s]."""
_RESOLUTION = 0.02
"""Shortest interval between two readings [s]."""
_PAUSE = 0.5
"""Interval without a reading after which the clock was paused [s]."""
_FASTEST = 1000.0
"""Rate above which the clock was set forward; the fastest playback of the player."""
_JUMP = 0.5
"""Step of the clock that is accepted at any rate [s]."""


class ClockRate:
    """
    Measured rate of a clock that follows ``/clock``; 1 where it is the machine's own.

    A clock that is set, or paused, keeps the last rate until the next one is known.
    """

    def __init__(self) -> None:
        self.rate = 1.0
        """Seconds of the clock per second of the machine."""
        self._readings: deque[tuple[float, float]] = deque()
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

    def note(self, now: float, nanoseconds: int) -> None:
        """Note the time of the clock [ns] at a time of the machine [s]."""
        readings, shown = self._readings, 1e-9 * nanoseconds
        if readings:
            passed, step = now - readings[-1][0], shown - readings[-1][1]
            if passed > _PAUSE or not 0.0 <= step <= _JUMP + _FASTEST * passed:
                readings.clear()
            elif passed < _RESOLUTION:
                return
        readings.append((now, shown))
        while now - readings[0][0] > _SPAN:
            readings.popleft()
        begin, first = readings[0]
        if now - begin >= _SHORTEST:
            self.rate = (shown - first) / (now - begin)
