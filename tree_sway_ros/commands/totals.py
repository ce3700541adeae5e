# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a whole stream was like, in memory that does not grow with its length."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats

_PER_DECADE = 200
_SHORTEST, _DECADES = 1e-6, 9
_NOTHING = np.zeros(3)


class Spread:
    """
    Quantiles of times, to 0.6 %: counts of times that are alike, from 1 us to 1000 s.

    Shorter times count as the shortest, longer ones as the longest; the largest is kept as it is.
    """

    def __init__(self) -> None:
        self._counts = np.zeros(_PER_DECADE * _DECADES, dtype=np.int64)
        self.largest = -math.inf

    def add(self, time: float) -> None:
        """Count a time in [s]."""
        place = _PER_DECADE * math.log10(max(time, _SHORTEST) / _SHORTEST)
        self._counts[min(int(place), len(self._counts) - 1)] += 1
        self.largest = max(self.largest, time)

    def quantile(self, share: float) -> float:
        """Time in [s] that a share of all stay below; the largest for 1, NaN without any."""
        counted = int(self._counts.sum())
        if not counted:
            return math.nan
        if share >= 1.0:
            return self.largest
        place = int(np.searchsorted(np.cumsum(self._counts), share * counted, side='right'))
        middle = _SHORTEST * 10.0 ** ((place + 0.5) / _PER_DECADE)
        return min(float(middle), self.largest)


class Means:
    """Mean vector, mean length and largest length of vectors, and how many there were."""

    def __init__(self) -> None:
        self.count = 0
        self.largest = 0.0
        self._vectors = _NOTHING.copy()
        self._lengths = 0.0

    def add(self, vector: Floats) -> None:
        """Count a vector, (3,)."""
        length = float(np.linalg.norm(vector))
        self.count += 1
        self.largest = max(self.largest, length)
        self._vectors += vector
        self._lengths += length

    @property
    def vector(self) -> Floats:
        """Mean vector, (3,); zero if there was none."""
        return self._vectors / max(1, self.count)

    @property
    def length(self) -> float:
        """Mean length; zero if there was none."""
        return self._lengths / max(1, self.count)


class Times:
    """How many events, and the first and the last of their times in [s]."""

    def __init__(self) -> None:
        self.count = 0
        self.first = self.last = math.nan

    def add(self, time: float) -> None:
        """Count an event."""
        self.first = self.first if self.count else time
        self.last = time
        self.count += 1

    @property
    def rate(self) -> float:
        """Mean rate in [Hz]; 0 if there are fewer than two."""
        return (self.count - 1) / (self.last - self.first) if self.last > self.first else 0.0


class StreamTotals:
    """Everything that `summary` reports of a stream, from its messages one by one."""

    def __init__(self) -> None:
        self.arrivals, self.stamps, self.wind_stamps = Times(), Times(), Times()
        self.latency = Spread()
        self.tip, self.wind = Means(), Means()

    def add_poses(self, arrival: float, stamp: float, tip: Floats | None = None) -> None:
        """Count a pose array: its arrival, time shown [s], and the highest tip's motion [m]."""
        self.arrivals.add(arrival)
        self.stamps.add(stamp)
        self.latency.add(arrival - stamp)
        if tip is not None:
            self.tip.add(tip)

    def add_wind(self, stamp: float, vector: Floats) -> None:
        """Count a wind sample, measured at a time in [s], in [m/s], (3,)."""
        self.wind_stamps.add(stamp)
        self.wind.add(vector)

    def missing(self, rate: float) -> int:
        """Frames of a rate's grid [Hz], between the first and the last, that never came."""
        if self.stamps.count < 2:
            return 0
        return round((self.stamps.last - self.stamps.first) * rate) + 1 - self.stamps.count
