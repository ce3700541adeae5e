# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts travel: the wind at a tree is that of the anemometer after a delay.

Turbulence moves with the mean wind and changes little on the way (Taylor 1938), so the wind of a
tree at x is ``U(t - x . w / Uc)``: w is the direction of the mean wind and Uc the speed at which
gusts travel, the mean speed itself over open ground and up to 1.8 of it over a closed canopy
(Raupach, Finnigan & Brunet 1996). Waves of sway in a stand follow from that.

Delays follow the mean wind so slowly that time increases for every tree.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_read, refuse_time_step, three_numbers, within
from tree_sway.core.wind.gusts.wind_history import follow_mean, WindHistory
from tree_sway.errors import ParameterError

SLOWEST_GUST = 0.5
"""Mean speed in [m/s] below which delays decrease to 0 with the wind."""

_SPACING = 0.05
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
        stored = int(within('capacity', capacity, 8, 1e6))
        self._history = WindHistory(stored, self._memory)
        self._step_wind = np.zeros(3)
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
        self._step_wind[:] = x, y, z
        follow_mean(self._mean, x, y, dt, self._averaging)
        east, north, _ = self._mean.tolist()
        self._wanted = _delays(self._along, east, north, self.convection_ratio)
        if self.anemometer is None:
            self._first[0] = self._wanted.min()
            self._wanted -= self._first[0]
        self._history.add(self._step_wind, dt, self._wanted, self.delay, self._winds)
        return self._winds

    @property
    def time(self) -> float:
        """Time of the history at the end of the last step in [s]."""
        return self._history.time

    def wind_at(self, x: float, y: float) -> Floats:
        """
        Wind at any place [m] at the end of the last step in [m/s], (3,); from any thread.

        It is the mean over the last `_SPACING`, without the slow change of delays.
        """
        rows, mean, _, first = self._copied()
        if len(rows) < 2:
            return np.zeros(3)
        east, north, _ = mean.tolist()
        along = np.array([[x, y]]) - self._origin
        (from_origin,) = _delays(along, east, north, self.convection_ratio).tolist()
        delay = min(max(from_origin - first, 0.0), self._memory)
        oldest = float(rows[0, 0])
        newest = float(rows[-1, 0])
        span = min(_SPACING, newest - oldest)
        now = newest - delay
        run = _run_until(rows, now) - _run_until(rows, now - span)
        return run / span

    def recent(self, until: float) -> dict[str, list[float]]:
        """
        Return the state for a copy to continue from, a step or two ago; from any thread.

        ``mean`` is the mean wind with its span, ``delay`` that of each place, ``wind`` the means
        over each `_SPACING` of the last minute, x, y, z of one after the other.
        """
        rows, mean, delay, _ = self._copied()
        stored = until - float(rows[0, 0])
        count = min(self._memory, stored) // _SPACING
        times = until + _SPACING * np.arange(-count, 1.0)
        ends, *runs_at_ends = rows.T
        runs = [np.interp(times, ends, each) for each in runs_at_ends]
        wind = np.diff(runs).T.ravel() / _SPACING
        return {
            'mean': mean.round(4).tolist(),
            'delay': delay.round(4).tolist(),
            'wind': wind.round(4).tolist(),
        }

    def _copied(self) -> tuple[Floats, Floats, Floats, float]:
        """Copy the history between two steps: its runs, mean wind, delays, first delay."""
        while True:
            before = self._n_changes
            rows = self._history.rows()
            mean = self._mean.copy()
            delay = self.delay.copy()
            first = float(self._first[0])
            if self._n_changes == before and before % 2 == 0:
                return rows, mean, delay, first

    def go_on(self, mean: ArrayLike, delay: ArrayLike, wind: ArrayLike) -> None:
        """Continue from the `recent` of a history of the same places."""
        whole_rows = np.size(wind) // 3 * 3
        rows = array_to_read('gusts', wind, (whole_rows,)).reshape(-1, 3)
        means = array_to_read('gusts', mean, self._mean.shape)
        delays = array_to_read('gusts', delay, self.delay.shape)
        if not all(np.isfinite(each).all() for each in (rows, means, delays)):
            raise ParameterError('history is not finite', where='gusts')
        self.reset()
        self._n_changes += 1
        none = np.zeros(0)
        for row in rows:
            self._history.add(row, _SPACING, none, none, none)
        self._mean[:] = means
        self.delay[:] = delays
        self._n_changes += 1

    def memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the state."""
        return *self._history.memory(), self._mean, self._wanted, self.delay, self._first

    def reset(self) -> None:
        """Forget the wind."""
        self._n_changes += 1
        self._history.reset()
        for array in (self._mean, self._wanted, self.delay, self._winds):
            array[:] = 0
        self._n_changes += 1


def _delays(along: Floats, east: float, north: float, ratio: float) -> Floats:
    """Delays of places [m] from the origin, (t, 2), by the mean wind [m/s], in [s], (t,)."""
    speed = max(math.hypot(east, north), SLOWEST_GUST)
    on_the_way = along[:, 0] * east + along[:, 1] * north
    of_gusts = ratio * speed
    return np.asarray(on_the_way / (of_gusts * speed))


def _run_until(rows: Floats, time: float) -> Floats:
    """Run of the wind at a time, (3,); before the history begins it is that of its first step."""
    found = np.searchsorted(rows[:, 0], time, 'right')
    later = int(np.clip(found, 1, len(rows) - 1))
    before = rows[later - 1]
    after = rows[later]
    step = after - before
    share = (time - before[0]) / step[0]
    return np.asarray(before[1:] + share * step[1:])
