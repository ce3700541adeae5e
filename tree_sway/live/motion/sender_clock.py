# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The clock of a sender, brought to that of this machine.

A sender counts seconds, milliseconds, microseconds or nanoseconds from any moment. The unit is
found from the first second of samples. The difference of both clocks is the smallest that was seen
between the time of a sample and its arrival: the way over the network only adds to it. A minute
later it is found again, so that clocks which drift stay together. Times that go back again and
again are those of two senders, for a clock that is set goes back once, and a late message never.
"""

from __future__ import annotations

from collections import deque
import math

_UNITS = (1.0, 1e3, 1e6, 1e9)
"""Ticks in a second that clocks have."""
_ODD = 1.4
"""Factor by which a clock may seem to be fast or slow over its first second."""
_FIRST, _LEAST = 1.0, 5
"""Time [s] and number of samples in which the unit is found."""
_WINDOW = 30.0
"""Time [s] for which the smallest difference is kept, once and once more."""
_JUMP, _PATIENCE = 1.0, 3.0
"""Difference [s] that is a jump, and time [s] after which the clock is taken as set anew."""
_MIXED, _WITHIN = 5, 30.0
"""Number of times that go back within some seconds [s], which two senders have."""
_MIXTURE = 'its times go back and forth, as those of two senders: give each an address of its own'
_SLEW = 0.05
"""Change of the difference in a second [s]: small, so that samples keep their order."""

_NEVER = math.inf, math.inf
"""Stamp and arrival of a first sample that has not come."""


class SenderClock:
    """
    A clock that is compared by arrivals.

    Parameters
    ----------
    ticks
        Ticks in a second; None to find them.

    """

    def __init__(self, ticks: float | None = None) -> None:
        self.ticks = ticks
        """Ticks in a second; None until they are known."""
        self.problem = ''
        """Why no time can be told, and what to do; empty if it can, or not yet."""
        self.jumps = 0
        """Number of times that it was set anew."""
        self._backs = deque[float](maxlen=_MIXED)
        self._previous = self._arrival = -math.inf
        self._first = _NEVER
        self._count = 0
        self._offset = self._low = self._low_before = math.inf
        self._window_ends = -math.inf
        self._jumped_at = math.inf
        self._newest = -math.inf

    def note(self, stamp: float, arrival: float, earliest: float | None = None) -> bool:
        """
        Note the newest stamp of a message and its arrival in [s]; whether `local` is known.

        A message of several samples has an earliest stamp, too. `local` is not known while the
        unit is being found, and after a jump until it has lasted.
        """
        if self._previous - stamp > _JUMP * (self.ticks or 0.0):
            self._backs.append(arrival)
        self._previous = stamp
        self._arrival = arrival
        if self.ticks is None and not self._find_ticks(stamp, arrival):
            return False
        assert self.ticks is not None
        difference = arrival - stamp / self.ticks
        is_first = math.isinf(self._offset)
        if is_first or abs(difference - self._offset) > _JUMP:
            self._jumped_at = min(self._jumped_at, arrival)
            if not is_first and arrival - self._jumped_at < _PATIENCE:
                return False
            self.jumps += not is_first
            self._offset = self._low = self._low_before = difference
            self._window_ends = arrival + _WINDOW
            self._newest = stamp
        self._jumped_at = math.inf
        first = stamp if earliest is None else earliest
        self._follow(difference, arrival, (first - self._newest) / self.ticks)
        self._newest = max(self._newest, stamp)
        return True

    @property
    def mixture(self) -> str:
        """What tells that two clocks are mixed, and what to do; empty if nothing does."""
        backs = self._backs
        is_mixed = len(backs) == _MIXED and self._arrival - backs[0] < _WITHIN
        return _MIXTURE if is_mixed else ''

    def local(self, stamp: float) -> float:
        """Return the time of a stamp on the clock of arrivals in [s]."""
        assert self.ticks is not None
        return stamp / self.ticks + self._offset

    def _find_ticks(self, stamp: float, arrival: float) -> bool:
        if stamp < self._first[0]:
            self._first = (stamp, arrival)
            self._count = 0
        self._count += 1
        passed = arrival - self._first[1]
        if passed < _FIRST or self._count < _LEAST:
            return False
        ratio = (stamp - self._first[0]) / passed
        unit = min(_UNITS, key=lambda each: abs(math.log(max(ratio, 1e-300) / each)))
        if not 1.0 / _ODD < ratio / unit < _ODD:
            self.problem = self.mixture or (
                f'its clock counts {ratio:.3g} in a second: send the time in s, ms, us or ns, or '
                'leave it out'
            )
            self._first = _NEVER
            return False
        self.ticks = unit
        self.problem = ''
        return True

    def _follow(self, difference: float, arrival: float, passed: float) -> None:
        """Follow the smallest difference, slower than the time that passed between samples."""
        if arrival > self._window_ends:
            self._low_before = self._low
            self._low = difference
            self._window_ends = arrival + _WINDOW
        self._low = min(self._low, difference)
        wanted = min(self._low, self._low_before) - self._offset
        most = _SLEW * max(passed, 0.0)
        self._offset += min(max(wanted, -most), most)
