# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Faults of anemometers, as a change of their samples, for tests.

Each fault has been observed on sensors in the field: a wet sonic sends a code for no reading, a
driver repeats its last value with new stamps, a logger sends a batch at once, a sensor starts
again.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of, within

_SPIKE = 20.0
_NO_READING = 999.99
_KINDS = (
    'dropout',
    'spike',
    'freeze',
    'nan',
    'no_reading',
    'delay',
    'reorder',
    'duplicate',
    'zero_stamp',
    'future_stamp',
    'restart',
)
FAULTS = ('none', *_KINDS, 'all')
"""Kinds of fault, none, and all in turn."""


class Sample(NamedTuple):
    """A sample: a stamp in [ns], 0 for none, and a vector in [m/s]."""

    stamp: int
    vector: Floats


class SensorFaults:
    """
    Faults that occur periodically.

    Parameters
    ----------
    kind
        One of `FAULTS`; ``none`` for a sensor without a fault, ``all`` for each in turn.
    every
        Time from the beginning of one fault to that of the next in [s].
    duration
        Duration of each in [s], less than `every`.

    Raises
    ------
    ParameterError
        If the kind is unknown or a time is out of its range.

    """

    def __init__(self, kind: str = 'none', every: float = 20.0, duration: float = 1.0) -> None:
        """Check the parameters."""
        one_of('fault', kind, FAULTS)
        self._kind = kind
        self._every = within('every', every, 0.0, 1e6, 's', above=True)
        self._duration = within('duration', duration, 0.0, every, 's', above=True)
        self._delayed: list[Sample] = []
        self._before = 'none'
        self._last = np.zeros(3)

    def at(self, time: float) -> str:
        """Return the fault at a time in [s] since the sensor's start, ``none`` between them."""
        number, since = divmod(time, self._every)
        if self._kind == 'none' or number < 1 or since >= self._duration:
            return 'none'
        return _KINDS[int(number - 1) % len(_KINDS)] if self._kind == 'all' else self._kind

    def sent(self, time: float, stamp: int, vector: Floats) -> Iterator[Sample]:
        """Yield the samples sent for one at a time [s], of a stamp [ns] and wind [m/s]."""
        fault = self.at(time)
        before = self._before
        self._before = fault
        if fault not in ('delay', 'reorder'):
            yield from self._delayed
            self._delayed = []
        if before == 'restart' and fault != 'restart':
            yield Sample(stamp, np.zeros(3))  # the first line after it has started
            return
        match fault:
            case 'dropout' | 'restart':
                return
            case 'delay':
                self._delayed.append(Sample(stamp, vector))
                return
            case 'reorder' if not self._delayed:
                self._delayed.append(Sample(stamp, vector))
                return
            case 'spike':
                vector = vector + np.array([_SPIKE, -_SPIKE, 0.0])
            case 'nan':
                vector = np.full(3, np.nan)
            case 'no_reading':
                vector = np.full(3, _NO_READING)
            case 'freeze' if before == 'freeze':
                vector = self._last
            case 'duplicate':
                yield Sample(stamp, vector)
            case 'zero_stamp':
                stamp = 0
            case 'future_stamp':
                stamp += 3_600_000_000_000
        self._last = vector
        yield Sample(stamp, vector)
        if fault == 'reorder':
            yield self._delayed.pop()
