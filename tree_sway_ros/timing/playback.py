# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A wind record in time: when each sample is due, at any speed, around and around.

Time goes on over the seam of a loop: a period after the last sample of one round comes the first
of the next, so whoever follows the stamps or /clock never sees time go back.
"""

from __future__ import annotations

from collections.abc import Iterator
import heapq
import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.errors import FormatError
from tree_sway_ros.timing.handshake import LONGEST_LEAD

LONGEST_CLOCK_STEP = 0.25
"""Longest time between two ticks of /clock [s]; half of what a node takes for a jump."""
_LAST_TIME = 2.0**31
"""The first date after 1970 that a stamp cannot hold [s]."""
_MARGIN = 86_400.0
"""Loops go on after the end of a record [s]."""


class Event(NamedTuple):
    """
    Something to publish: its time since the playback began, and when it is due, in [s].

    The row is -1 for a tick of /clock; what goes ahead is due before its time.
    """

    time: float
    row: int
    due: float


def is_ros_time(epoch: float | None, time: NDArray[np.float64]) -> bool:
    """Whether the times [s] of a record, after an epoch if any, can be played as its dates."""
    if epoch is None or not len(time):
        return True
    return bool(epoch + time[0] >= 1.0 and epoch + time[-1] < _LAST_TIME - _MARGIN)


class Playback:
    """
    The events of a record.

    Parameters
    ----------
    time
        Times of the samples in [s], increasing, (n,).
    epoch
        Date of the record's time 0 in [s] after 1970, None if it has none.
    start
        Time skipped of the record in [s].
    loop
        Whether it starts again at its end.
    clock_period
        Time from one tick of /clock to the next, in the record's time [s]; 0 for none.
    ahead
        Whether each sample goes out with the time of the one before: who has heard one later than
        the clock knows that none is missing.

    Raises
    ------
    FormatError
        If nothing of the record is left.

    """

    def __init__(
        self,
        time: NDArray[np.float64],
        *,
        epoch: float | None = None,
        start: float = 0.0,
        loop: bool = False,
        clock_period: float = 0.0,
        ahead: bool = False,
    ) -> None:
        self.first_row = int(np.searchsorted(time, time[0] + start)) if len(time) else 0
        self._time = time[self.first_row :]
        if not len(self._time):
            raise FormatError(
                f'no sample {start:g} s into the record', cure='give a smaller start'
            )
        self._epoch = epoch
        self._loop = loop
        self._clock_period = clock_period
        steps = np.diff(self._time)
        self.round = float(
            self._time[-1] - self._time[0] + (np.median(steps) if len(steps) else 1)
        )
        self.goes_ahead = ahead

    @property
    def has_clock(self) -> bool:
        """Whether ticks of /clock are among the events."""
        return self._clock_period > 0.0

    @property
    def epoch(self) -> int:
        """Time of the first event in [ns], for /clock: the record's, or 1 s without a date."""
        if self._epoch is None:
            return 1_000_000_000
        return round((self._epoch + float(self._time[0])) * 1e9)

    def events(self) -> Iterator[Event]:
        """Events in order of time; a tick of /clock comes after the sample of its time."""
        if not self.has_clock:
            return self._samples()
        return heapq.merge(self._samples(), self._ticks(), key=lambda event: event.due)

    def _samples(self) -> Iterator[Event]:
        relative, before = (self._time - self._time[0]).tolist(), 0.0
        for turn in itertools.count() if self._loop else range(1):
            for row, since in enumerate(relative, start=self.first_row):
                time = turn * self.round + since
                yield Event(
                    time, row, max(before, time - LONGEST_LEAD) if self.goes_ahead else time
                )
                before = time

    def _ticks(self) -> Iterator[Event]:
        for tick in itertools.count():
            time = tick * self._clock_period
            if not self._loop and time > self.round:
                return
            yield Event(time, -1, time)
