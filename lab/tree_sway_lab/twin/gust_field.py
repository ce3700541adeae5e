# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A field of gusts: turbulence at many places at once, as it is in the open.

Each place has Kaimal's spectrum ``4 s^2 T / (1 + 6 f T)^(5/3)``, T = L / U. Two places share gusts
of a frequency f by the root coherence ``exp(-f t)`` of Davenport (1961, Quarterly Journal of the
Royal Meteorological Society 87, 194-211), ``t = sqrt((3 x)^2 + (10 y)^2 + (10 z)^2) / U``, x along
the wind; and what they share reaches the one downwind ``x / U`` later (Taylor 1938). A record is
drawn line by line of the spectrum, by the root of the matrix of cross spectra (Shinozuka &
Deodatis 1991, Applied Mechanics Reviews 44, 191-204).

The model knows that law. `OtherField` has another one: von Karman's spectra ``4 s^2 T / (1 + 70.8
(f T)^2)^(5/6)`` (ESDU 85020), other decays, and less wind near the ground.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.rotation import about_up
from tree_sway.core.wind import SCALE_RATIOS

_DECAYS, _OTHER_DECAYS = (3.0, 10.0, 10.0), (5.0, 14.0, 9.0)
"""Davenport's C along the wind, across it and up [-]."""

_SHEAR = 0.2
"""Exponent of the profile of the mean wind over the height of the first place [-]."""

_DEVIATIONS = np.array([1.0, 0.8, 0.5])
"""Deviations of u, v, w over that of u [-] (IEC 61400-1)."""

_PERIOD, _FASTEST = 600.0, 10.0
_BLOCK = 250


@dataclass(frozen=True)
class GustField:
    """
    Turbulence about a mean wind.

    Parameters
    ----------
    places
        Places in [m], (p, 3).
    speed
        Mean wind in [m/s].
    intensity
        Deviation of u over the mean wind [-].
    length
        Integral length L of u in [m]; those of v and w are shorter as in IEC 61400-1.
    heading
        Direction that the wind goes to, from x to y [rad].

    """

    decays: ClassVar[tuple[float, float, float]] = _DECAYS

    places: Floats
    speed: float = 7.0
    intensity: float = 0.3
    length: float = 60.0
    heading: float = 0.0

    @property
    def along(self) -> Floats:
        """Places along the wind, across it and up in [m], (p, 3)."""
        return self.places @ about_up(self.heading)

    def apart(self) -> Floats:
        """Time t of every pair of places, whose root coherence is ``exp(-f t)``, [s], (p, p)."""
        scaled = self.along * self.decays / self.speed
        return np.asarray(np.linalg.norm(scaled[:, None] - scaled, axis=2))

    def mean(self) -> Floats:
        """Mean wind of every place along it in [m/s], (p,)."""
        return np.full(len(self.places), self.speed)

    def spectrum(self, frequency: Floats) -> Floats:
        """One-sided spectra of u, v, w in [m^2/s^2/Hz] at frequencies [Hz], (f, 3)."""
        time = self.length * SCALE_RATIOS / SCALE_RATIOS[0] / self.speed
        variance = np.square(self.intensity * self.speed * _DEVIATIONS)
        falling = (1.0 + 6.0 * frequency[:, None] * time) ** (5.0 / 3.0)
        return np.asarray(variance * 4.0 * time / falling)

    def coherence(self, frequency: Floats) -> Floats:
        """Root coherence of every pair of places, without travel, (f, p, p)."""
        return np.asarray(np.exp(-frequency[:, None, None] * self.apart()))

    def travel(self, frequency: Floats) -> Floats:
        """Factors of each place's lateness, complex (f, p)."""
        late = self.along[:, 0] / self.speed
        return np.asarray(np.exp(-2j * np.pi * frequency[:, None] * late))

    def record(self, seconds: float, rate: float, rng: np.random.Generator) -> Floats:
        """Draw the wind of every place at a rate [Hz], in [m/s], (n, p, 3)."""
        period = max(_PERIOD, seconds)
        n = round(period * rate)
        frequency = np.arange(1, int(min(_FASTEST, 0.49 * rate) * period)) / period
        count = len(self.places)
        amplitude = np.sqrt(0.5 * self.spectrum(frequency) / period)
        # What is beyond the fastest line is not lost.
        variance = 2.0 * np.square(amplitude).sum(axis=0)
        amplitude *= self.intensity * self.speed * _DEVIATIONS / np.sqrt(variance)
        phases = np.exp(2j * np.pi * rng.random((3, len(frequency), count)))
        lines = np.zeros((3, n // 2 + 1, count), dtype=np.complex128)
        for first in range(0, len(frequency), _BLOCK):
            rows = slice(first, first + _BLOCK)
            root = np.linalg.cholesky(self.coherence(frequency[rows]) + 1e-9 * np.eye(count))
            travel = self.travel(frequency[rows])
            for axis, phase in enumerate(phases):
                mixed = travel * np.einsum('fij,fj->fi', root, phase[rows])
                to = slice(first + 1, first + 1 + len(mixed))
                lines[axis, to] = n * amplitude[rows, axis, None] * mixed
        found = np.empty((round(seconds * rate), count, 3))
        for axis, each in enumerate(lines):
            found[..., axis] = np.fft.irfft(each, n, axis=0)[: len(found)]
        found[..., 0] += self.mean()
        return np.asarray(found @ about_up(self.heading).T)


@dataclass(frozen=True)
class OtherField(GustField):
    """Turbulence by a law that the model does not assume."""

    decays: ClassVar[tuple[float, float, float]] = _OTHER_DECAYS

    def mean(self) -> Floats:
        """Mean wind of every place along it in [m/s], (p,)."""
        height = np.maximum(self.places[:, 2], 0.3)
        return np.asarray(self.speed * (height / height[0]) ** _SHEAR)

    def spectrum(self, frequency: Floats) -> Floats:
        """One-sided spectra of u, v, w in [m^2/s^2/Hz] at frequencies [Hz], (f, 3)."""
        time = self.length * SCALE_RATIOS / SCALE_RATIOS[0] / self.speed
        variance = np.square(self.intensity * self.speed * _DEVIATIONS)
        falling = (1.0 + 70.8 * np.square(frequency[:, None] * time)) ** (5.0 / 6.0)
        return np.asarray(variance * 4.0 * time / falling)


def spread_points(places: Floats, weight: Floats, count: int) -> Floats:
    """Choose at most a number of points (p, 3) that represent weighted places (n, 3)."""
    points = places[np.unique(np.linspace(0, len(places) - 1, count).astype(np.intp))]
    for _ in range(20):
        nearest = nearest_of(places, points)
        total = np.bincount(nearest, weight, len(points))
        moved = [np.bincount(nearest, weight * axis, len(points)) for axis in places.T]
        is_used = total > 0.0
        points = np.stack(moved, axis=1)[is_used] / total[is_used, None]
    return points


def nearest_of(places: Floats, points: Floats) -> Ints:
    """Return the number of the point nearest to each place, (n,)."""
    return np.asarray(np.linalg.norm(places[:, None] - points, axis=2).argmin(axis=1))
