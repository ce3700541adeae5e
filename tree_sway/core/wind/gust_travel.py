# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts travel: the wind at a tree is that of the anemometer after a delay.

Turbulence moves with the mean wind and changes little on the way (Taylor 1938), so the wind of a
tree at x is ``U(t - x . w / Uc)``: w is the direction of the mean wind and Uc the speed at which
gusts travel, the mean speed itself over open ground and up to 1.8 of it over a closed canopy
(Raupach, Finnigan & Brunet 1996). Waves of sway in a stand follow from that.

The wind is stored as its run, the displacement of the air from the start to the end of a step: the
mean over any span is then the difference of two runs over the span. Delays follow the mean wind so
slowly that time increases for every tree.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_read, refuse_time_step, three_numbers, within
from tree_sway.core.kernel import kernel
from tree_sway.errors import ParameterError

SLOWEST_GUST = 0.5
"""
Mean speed in [m/s] below which delays decrease to 0 with the wind.

"""

LARGEST_STRETCH = 0.5
"""Largest change of the delay of a tree per second, in [s/s]."""


SPACING = 0.05
"""Time in [s] over which `GustHistory.recent` takes means."""


class GustHistory:
    """
    The wind of the last minute, and the present wind of each place.

    Parameters
    ----------
    places
        Places of trees in [m], (t, 3); heights do not matter.
    anemometer
        Place of the anemometer in [m], (3,), best upwind of all: trees upwind of it have the
        present wind, as a future one is not measured. If None, it is the place that the mean wind
        reaches first, in any direction.
    convection_ratio
        Speed at which gusts travel over the mean wind speed in [-]; infinite for one wind
        everywhere.
    averaging_time
        Time constant of the mean wind in [s].
    memory
        Longest delay in [s].
    capacity
        Number of stored times. Steps shorter than a part of ``memory`` are joined, so that the
        history has the same length at any rate: the default stores every step of 60 s at up to 500
        steps per second.

    Raises
    ------
    ParameterError
        If a place is not finite or a value is out of its range.

    """

    def __init__(
        self,
        places: ArrayLike,
        anemometer: ArrayLike | None = None,
        *,
        convection_ratio: float = 1.0,
        averaging_time: float = 60.0,
        memory: float = 60.0,
        capacity: int = 1 << 15,
    ) -> None:
        """Allocate the history; nothing is allocated later."""
        points = np.array(places, dtype=np.float64).reshape(-1, 3)
        if not np.isfinite(points).all():
            raise ParameterError('a place that is not finite', where='places', cure='give metres')
        self.anemometer: Floats | None = None
        """Place of the anemometer in [m], (3,); None for the first place that the wind reaches."""
        if anemometer is not None:
            self.anemometer = np.array(three_numbers('anemometer', anemometer))
        self._origin = np.zeros(2) if self.anemometer is None else self.anemometer[:2]
        self._along = points[:, :2] - self._origin
        self.convection_ratio = within('convection_ratio', convection_ratio, 0.1, math.inf)
        """Speed of gusts over the mean wind speed."""
        self._averaging = within('averaging_time', averaging_time, 0.0, 3600.0, 's', above=True)
        self._memory = within('memory', memory, 0.0, 600.0, 's')
        self._run = np.zeros((int(within('capacity', capacity, 8, 1e6)), 4))
        # Two consecutive steps are together longer than this, so that all are longer than the
        # memory and the steps at its ends.
        self._finest = 2.0 * self._memory / (len(self._run) - 4)
        self._at = np.zeros(2, dtype=np.int64)
        self._n_changes = 0
        """Odd while the history is written."""
        self._mean = np.zeros(3)
        self._wanted = np.zeros(len(points))
        self._first = np.zeros(1)
        """Delay from the origin to the place that the mean wind reaches first, at most 0 [s]."""
        self.delay = np.zeros(len(points))
        """Delay of the wind at each place in [s], (t,)."""
        self._winds = np.zeros((len(points), 3))

    def push(self, wind_mean: ArrayLike, dt: float) -> Floats:
        """
        Add the mean wind (3,) [m/s] of a step of dt [s]; return that of each place.

        It is (t, 3); the array is reused. Raises a `ParameterError` for a number that is not
        finite, or a step that is not above 0.
        """
        x, y, z = three_numbers('wind', wind_mean)
        refuse_time_step(dt, math.inf)
        if not math.isfinite(x + y + z):
            raise ParameterError(f'wind ({x}, {y}, {z}) m/s', cure='give finite numbers')
        self._n_changes += 1
        try:
            return self._pushed(x, y, z, dt)
        finally:
            self._n_changes += 1

    def _pushed(self, x: float, y: float, z: float, dt: float) -> Floats:
        remember(self._run, self._at, self._finest, x, y, z, dt)
        follow_mean(self._mean, x, y, dt, self._averaging)
        east, north, _ = self._mean.tolist()
        self._wanted = _delays(self._along, east, north, self.convection_ratio)
        if self.anemometer is None:
            self._first[0] = self._wanted.min()
            self._wanted -= self._first[0]
        past_winds(
            self._run, self._at, self._wanted, self.delay, self._memory, x, y, z, dt, self._winds
        )
        return self._winds

    @property
    def time(self) -> float:
        """Time of the history at the end of the last step in [s]."""
        return float(self._run[self._at[0], 0])

    def wind_at(self, x: float, y: float) -> Floats:
        """
        Wind at any place [m] at the end of the last step in [m/s], (3,); from any thread.

        It is the mean over the last `SPACING`, without the slow change of delays.
        """
        at, run, mean, _, first = self._copied()
        if at[1] < 2:
            return np.zeros(3)
        east, north, _ = mean.tolist()
        along = np.array([[x, y]]) - self._origin
        delay = float(_delays(along, east, north, self.convection_ratio)[0]) - first
        oldest = float(run[(at[0] - at[1] + 1) % len(run), 0])
        now = float(run[at[0], 0]) - min(max(delay, 0.0), self._memory)
        span = min(SPACING, float(run[at[0], 0]) - oldest)
        begin, end = (run_until(run, at, time) for time in (now - span, now))
        return (np.array(end) - np.array(begin)) / span

    def recent(self, until: float) -> dict[str, list[float]]:
        """
        Return the state for a copy to continue from, a step or two ago; from any thread.

        ``mean`` is the mean wind with its span, ``delay`` that of each place, ``wind`` the means
        over each `SPACING` of the last minute, x, y, z of one after the other.
        """
        at, run, mean, delay, _ = self._copied()
        rows = run[np.arange(at[0] - max(at[1], 1) + 1, at[0] + 1) % len(run)]
        count = min(self._memory, until - float(rows[0, 0])) // SPACING
        times = until + SPACING * np.arange(-count, 1.0)
        runs = [np.interp(times, rows[:, 0], rows[:, k]) for k in (1, 2, 3)]
        wind = np.diff(runs).T.ravel() / SPACING
        found = {'mean': mean, 'delay': delay, 'wind': wind}
        return {name: each.round(4).tolist() for name, each in found.items()}

    def _copied(self) -> tuple[NDArray[np.int64], Floats, Floats, Floats, float]:
        """Copy the history between two steps: its ends, runs, mean wind, delays, first delay."""
        while True:
            before = self._n_changes
            at = self._at.copy()
            run = self._run.copy()
            mean = self._mean.copy()
            delay = self.delay.copy()
            first = float(self._first[0])
            if self._n_changes == before and before % 2 == 0:
                return at, run, mean, delay, first

    def go_on(self, mean: ArrayLike, delay: ArrayLike, wind: ArrayLike) -> None:
        """Continue from the `recent` of a history of the same places."""
        rows = array_to_read('gusts', wind, (np.size(wind) // 3 * 3,)).reshape(-1, 3)
        means = array_to_read('gusts', mean, self._mean.shape)
        delays = array_to_read('gusts', delay, self.delay.shape)
        if not all(np.isfinite(each).all() for each in (rows, means, delays)):
            raise ParameterError('history is not finite', where='gusts')
        self.reset()
        self._n_changes += 1
        for x, y, z in rows.tolist():
            remember(self._run, self._at, self._finest, x, y, z, SPACING)
        self._mean[:] = means
        self.delay[:] = delays
        self._n_changes += 1

    def memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the state."""
        return self._run, self._at, self._mean, self._wanted, self.delay, self._first

    def reset(self) -> None:
        """Forget the wind."""
        self._n_changes += 1
        for array in (self._at, self._mean, self._wanted, self.delay, self._winds):
            array[:] = 0
        self._n_changes += 1


def _delays(along: Floats, east: float, north: float, ratio: float) -> Floats:
    """Delays of places [m] from the origin, (t, 2), by the mean wind [m/s], in [s], (t,)."""
    speed = max(math.hypot(east, north), SLOWEST_GUST)
    return np.asarray((along[:, 0] * east + along[:, 1] * north) / (ratio * speed * speed))


@kernel
def remember(
    run: Floats, at: NDArray[np.int64], finest: float, x: float, y: float, z: float, dt: float
) -> None:
    """Write time and run of the wind at the end of the step; the ring begins with its start."""
    size = len(run)
    if at[1] == 0:
        run[0] = 0.0
        at[0] = 0
        at[1] = 1
    last = at[0]
    step = (dt, x * dt, y * dt, z * dt)
    is_joined = at[1] > 2 and run[last, 0] + dt - run[(last - 1) % size, 0] <= finest
    head = last if is_joined else (last + 1) % size
    for k in range(4):
        if head < last:
            # Counted from zero again, so that the numbers do not grow with the days.
            origin = run[last, k]
            for i in range(size):
                run[i, k] -= origin
        run[head, k] = run[last, k] + step[k]
    if not is_joined:
        at[0], at[1] = head, min(at[1] + 1, size)


@kernel
def follow_mean(mean: Floats, x: float, y: float, dt: float, averaging: float) -> None:
    """Update a plain mean of the first wind, then a running one; its span is the last element."""
    mean[2] = min(mean[2] + dt, max(averaging, dt))
    weight = dt / mean[2]
    mean[0] += weight * (x - mean[0])
    mean[1] += weight * (y - mean[1])


@kernel
def past_winds(
    run: Floats, at: NDArray[np.int64], wanted: Floats, delay: Floats, longest: float,
    x: float, y: float, z: float, dt: float, out: Floats,
) -> None:  # fmt: skip
    """Move delays [s], (t,), towards their targets; average the history over the step of each."""
    now = run[at[0], 0]
    most = LARGEST_STRETCH * dt
    for i in range(len(delay)):
        goal = min(max(wanted[i], 0.0), longest)
        before = delay[i]
        if at[1] == 2:
            # The first step has no delays before it.
            before = goal
        delay[i] = min(max(goal, before - most), before + most)
        if before == 0.0 and delay[i] == 0.0:
            out[i, 0] = x
            out[i, 1] = y
            out[i, 2] = z
            continue
        begin = now - dt - before
        end = now - delay[i]
        bx, by, bz = run_until(run, at, begin)
        ex, ey, ez = run_until(run, at, end)
        span = end - begin
        out[i, 0] = (ex - bx) / span
        out[i, 1] = (ey - by) / span
        out[i, 2] = (ez - bz) / span


@kernel
def run_until(run: Floats, at: NDArray[np.int64], time: float) -> tuple[float, float, float]:
    """Run of the wind at a time; before the history begins it is that of its first step."""
    size = len(run)
    count = at[1]
    oldest = at[0] - count + 1
    low = 0
    high = count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if run[(oldest + middle) % size, 0] <= time:
            low = middle
        else:
            high = middle
    a = run[(oldest + low) % size]
    b = run[(oldest + high) % size]
    u = (time - a[0]) / (b[0] - a[0])
    return a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2]), a[3] + u * (b[3] - a[3])
