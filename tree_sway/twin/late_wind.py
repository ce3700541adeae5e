# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind at a tree that stands downwind of the anemometer: the one measured some seconds ago.

Gusts travel with the mean wind, as in `gust_travel`. Either the distance is told, or `wind_lag`
finds how long they take, and the distance follows from the first ten minutes of wind. From then on
the time follows the mean speed of the last ten minutes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Complexes, Floats
from tree_sway.core.wind.gusts import FarWind, follow_mean, WindHistory

LONGEST_WAY = 15.0
"""Longest time in [s] by which gusts may be later than at the anemometer."""

_AVERAGED = 600.0
"""Time in [s] over which the mean speed is taken."""

_SLOWEST = 1.0
"""Least mean speed in [m/s] with which gusts travel, so that a calm delays nothing for ever."""

_TOLD_LATE = 1.5
"""Time in [s] from which it is told that the wind is known so late."""

_RECALLED, _SETTLED = 5.0, 30.0
"""
Time constant in [s] with which the mean wind is that before a silence again, for twice as long,
and time after which a model leans as the wind has it: without both, its slow gusts are late, as
those of less wind, and a right sensor seemed to be early.
"""

_CAPACITY = 1024
"""Number of past winds that are kept."""


class LateWind:
    """
    The wind of the last seconds, and the one that reaches the tree now.

    Parameters
    ----------
    distance
        Distance of the anemometer upwind of the tree in [m].
    is_told
        Whether whoever steps the tree knows the way of the wind, so that no sensor tells it.
    far
        The wind that is expected at a crown apart from its anemometer; None without.

    """

    def __init__(
        self, distance: float = 0.0, *, is_told: bool = False, far: FarWind | None = None
    ) -> None:
        self.is_told, self._far = is_told, far
        self._history = WindHistory(_CAPACITY, LONGEST_WAY)
        self._mean, self._wanted = np.zeros(3), np.zeros(1)
        self._way = np.array([distance, 0.0])  # distance [m], and 1 while it is not yet known
        self._delay, self._wind = np.zeros(1), np.zeros((1, 3))
        self._measured = np.zeros(3)
        self.known_late = 0.0
        """Time in [s] by which the wind that is pushed is older than what sensors are read for."""
        self.is_silent = False
        """Whether the anemometer has fallen silent, and what is pushed is no wind."""
        self._known_for, self._before = math.inf, np.zeros(0)
        self._heard_for = 0.0

    def push(self, x: float, y: float, z: float, dt: float) -> tuple[float, float, float]:
        """
        Add the mean wind [m/s] of a step of dt [s] at the anemometer; return the tree's.

        Gusts are late by ``way[0] / speed``; while the distance is not yet known (``way[1]``) it
        is that of the delay found, ``delay speed``, at the present mean speed.
        """
        way = self._way
        if not self._note_silence(dt):
            follow_mean(self._mean, math.hypot(x, y), 0.0, dt, _AVERAGED)
        speed = max(float(self._mean[0]), _SLOWEST)
        if way[1] > 0.0:
            way[0] = self._delay[0] * speed
            way[1] = self._mean[2] < _AVERAGED
        self._wanted[0] = way[0] / speed
        self._measured[:] = x, y, z
        self._history.add(self._measured, dt, self._wanted, self._delay, self._wind)
        east, north, up = self._wind[0].tolist()
        return east, north, up

    def _note_silence(self, dt: float) -> bool:
        """
        Return whether the wind of a step is none, and recall its means after a silence.

        At first nobody knows how often an anemometer sends, and a slow one seems silent.
        """
        self._heard_for += 0.0 if self.is_silent else dt
        is_silent = self.is_silent and self._heard_for > _SETTLED
        if self._far is not None:
            if is_silent and self._known_for:
                (before,) = self._far.memory()
                self._before = before.copy()
            elif not is_silent and self._known_for < 2.0 * _RECALLED:
                self._far.recall(self._before, min(dt / _RECALLED, 1.0))
        self._known_for = 0.0 if is_silent else self._known_for + dt
        return is_silent

    @property
    def delay(self) -> float:
        """Time in [s] by which gusts are later than at the anemometer."""
        return float(self._delay[0])

    @property
    def moves_model(self) -> bool:
        """Whether the model sways in the wind of the tree, for sensors to be compared with it."""
        return self._known_for > _SETTLED + self.delay

    @property
    def is_whole(self) -> bool:
        """Whether the anemometer was never silent."""
        return math.isinf(self._known_for)

    @property
    def later(self) -> Callable[[Floats], Complexes] | None:
        """Gusts that crown and anemometer share in the present wind (`FarWind.later`)."""
        return None if self._far is None else partial(self._far.later, mean=self._far.mean)

    def lag_at(self, reach: tuple[float, float]) -> tuple[float, float]:
        """
        How much later than in the crown gusts are at a way from its middle, and its error [s].

        A limb moves by its own gusts and by those of the crown: the lag is half of the way to it.
        """
        speed = max(float(self._mean[0]), _SLOWEST)
        if self._far is None:
            return 0.0, math.hypot(*reach) / speed
        east, north = self._far.mean
        along = (reach[0] * east + reach[1] * north) / max(math.hypot(east, north), _SLOWEST)
        return 0.5 * along / speed, 0.5 * abs(along) / speed

    @property
    def note(self) -> str:
        """What is said of the delay, and of a wind that is known late; empty without both."""
        told = []
        if self.delay:
            told.append(
                f'the tree moves {self.delay:.1f} s after the wind: the anemometer is upwind of '
                'it, or their clocks differ'
            )
        if self.known_late > _TOLD_LATE:
            told.append(f'the wind is known {self.known_late:.1f} s late: sensors tell the rest')
        return '; '.join(told)

    @property
    def distance(self) -> float:
        """Distance of the anemometer upwind in [m]."""
        return float(self._way[0])

    def delay_more(self, time: float) -> None:
        """Let gusts be later by another time in [s], from the next step on."""
        self._delay[0] = min(max(self._delay[0] + time, 0.0), LONGEST_WAY)
        self._way[:] = self._delay[0] * max(self._mean[0], _SLOWEST), 1.0

    def memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the state."""
        return *self._history.memory(), self._mean, self._way, self._delay

    def reset(self) -> None:
        """Forget the wind; where the anemometer stands stays."""
        self._known_for, self._heard_for = math.inf, 0.0
        self._history.reset()
        self._mean[:] = 0.0
        self._delay[:] = 0.0
