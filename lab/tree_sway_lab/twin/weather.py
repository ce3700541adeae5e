# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Hours of weather: a wind that turns, comes and goes, rain on the leaves, and a battery that fades.

A field of gusts is stationary. Here one of ten minutes follows another, each for the mean wind of
its middle, and where two meet the roots of their shares add to one: so their variances do too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway_lab.twin.gust_field import GustField

_STRETCH, _FADE = 600.0, 60.0
_LEAST = 0.5
"""Least mean wind of a field of gusts in [m/s]."""

_SPEEDS = 1.0, 1.2, 0.7, 0.3, 0.1, 0.5, 1.3, 1.0, 0.6, 0.1, 0.7, 1.2, 0.9
"""Mean wind over the usual one, at equal times."""

_TURNS = 0.0, 0.1, 0.4, 0.4, 0.6, 1.0, 0.9, 0.6, 0.6, 0.2, -0.2, -0.1, 0.0
"""Bearing over the largest turn, at equal times."""

_RAIN, _WET, _DRY = (0.30, 0.35), 0.50, 0.07
"""When leaves get wet, from when on they dry, and how fast, in shares of the record."""

_BATTERY = ((0.42, 60.0), (0.44, 25.0), (0.46, 10.0), (0.48, 0.0), (0.52, 60.0), (0.75, 25.0),
            (0.77, 0.0), (0.79, 60.0))  # fmt: skip
"""From when on a sensor has a rate [Hz], as a share of the record."""


@dataclass(frozen=True)
class Weather:
    """
    What the hours bring.

    Parameters
    ----------
    seconds
        Length of the record in [s].
    speed, intensity
        Usual mean wind in [m/s], and deviation of u over the mean wind [-].
    turn
        Angle by which the wind turns at most, from blowing to east towards north, in [rad].
    rain
        Mass of the water on the leaves over that of the leaves, at most [-].

    """

    seconds: float
    speed: float = 6.0
    intensity: float = 0.3
    turn: float = np.deg2rad(120.0)
    rain: float = 0.3

    def speed_at(self, time: float) -> float:
        """Return the mean wind in [m/s]."""
        return self.speed * self._between(time, _SPEEDS)

    def turn_at(self, time: float) -> float:
        """Return the angle by which the wind has turned in [rad]."""
        return float(self.turn * self._between(time, _TURNS))

    def water_at(self, time: float) -> float:
        """Return the mass of the water on the leaves over that of the leaves [-]."""
        share = time / self.seconds
        if share < _WET:
            return self.rain * float(np.interp(share, _RAIN, (0.0, 1.0)))
        return self.rain * float(np.exp(-(share - _WET) / _DRY))

    def rate_at(self, time: float) -> float:
        """Return the samples per second of a sensor on a battery in [Hz]; 0 while it is empty."""
        share = time / self.seconds
        return [60.0, *(rate for begin, rate in _BATTERY if share >= begin)][-1]

    def _between(self, time: float, values: tuple[float, ...]) -> float:
        at = np.linspace(0.0, self.seconds, len(values))
        return float(np.interp(time, at, values))

    def gusts(self, places: Floats, rate: float, rng: np.random.Generator) -> Iterator[Floats]:
        """Yield the wind at places (p, 3) at each step of a rate [Hz], in [m/s], (p, 3)."""
        n, n_fade = round(_STRETCH * rate), round(_FADE * rate)
        left = round(self.seconds * rate)
        tail = np.zeros((0, *places.shape))
        share = np.sqrt((np.arange(n_fade) + 0.5) / n_fade)[:, None, None]
        begin = 0.0
        while left > 0:
            found = self._stretch(places, rate, begin, rng)
            if len(tail):
                found[:n_fade] = share * found[:n_fade] + share[::-1] * tail
            tail = found[n:].copy()
            for k in range(min(n, left)):
                time = begin + k / rate
                speed, turn = self.speed_at(time), self.turn_at(time)
                wind = speed * found[k]
                wind[:, 0] += speed * np.cos(turn)
                wind[:, 1] += speed * np.sin(turn)
                yield wind
            left, begin = left - n, begin + _STRETCH

    def _stretch(
        self, places: Floats, rate: float, begin: float, rng: np.random.Generator
    ) -> Floats:
        """Draw the gusts of a stretch and of the fade behind it, over the mean wind, (n, p, 3)."""
        middle = min(begin + 0.5 * _STRETCH, self.seconds)
        speed, turn = max(self.speed_at(middle), _LEAST), self.turn_at(middle)
        east, north = np.cos(turn), np.sin(turn)
        along = np.array([[east, north, 0.0], [-north, east, 0.0], [0.0, 0.0, 1.0]])
        field = GustField(places @ along.T, speed, self.intensity)
        found = field.record(_STRETCH + _FADE, rate, rng)
        found[..., 0] -= speed
        return np.asarray(found @ (along / speed))
