# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The last samples of a motion sensor: checked as they are kept, and read at any time.

A sample is (9,): acceleration, angular rate and rotation, not a number where not measured.

What a sensor measures is decided by a majority vote (Boyer and Moore 1991, Automated Reasoning,
105-117), so that neither a bad first sample nor a part that stops makes the others useless.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.native import address, LIBRARY
from tree_sway.twin.alignment import LEAST_NOISE

_OUTCOMES = (
    'accepted', 'restarted', 'not_finite', 'too_large', 'saturated', 'out_of_order', 'stuck',
    'spikes', 'others',
)  # fmt: skip
"""
Results of `SampleRing.keep`; the sample was kept with the first two.

With the last one, most samples are of other quantities from this one on (`SampleRing.ask_for`).
"""

CAPACITY = 4096
"""Samples that are kept."""

_NEWEST = 1024
"""Newest samples."""

_RING = np.dtype(
    [
        ('time', 'f8', (CAPACITY,)),
        ('values', 'f8', (CAPACITY, 9)),
        ('first', 'i8'),
        ('count', 'i8'),
        ('behind', 'i8'),
        ('newest', 'f8'),
        ('same', 'i8', (6,)),
        ('before', 'f8', (6,)),
        ('given', 'i8'),
        ('lead', 'i8'),
        ('still', 'i8'),
        ('spikes', 'i8'),
        ('is_followed', 'i8'),
        ('moved_at', 'f8'),
        ('offered', 'f8', (9,)),
        ('last', 'f8', (9,)),
        ('changes', 'f8', (3,)),
        ('noise', 'f8', (3,)),
    ]
)
"""``sway_ring`` of the native core."""


class SampleRing:
    """
    The last samples.

    Parameters
    ----------
    sample
        The sample that is kept next, (9,).

    """

    def __init__(self, sample: Floats) -> None:
        self.memory: NDArray[Any] = np.zeros(1, dtype=_RING)
        """Its memory, ``sway_ring`` of the native core."""
        self._newest, self._times = self.memory['newest'], self.memory['time'][0]
        self._first, self._count = self.memory['first'], self.memory['count']
        self._newest[0], self._times[:] = -math.inf, math.nan
        self.memory['before'] = self.memory['offered'] = math.nan
        self.memory['noise'] = LEAST_NOISE
        self.memory['given'] = -1
        self._kept, self._found = sample, np.zeros(9)
        arrays = self.memory, sample, self._found
        self._at, self._next_at, self._found_at = map(address, arrays)

    def keep(self, time: float) -> str:
        """Check the next sample, of a time in [s], and keep it; return what became of it."""
        return _OUTCOMES[LIBRARY.sway_keep_sample(self._at, time, self._next_at)]

    def read(self, time: float, dt: float) -> Floats | None:
        """
        Read the motion about a time, both in [s], and forget older samples.

        Samples within a step of dt about the time are averaged; elsewhere the samples before and
        after are joined by a line. None where no sample is near. The array is reused.
        """
        found = LIBRARY.sway_read_samples(self._at, time, dt, self._found_at)
        return self._found if found else None

    def newest_samples(self) -> Floats:
        """Copy the samples that came last, also those that were read, the oldest first, (n, 9)."""
        end = self._first[0] + self._count[0]
        rows = np.arange(end - _NEWEST, end) % CAPACITY
        rows = rows[np.isfinite(self._times[rows])]
        # Times rise, but where the clock was set back.
        falls = np.flatnonzero(np.diff(self._times[rows]) <= 0.0)
        return np.array(self.memory['values'][0, rows[falls[-1] + 1 :] if len(falls) else rows])

    def ask_for(self, is_given: Sequence[bool]) -> None:
        """Forget all samples, and ask for some of the three quantities; the clock stays."""
        self._times[:] = math.nan
        LIBRARY.sway_ask_for(self._at, sum(asked << k for k, asked in enumerate(is_given)))

    @property
    def newest(self) -> float:
        """Time of the newest sample in [s]; minus infinity before any."""
        return float(self._newest[0])

    @property
    def period(self) -> float:
        """Time between samples in [s], the median of the last; not a number before two samples."""
        return float(LIBRARY.sway_sample_period(self._at))
