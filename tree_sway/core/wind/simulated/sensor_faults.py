# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What anemometers do when they fail, as a change of what they send: for rehearsals.

Each fault is one that was seen on sensors in the field: a wet sonic sends a code for no reading, a
driver repeats its last value with new stamps, a logger sends a batch at once, a sensor starts
again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.checks import within
from tree_sway.errors import ParameterError

Floats = NDArray[np.float64]
_SPIKE = 20.0
_NO_READING = 999.99


class Sample(NamedTuple):
    """What is sent: a stamp in [ns], 0 for none, and a vector in [m/s]."""

    stamp: int
    vector: Floats


class SensorFaults:
    """
    Faults that come again and again.

    Parameters
    ----------
    kind
        One of `FAULTS`; ``none`` for a sensor without a fault, ``all`` for each in its turn.
    every
        Time from the beginning of one fault to that of the next in [s].
    duration
        Time that each lasts in [s], less than `every`.

    Raises
    ------
    ParameterError
        If the kind is unknown or a time is out of its range.

    """

    def __init__(self, kind: str = 'none', every: float = 20.0, duration: float = 1.0) -> None:
        """Check the parameters."""
        if kind not in FAULTS:
            raise ParameterError(
                f"unknown fault '{kind}'", where='fault', cure=f'use one of: {", ".join(FAULTS)}'
            )
        self._kind = kind
        self._every = within('every', every, 0.0, 1e6, 's', above=True)
        self._duration = within('duration', duration, 0.0, every, 's', above=True)
        self._held: list[Sample] = []
        self._frozen: Floats | None = None
        self._is_restarting = False

    def at(self, time: float) -> str:
        """Return the fault at a time in [s] since the sensor's start, ``none`` between them."""
        number, since = divmod(time, self._every)
        if self._kind == 'none' or number < 1 or since >= self._duration:
            return 'none'
        return _KINDS[int(number - 1) % len(_KINDS)] if self._kind == 'all' else self._kind

    def sent(self, time: float, stamp: int, vector: Floats) -> Iterator[Sample]:
        """Return what is sent for a sample at a time [s], of a stamp [ns] and wind [m/s]."""
        fault = self.at(time)
        if fault != 'freeze':
            self._frozen = None
        if fault not in _HOLDING:
            yield from self._held
            self._held = []
        if self._is_restarting and fault != 'restart':
            yield Sample(stamp, np.zeros(3))  # the first line after it has started
            self._is_restarting = False
            return
        self._is_restarting = fault == 'restart'
        yield from _SENDS.get(fault, _as_it_is)(self, Sample(stamp, vector))

    def _hold(self, sample: Sample) -> Iterator[Sample]:
        self._held.append(sample)
        yield from ()

    def _swap(self, sample: Sample) -> Iterator[Sample]:
        if self._held:
            yield sample
            yield self._held.pop()
        else:
            self._held.append(sample)

    def _freeze(self, sample: Sample) -> Iterator[Sample]:
        if self._frozen is None:
            self._frozen = sample.vector
        yield Sample(sample.stamp, self._frozen)


def _as_it_is(_faults: SensorFaults, sample: Sample) -> Iterator[Sample]:
    yield sample


def _nothing(_faults: SensorFaults, _sample: Sample) -> Iterator[Sample]:
    yield from ()


def _spike(_faults: SensorFaults, sample: Sample) -> Iterator[Sample]:
    yield Sample(sample.stamp, sample.vector + np.array([_SPIKE, -_SPIKE, 0.0]))


def _reading(value: float) -> Callable[[SensorFaults, Sample], Iterator[Sample]]:
    def send(_faults: SensorFaults, sample: Sample) -> Iterator[Sample]:
        yield Sample(sample.stamp, np.full(3, value))

    return send


def _twice(_faults: SensorFaults, sample: Sample) -> Iterator[Sample]:
    yield sample
    yield sample


def _unstamped(_faults: SensorFaults, sample: Sample) -> Iterator[Sample]:
    yield Sample(0, sample.vector)


def _from_the_future(_faults: SensorFaults, sample: Sample) -> Iterator[Sample]:
    yield Sample(sample.stamp + 3_600_000_000_000, sample.vector)


_SENDS: dict[str, Callable[[SensorFaults, Sample], Iterator[Sample]]] = {
    'dropout': _nothing,
    'spike': _spike,
    'freeze': SensorFaults._freeze,
    'nan': _reading(float('nan')),
    'no_reading': _reading(_NO_READING),
    'delay': SensorFaults._hold,
    'reorder': SensorFaults._swap,
    'duplicate': _twice,
    'zero_stamp': _unstamped,
    'future_stamp': _from_the_future,
    'restart': _nothing,
}
_HOLDING = ('delay', 'reorder')
_KINDS = tuple(_SENDS)
FAULTS = ('none', *_KINDS, 'all')
