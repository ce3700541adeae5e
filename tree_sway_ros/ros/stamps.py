"""
When a sample was taken, on our own clock: its stamp if that can be believed, else its arrival.

A stamp is taken as it is where it lies within half a second of the arrival: the same record then gives the
same numbers in every run. Where the sender's clock is another one (not synchronised, or an old record) its
pace is kept and its offset is the least delay seen (Olson, "A Passive Solution to the Sensor Synchronization
Problem", 2010). Stamps that are zero, twice the same, out of order or leap are replaced by the arrival and
counted, so that no step in time is ever negative.

"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

SYNCHRONISED = 500_000_000
"""Stamps this near to their arrival are taken as they are [ns]."""
_LEAP = 1_000_000_000
_RESTART = 100_000_000
# How fast a better offset is forgotten, for clocks that drift: 1 ms a second.
_FORGETTING = 1000


class StampedTime(NamedTuple):
    """
    Time of a sample on the receiver's clock in [ns], and what was wrong with its stamp.

    `anomaly` is empty, or one of zero, duplicate, out_of_order, future, leap, restart. After a restart
    (the receiver's clock went back) everything that remembers earlier times is to be reset.

    """

    time: int
    anomaly: str


class StampClock:
    """Maps stamps to the receiver's clock; `counts` says how often each anomaly was met."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.reset()

    def reset(self) -> None:
        """Forget every stamp; the counts stay."""
        self._arrival: int | None = None
        self._stamp = 0
        self._time = 0
        self._offset = 0

    def read(self, stamp: int, arrival: int) -> StampedTime:
        """
        Time of a sample.

        Parameters
        ----------
        stamp
            Of its header in [ns], 0 if it has none.
        arrival
            Now, on the receiver's clock in [ns].

        """
        anomaly = self._anomaly(stamp, arrival)
        if anomaly == "restart":
            self.reset()
        first = self._arrival is None
        elapsed = 0 if self._arrival is None else arrival - self._arrival
        if anomaly:
            self.counts[anomaly] += 1
        if anomaly in ("zero", "duplicate", "out_of_order", "leap"):
            time, self._offset = arrival, arrival - stamp
        elif abs(arrival - stamp) <= SYNCHRONISED:
            time, self._offset = stamp, 0
        else:
            delay = arrival - stamp
            known = delay if first else self._offset + elapsed // _FORGETTING
            self._offset = min(delay, known)
            time = stamp + self._offset
        time = time if first else max(time, self._time + 1)
        self._arrival, self._stamp, self._time = arrival, stamp, time
        return StampedTime(time, anomaly)

    def _anomaly(self, stamp: int, arrival: int) -> str:
        if self._arrival is not None and arrival < self._arrival - _RESTART:
            return "restart"
        if stamp <= 0:
            return "zero"
        if self._arrival is None or self._stamp <= 0:
            return "future" if stamp > arrival + SYNCHRONISED else ""
        if stamp == self._stamp:
            return "duplicate"
        if stamp < self._stamp:
            return "out_of_order"
        if abs((stamp - self._stamp) - (arrival - self._arrival)) > _LEAP:
            return "leap"
        return "future" if stamp > arrival + SYNCHRONISED else ""
