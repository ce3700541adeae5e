# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One sender for a source: the samples of two instruments are never mixed.

The first that is heard twice is followed. Others are refused, counted and named, until it has been
silent for some periods, its own and theirs. One that was heard once gives way: it may be a stray
message, or a sender whose next message comes from another port.
"""

from __future__ import annotations

from collections import Counter, deque

_PERIODS = 3.0
_LEAST = 2.0
"""Silence after which a sender gives way: a number of its periods, and no less in [s]."""
_GAPS = 32
"""Number of the last times between messages from which the period is found."""
_MOST = 32
"""Number of senders that are remembered, and of those whose refusals are counted apart."""


class OneSender:
    """A source that follows one sender at a time."""

    def __init__(self) -> None:
        self.current = ''
        """Origin of the messages that are followed."""
        self.refused = Counter[str]()
        """Numbers of messages that were refused, by the first origins that occur."""
        self.total_refused = 0
        """Number of all messages that were refused."""
        self._gaps = deque[float](maxlen=_GAPS)
        self._newest = 0.0
        self._heard: dict[str, float] = {}  # when each was last heard, the latest at the end

    def admit(self, origin: str, now: float) -> bool:
        """
        Tell whether a message is of the sender that is followed; count it if it is not.

        Parameters
        ----------
        origin
            Who sent it.
        now
            Time of its arrival in [s], on a clock that does not jump.

        """
        before = self._heard.pop(origin, None)
        self._heard[origin] = now
        if len(self._heard) > _MOST:
            del self._heard[next(iter(self._heard))]
        if origin != self.current:
            own = 0.0 if before is None else _PERIODS * (now - before)
            if self._gaps and now - self._newest <= max(self.patience, own):
                self.total_refused += 1
                if origin in self.refused or len(self.refused) < _MOST:
                    self.refused[origin] += 1
                return False
            self.current = origin
            self._gaps.clear()
        if before is not None:
            self._gaps.append(now - before)
        self._newest = now
        return True

    @property
    def period(self) -> float:
        """
        Time between messages in [s], 0 before two.

        It is the second longest of the last ones: a single outage is none, and messages may come
        several at a time.
        """
        return sorted(self._gaps)[-2:][0] if self._gaps else 0.0

    @property
    def patience(self) -> float:
        """Silence after which the sender gives way [s]."""
        return max(_LEAST, _PERIODS * self.period)

    @property
    def problem(self) -> str:
        """Who is refused beside whom; empty if there is one sender only."""
        if not self.refused:
            return ''
        others = list(self.refused)
        more = f' and {len(others) - 1} more' if len(others) > 1 else ''
        return (
            f'{self.total_refused} messages of another sender ({others[-1]}{more}) were refused, '
            f'{self.current} is followed: give each an address of its own'
        )
