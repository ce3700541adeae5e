# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind of the last seconds, from which places take a past wind (``native/gusts.h``).

It is stored as its run, the displacement of the air from the start to the end of a step: the mean
over any span is then the difference of two runs over the span.
"""

from __future__ import annotations

import ctypes
from functools import partial

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.native import address, LIBRARY


class WindHistory:
    """
    A ring of runs of the wind.

    Parameters
    ----------
    capacity
        Number of ends of steps that are stored.
    longest
        Longest delay in [s]. Steps are joined where two are shorter than a part of it, so that the
        history is longer than the longest delay at any rate.

    """

    def __init__(self, capacity: int, longest: float) -> None:
        self._memory = np.zeros(2 + 4 * capacity)
        self._at = self._memory[:2]
        self._run = self._memory[2:].reshape(capacity, 4)
        self._longest = longest
        # Two consecutive steps are together longer than this, so that all are longer than the
        # longest delay and the steps at its ends.
        self._finest = 2.0 * longest / (capacity - 4)
        self._memory_at = address(self._memory)
        self._given: tuple[Floats, ...] = (self._memory,) * 4
        self._dt = ctypes.c_double()

    def add(self, wind: Floats, dt: float, wanted: Floats, delay: Floats, out: Floats) -> None:
        """
        Add a step of dt [s] in a mean wind (3,) [m/s].

        Delays (t,) [s] move towards those wanted, (t,); the past wind of each is written, (t, 3).
        """
        last = self._given
        if not (wind is last[0] and wanted is last[1] and delay is last[2] and out is last[3]):
            self._take(wind, wanted, delay, out)
        self._dt.value = dt
        self._add()

    def _take(self, *given: Floats) -> None:
        """Make the arguments of `add`, which takes longer than the call."""
        wind_at, wanted_at, delay_at, out_at = (ctypes.c_void_p(address(each)) for each in given)
        memory_at, size = ctypes.c_void_p(self._memory_at), ctypes.c_size_t(len(self._run))
        finest, longest = ctypes.c_double(self._finest), ctypes.c_double(self._longest)
        delays = wanted_at, delay_at, ctypes.c_size_t(len(given[2])), longest
        past = memory_at, size, finest, *delays, wind_at, self._dt, out_at
        self._add = partial(LIBRARY.sway_past_winds, *past)
        self._given = given

    @property
    def count(self) -> int:
        """Number of ends of steps that are stored."""
        return int(self._at[1])

    @property
    def time(self) -> float:
        """Time of the history at the end of the last step in [s]."""
        last = int(self._at[0]) % len(self._run)
        return float(self._run[last, 0])

    def rows(self) -> Floats:
        """Return a copy of time [s] and run [m] at the ends of steps, the oldest first, (r, 4)."""
        last, count = self._at.astype(np.int64).tolist()
        count = min(max(count, 1), len(self._run))  # whatever a state has
        rows = np.arange(last - count + 1, last + 1) % len(self._run)
        return np.asarray(self._run[rows])

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return (self._memory,)

    def reset(self) -> None:
        """Forget the wind."""
        self._at[:] = 0.0


def follow_mean(mean: Floats, x: float, y: float, dt: float, averaging: float) -> None:
    """Update a plain mean of the first wind, then a running one; its span is the last element."""
    mean[2] = min(mean[2] + dt, max(averaging, dt))
    weight = dt / mean[2]
    mean[0] += weight * (x - mean[0])
    mean[1] += weight * (y - mean[1])
