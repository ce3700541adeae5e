# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a whole stream, in memory that does not grow with its length."""

from __future__ import annotations

from collections import deque
import math

import numpy as np

from tree_sway.core.arrays import Floats

_LATEST = 36_000
"""Number of latencies stored: those of ten minutes at 60 Hz."""


class _Series:
    """Statistics of vectors at times: number, first and last time [s], mean and largest length."""

    def __init__(self) -> None:
        self.count = 0
        self.first = self.last = math.nan
        self.largest = 0.0
        self._vectors = np.zeros(3)
        self._lengths = 0.0

    def add(self, time: float, vector: Floats) -> None:
        """Count a vector, (3,), at a time in [s]."""
        length = float(np.linalg.norm(vector))
        self.first = self.first if self.count else time
        self.last = time
        self.count += 1
        self.largest = max(self.largest, length)
        self._vectors += vector
        self._lengths += length

    @property
    def rate(self) -> float:
        """Mean rate in [Hz]; 0 if there are fewer than two."""
        return (self.count - 1) / (self.last - self.first) if self.last > self.first else 0.0

    @property
    def mean(self) -> Floats:
        """Mean vector, (3,); zero if there was none."""
        return self._vectors / max(1, self.count)

    @property
    def length(self) -> float:
        """Mean length; zero if there was none."""
        return self._lengths / max(1, self.count)


class StreamTotals:
    """Statistics of a stream for `summary`, from its messages one by one."""

    def __init__(self) -> None:
        self.poses = _Series()
        self.wind = _Series()
        self.foreign = 0
        """Number of pose arrays that are not of this tree, which are not counted as poses."""
        self.latencies: deque[float] = deque(maxlen=_LATEST)

    def add_poses(self, arrival: float, stamp: float, tip: Floats) -> None:
        """Count a pose array: its arrival, time shown [s], and the highest tip's motion [m]."""
        self.poses.add(stamp, tip)
        self.latencies.append(arrival - stamp)

    def latency(self, *shares: float) -> list[float]:
        """Percentiles of the latency of the latest poses in [s]; NaN without any."""
        if not self.latencies:
            return [math.nan] * len(shares)
        return [float(each) for each in np.quantile(self.latencies, shares)]

    def missing(self, rate: float) -> int:
        """Return the number of missing frames of a rate [Hz], between the first and the last."""
        if self.poses.count < 2:
            return 0
        return round((self.poses.last - self.poses.first) * rate) + 1 - self.poses.count
