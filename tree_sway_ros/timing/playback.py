# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A thread that plays a wind record: each sample when it is due, at any rate, once or repeated.

Time is continuous over the end of a loop: the first sample of the next round follows the last one
after a period, so stamps and /clock never go back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
import heapq
import itertools
import math
import time

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.worker import Worker

LONGEST_CLOCK_STEP = 0.25
"""Longest time between two ticks of /clock [s]; half of the threshold of nodes for a jump."""

_CLOCK_RATE = 250.0
"""Ticks of /clock per second of the machine [Hz]."""

_LAST_TIME = 2.0**31
"""The first date after 1970 that a stamp cannot represent [s]."""

_MARGIN = 86_400.0
"""Pause between two loops of a record [s]."""

_SECOND = 1_000_000_000
_LATEST = 0.5
_POLL = 0.02

_SETTLING = 1.0
"""Time [s] from the last subscriber to the first sample, in which those of the poses are found."""

_LONGEST_WAIT = 120.0
"""Longest time [s] from the first subscriber to all: a solver may have to compile."""


def is_ros_time(epoch: float | None, time: Floats) -> bool:
    """Whether the times [s] of a record, after an epoch if any, can be played as dates."""
    if epoch is None or not len(time):
        return True
    return bool(epoch + time[0] >= 1.0 and epoch + time[-1] < _LAST_TIME - _MARGIN)


@dataclass(eq=False)
class Playback(Worker):
    """
    Playback of a record once there is a subscriber, without bursts after a sleep.

    Parameters
    ----------
    times
        Times of the samples in [s], increasing, (n,).
    publish
        Function called with the row of a sample, -1 for a tick of /clock, and its stamp in [ns]:
        the record's own time with a clock, else the wall time at which the sample is due.
    may_start
        Function that returns whether there is a subscriber; called until true.
    lacking
        Function that returns who else has yet to subscribe, empty if nobody; waited for a while.
    say
        Function called with what is waited for, and with what is not waited for any longer.
    on_end, on_error
        Functions called at the end of the record, and with an exception of `publish`.
    rate
        Playback rate: 2 takes half the time.
    epoch
        Date of the record's time 0 in [s] after 1970, None if it has none.
    start_at
        Skipped time of the record in [s].
    loop
        True to start again at its end.
    has_clock
        True for ticks of /clock.

    Raises
    ------
    FormatError
        If the whole record is skipped.

    """

    times: Floats
    publish: Callable[[int, int], None]
    may_start: Callable[[], bool]
    on_end: Callable[[], None]
    on_error: Callable[[Exception], None]
    lacking: Callable[[], str] = lambda: ''
    say: Callable[[str], None] = lambda _text: None
    rate: float = 1.0
    epoch: float | None = None
    start_at: float = 0.0
    loop: bool = False
    has_clock: bool = False

    def __post_init__(self) -> None:
        """Remove the skipped part, and prepare the thread."""
        super().__init__('playback')
        first = int(np.searchsorted(self.times - self.times[:1], self.start_at))
        if first >= len(self.times):
            raise FormatError(
                f'no sample {self.start_at:g} s into the record', cure='give a smaller start'
            )
        self._first_row, self._since = first, self.times[first:] - self.times[first]
        steps = np.diff(self._since)
        self.round = float(self._since[-1] + (np.median(steps) if len(steps) else 1.0))
        self.waits_for = ''
        """What the record waits for before it begins; empty once it plays."""
        self._position = 0.0
        self._samples = self._stalls = 0

    @property
    def begin(self) -> int:
        """Time of the first sample in [ns], for /clock: the record's, or 1 s without a date."""
        if self.epoch is None:
            return _SECOND
        return round((self.epoch + float(self.times[self._first_row])) * _SECOND)

    def progress(self) -> dict[str, float]:
        """Progress for reports."""
        return {
            'position [s]': self._position % self.round,
            'rounds': float(self._position // self.round),
            'samples': float(self._samples),
            'stalls': float(self._stalls),
        }

    def events(self) -> Iterator[tuple[float, int]]:
        """Return times [s] and rows in order; a tick of /clock, row -1, comes after its sample."""
        return heapq.merge(self._rows(), self._ticks(), key=lambda event: event[0])

    def _rows(self) -> Iterator[tuple[float, int]]:
        for turn in itertools.count() if self.loop else range(1):
            for row, since in enumerate(self._since.tolist(), start=self._first_row):
                yield turn * self.round + since, row

    def _ticks(self) -> Iterator[tuple[float, int]]:
        period = min(self.rate / _CLOCK_RATE, LONGEST_CLOCK_STEP)
        for tick in itertools.count() if self.has_clock else ():
            if not self.loop and tick * period > self.round:
                return
            yield tick * period, -1

    def _run(self) -> None:
        try:
            if self._await_subscribers():
                self._play()
        except Exception as error:
            if not self._stopping.is_set():
                self.on_error(error)

    def _await_subscribers(self) -> bool:
        """Wait for subscribers, with a clock that stands; False if the thread is stopped."""
        waited = settled = math.inf
        while (now := time.monotonic()) < settled:
            if self.has_clock:
                self.publish(-1, self.begin)
            if waited == math.inf and self.may_start():
                waited = now + _LONGEST_WAIT
            lacking = 'a subscriber' if waited == math.inf else self.lacking()
            if lacking and now < waited:
                self._wait_for(lacking)
                settled = math.inf
            elif settled == math.inf:
                settled = now + _SETTLING
            if self._stopping.wait(_POLL):
                return False
        self.waits_for = ''
        if lacking:
            self.say(f'playing without {lacking}, after {_LONGEST_WAIT:g} s')
        return True

    def _wait_for(self, lacking: str) -> None:
        if lacking != self.waits_for:
            self.say(f'waiting for {lacking}')
        self.waits_for = lacking

    def _play(self) -> None:
        begin = time.monotonic()
        wall = time.time_ns()
        for at, row in self.events():
            due = at / self.rate
            wait = begin + due - time.monotonic()
            if wait > 0.0 and self._stopping.wait(wait):
                return
            if wait < -_LATEST:
                begin -= wait
                wall -= round(wait * _SECOND)
                self._stalls += 1
            begun, passed = (self.begin, at) if self.has_clock else (wall, due)
            self.publish(row, begun + round(passed * _SECOND))
            self._position = at
            self._samples += row >= 0
        self.on_end()
