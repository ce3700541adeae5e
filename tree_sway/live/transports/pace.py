# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Limits of what a source may take of this machine: messages per second, and processor time."""

from __future__ import annotations

import time

MOST = 1000.0
"""Largest rate of messages [1/s]."""
_STORED = 1500.0
"""Messages that may come at once after a silence."""
_SIZE = 1024
"""Length that counts as one more message [bytes]."""
_SHARE = 0.25
"""Largest share of a processor that a link's thread takes."""
_BURST = 0.05
"""Time of the processor that it may take at once [s]."""
_LONGEST_REST = 0.5


class Pace:
    """
    Limits of a link, for the thread that delivers its messages.

    A flood is refused before it is read. Receiving and refusing take time too: so the thread
    rests, and what waits in the system meanwhile is received, or dropped by it, later.
    """

    def __init__(self) -> None:
        self._left = _STORED
        self._at = time.monotonic()
        self._time_left = _BURST
        self._rested = self._at
        self._spent = 0.0

    def begin(self) -> None:
        """Note that another thread delivers from now on."""
        self._spent = time.thread_time()

    def admits(self, size: int) -> bool:
        """Whether a message of some bytes is within the rate."""
        now = time.monotonic()
        passed = now - self._at
        self._at = now
        self._left = min(self._left + MOST * passed, _STORED)
        cost = 1.0 + size / _SIZE
        if cost > self._left:
            return False
        self._left -= cost
        return True

    @property
    def rest(self) -> float:
        """Time for which the thread is to rest now [s]; 0 within its share."""
        now = time.monotonic()
        spent = time.thread_time()
        gained = _SHARE * (now - self._rested) - (spent - self._spent)
        self._time_left = min(self._time_left + gained, _BURST)
        self._rested = now
        self._spent = spent
        return min(max(-self._time_left / _SHARE, 0.0), _LONGEST_REST)
