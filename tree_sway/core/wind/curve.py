# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A piecewise linear curve of bounded memory, with its exact mean."""

from __future__ import annotations

from collections import deque
from itertools import takewhile

import numpy as np

from tree_sway.core.arrays import Floats


class WindCurve:
    """
    Linear interpolation of the newest knots, constant before the first and after the last.

    Beyond the capacity the oldest knots are dropped. Times are in [s], values in [m/s], (3,).
    """

    def __init__(self, capacity: int) -> None:
        """Start without a knot."""
        self.knots: deque[tuple[float, Floats]] = deque(maxlen=capacity)

    @property
    def end(self) -> float:
        """Time of the last knot in [s]."""
        return self.knots[-1][0]

    @property
    def last(self) -> Floats:
        """Value of the last knot in [m/s], (3,)."""
        return self.knots[-1][1]

    def append(self, time: float, value: Floats) -> None:
        """Add a knot at the end; it replaces one of the same time, and is dropped if earlier."""
        if self.knots and time <= self.end:
            if time < self.end:
                return
            self.knots.pop()
        self.knots.append((time, value))

    def cut(self, time: float) -> None:
        """Drop knots after a time in [s], with a constant value from there on."""
        if self.knots and self.end > time:
            value = self.value(time)
            while self.knots and self.end >= time:
                self.knots.pop()
            self.knots.append((time, value))

    def shift(self, delay: float) -> None:
        """Move every knot later by a delay in [s]."""
        moved = [(time + delay, value) for time, value in self.knots]
        self.knots = deque(moved, maxlen=self.knots.maxlen)

    def value(self, time: float) -> Floats:
        """Return the value at a time in [s]; there must be a knot."""
        after_time, after = self.knots[-1]
        if time >= after_time:
            return after
        for knot_time, knot in reversed(self.knots):
            if knot_time <= time:
                part = (time - knot_time) / (after_time - knot_time)
                return (1.0 - part) * knot + part * after
            after_time = knot_time
            after = knot
        return after

    def mean(self, start: float, end: float) -> Floats:
        """Exact mean [m/s] of the curve from ``start`` to ``end`` in [s], given a knot."""
        if start == end:
            return self.value(start)
        # From the newest knot back: the last step has one knot or none.
        later = takewhile(lambda knot: knot[0] > start, reversed(self.knots))
        times = np.array([end, *(time for time, _ in later if time < end), start])
        values = np.array([self.value(time) for time in times])
        return np.asarray(0.5 * np.diff(times) @ (values[1:] + values[:-1]) / (start - end))
