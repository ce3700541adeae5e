# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A gust, step or turn as data: what happens to the wind, when, and how often."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway_ros.core.checks import within
from tree_sway_ros.core.wind.simulated import gust_shapes as gusts
from tree_sway_ros.errors import ParameterError

Floats = NDArray[np.float64]

_SPEEDS: dict[str, Callable[[ArrayLike, float, float], Floats]] = {
    "one_minus_cos": gusts.one_minus_cos,
    "extreme_operating_gust": gusts.extreme_operating_gust,
    "step": gusts.step,
}
_ANGLES: dict[str, Callable[[ArrayLike, float, float], Floats]] = {
    "direction_change": gusts.direction_change,
    "turn": gusts.turn,
}
_LASTING = ("step", "direction_change", "turn")

EVENT_KINDS = (*_SPEEDS, *_ANGLES)


@dataclass(frozen=True)
class GustEvent:
    """
    One event of the wind.

    Parameters
    ----------
    kind
        ``one_minus_cos``, ``extreme_operating_gust``, ``step`` (speeds), ``direction_change`` or
        ``turn`` (angles), as in `tree_sway_ros.core.gusts`.
    amplitude
        Speed in [m/s] or angle in [rad].
    duration
        Duration in [s]; for a step the time of its rise, which may be 0.
    start
        Time it begins in [s].
    every
        Time after which it happens again in [s], at least `duration`; 0 for once. What lasts (step,
        direction change, turn) goes back every second time.

    Raises
    ------
    ParameterError
        If the kind is unknown or a value is out of its range.

    """

    kind: str
    amplitude: float
    duration: float
    start: float = 0.0
    every: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what the shape itself refuses, and repeats that overlap."""
        shape = self._shape
        if self.every != 0.0:
            within("every", self.every, self.duration, 1e6, "s", above=self.duration == 0.0)
        within("start", self.start, -1e6, 1e6, "s")
        shape(0.0, self.amplitude, self.duration)

    @property
    def _shape(self) -> Callable[[ArrayLike, float, float], Floats]:
        shape = _SPEEDS.get(self.kind) or _ANGLES.get(self.kind)
        if shape is None:
            raise ParameterError(
                f"unknown event '{self.kind}'",
                where="gust event",
                cure=f"use one of: {', '.join(EVENT_KINDS)}",
            )
        return shape

    @property
    def is_turn(self) -> bool:
        """Whether it turns the wind, rather than adds to its speed."""
        return self.kind in _ANGLES

    def at(self, time: ArrayLike) -> Floats:
        """Return the speed to add in [m/s], or the angle to turn by in [rad], at times in [s]."""
        elapsed = np.asarray(time, dtype=np.float64) - self.start
        if self.every == 0.0:
            return self._shape(elapsed, self.amplitude, self.duration)
        cycle = np.maximum(np.floor(elapsed / self.every), 0.0)
        value = self._shape(elapsed - cycle * self.every, self.amplitude, self.duration)
        if self.kind in _LASTING:
            value = np.where(cycle % 2 == 1, self.amplitude - value, value)
        return value


def with_events(
    time: ArrayLike, base: ArrayLike, events: Iterable[GustEvent], bearing_to: float
) -> Floats:
    """
    Add events to a wind: the speeds along the mean wind, then the turns of the whole.

    Parameters
    ----------
    time
        Times in [s], (n,) or a scalar.
    base
        Wind without events, blowing to, ENU in [m/s], (n, 3) or (3,).
    events
        The events; speeds add up and angles add up.
    bearing_to
        Where the mean wind blows to, clockwise from north in [rad].

    Returns
    -------
    Floats
        Wind with events, the shape of `base`.

    """
    wind = np.array(base, dtype=np.float64)
    angle = np.zeros(wind.shape[:-1])
    for event in events:
        if event.is_turn:
            angle = angle + event.at(time)
        else:
            speed = event.at(time)
            wind[..., 0] += speed * np.sin(bearing_to)
            wind[..., 1] += speed * np.cos(bearing_to)
    east, north = wind[..., 0].copy(), wind[..., 1].copy()
    wind[..., 0] = np.cos(angle) * east - np.sin(angle) * north
    wind[..., 1] = np.sin(angle) * east + np.cos(angle) * north
    return wind
