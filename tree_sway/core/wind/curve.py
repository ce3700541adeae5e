# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A curve of straight lines through knots, of bounded memory, with its exact integral."""

from __future__ import annotations

from collections import deque

Vector = tuple[float, float, float]


class WindCurve:
    """
    Straight lines through the newest knots, level before the first and after the last.

    Of more knots than the capacity the oldest go first.
    """

    def __init__(self, capacity: int) -> None:
        """Start without a knot."""
        self._knots: deque[tuple[float, Vector]] = deque(maxlen=capacity)

    def __len__(self) -> int:
        """Return the number of knots."""
        return len(self._knots)

    @property
    def knots(self) -> tuple[tuple[float, Vector], ...]:
        """Times in [s] and values in [m/s] of all knots."""
        return tuple(self._knots)

    @property
    def end(self) -> float:
        """Time of the last knot in [s]."""
        return self._knots[-1][0]

    @property
    def last(self) -> Vector:
        """Value of the last knot in [m/s]."""
        return self._knots[-1][1]

    def clear(self) -> None:
        """Drop every knot."""
        self._knots.clear()

    def append(self, time: float, value: Vector) -> None:
        """Add a knot at the end; it replaces one of the same time, and is dropped if earlier."""
        if self._knots and time <= self._knots[-1][0]:
            if time < self._knots[-1][0]:
                return
            self._knots.pop()
        self._knots.append((time, value))

    def cut(self, time: float) -> None:
        """Drop what comes after a time in [s], and be level from there; the past is as it was."""
        if self._knots and self.end > time:
            value = self.value(time)
            while self._knots and self._knots[-1][0] >= time:
                self._knots.pop()
            self._knots.append((time, value))

    def shift(self, delay: float) -> None:
        """Move every knot later by a delay in [s]."""
        for _ in range(len(self._knots)):
            time, value = self._knots.popleft()
            self._knots.append((time + delay, value))

    def value(self, time: float) -> Vector:
        """Return the value at a time in [s]; there must be a knot."""
        after_time, after = self._knots[-1]
        if time >= after_time:
            return after
        for knot_time, knot in reversed(self._knots):
            if knot_time <= time:
                return _mix(knot, after, (time - knot_time) / (after_time - knot_time))
            after_time, after = knot_time, knot
        return after

    def mean(self, start: float, end: float, share: tuple[float, float] = (1.0, 1.0)) -> Vector:
        """
        Exact mean [m/s] of the curve from ``start`` to a later ``end`` in [s], given a knot.

        It is multiplied by the two shares at start and end, and evenly in between.
        """
        # From the newest knot back: a solver asks for the last step, which holds one knot or none.
        x = y = z = 0.0
        slope = (share[1] - share[0]) / (end - start)
        to, to_value = end, self.value(end)
        for time, knot in reversed(self._knots):
            if time >= end:
                continue
            since = max(time, start)
            first = knot if since == time else self.value(since)
            low, high = share[0] + slope * (since - start), share[0] + slope * (to - start)
            # The integral of the product of two straight lines.
            sixth = (to - since) / 6.0
            early, late = sixth * (2.0 * low + high), sixth * (low + 2.0 * high)
            x += early * first[0] + late * to_value[0]
            y += early * first[1] + late * to_value[1]
            z += early * first[2] + late * to_value[2]
            to, to_value = since, first
            if time <= start:
                break
        else:
            first = self._knots[0][1]
            level = (to - start) * (share[0] + 0.5 * slope * (to - start))
            x, y, z = x + level * first[0], y + level * first[1], z + level * first[2]
        width = end - start
        return x / width, y / width, z / width


def _mix(a: Vector, b: Vector, part: float) -> Vector:
    rest = 1.0 - part
    return rest * a[0] + part * b[0], rest * a[1] + part * b[1], rest * a[2] + part * b[2]
