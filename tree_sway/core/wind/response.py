# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Does a sensor still follow the wind? A bearing that ice or dirt holds passes slow changes alone.

In the inertial subrange the mean square of what the wind changes in a time grows as its power 2/3
(Kolmogorov 1941), and beyond it less: in twice the time it is at most 2^(2/3) = 1.6 times as much.
Behind a low-pass filter the signal is smooth, and it is 2^2 = 4 times as much. Noise and steps of
the resolution bring the ratio down to 1, and so never raise a false alarm.

Over two minutes the ratio was 1.4 to 1.7 of a sonic 7 m above the ground and 0.9 to 1.6 of a vane
and cup at sea; behind a filter of 5 s it was 3.2 to 3.6 of the sonic's record, of one of 0.5 s, as
healthy cups are in light winds, 2.0 to 2.4.
"""

from __future__ import annotations

from itertools import pairwise

_LAG = 1_000_000_000
"""Changes over this time [ns] and twice it are compared; of a slower sensor, over its period."""
_ROUNDING = _LAG // 100
"""So much less than the lag [ns] is as much: stamps jitter."""
_COUNT = 120
"""Changes in one look."""
_SMOOTH = 2.0 ** (4 / 3)
"""Ratio from which on the sensor is sluggish: between the exponents 2/3 and 2."""
_STILL = 0.02
"""Smaller changes than this root mean square [m/s] say nothing: a calm."""

Vector = tuple[float, float, float]


class ResponseWatch:
    """Compares how much good samples change over a second and over two."""

    def __init__(self) -> None:
        self.is_sluggish = False
        self.ratio = 0.0
        """Of the last look; 0 before the first, and in a calm."""
        self._kept: list[tuple[int, Vector]] = []
        self._once = self._twice = 0.0
        self._count = 0

    def add(self, time: int, sample: Vector) -> bool:
        """Take a sample in [m/s], at a time in [ns]; return whether it finds the sensor out."""
        if self._kept and time - self._kept[-1][0] < _LAG - _ROUNDING:
            return False
        self._kept = [*self._kept[-2:], (time, sample)]
        if len(self._kept) < 3:
            return False
        gaps = [after - before for (before, _), (after, _) in pairwise(self._kept)]
        if max(gaps) > 1.5 * min(gaps):  # a dropout: no twice the time
            return False
        first, middle, last = (vector for _, vector in self._kept)
        self._once += _square(middle, last)
        self._twice += _square(first, last)
        self._count += 1
        return self._count == _COUNT and self._look()

    def _look(self) -> bool:
        was_sluggish = self.is_sluggish
        is_still = self._once < _COUNT * _STILL**2
        self.ratio = 0.0 if is_still else self._twice / self._once
        self.is_sluggish = self.ratio > _SMOOTH or (is_still and was_sluggish)
        self._once = self._twice = 0.0
        self._count = 0
        return self.is_sluggish and not was_sluggish


def _square(a: Vector, b: Vector) -> float:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2
