# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Samples of one of the publishers of a topic, so that two instruments are never mixed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import math

_PERIODS = 3.0
_LEAST = 1.0
"""Silence after which a publisher gives way: a number of its periods, and no less in [s]."""
_SHOWN = 5
"""Largest number of nodes that are named."""


def named(publishers: Sequence[str]) -> str:
    """Return the number of several publishers and the names of the first, for a report."""
    return f'{len(publishers)} publishers: {", ".join(sorted(publishers)[:_SHOWN])}'


class OnePublisher:
    """
    Follower of the first publisher, until it has been silent for some periods.

    A message does not name its publisher, but each publisher numbers its messages: where there are
    several, only the next number of the one that is followed is taken.
    """

    def __init__(self) -> None:
        self.refused = 0
        """Number of samples of other publishers."""
        self._last: int | None = None
        self._at = -math.inf
        self._period = 0.0

    def admits(self, info: Mapping[str, object], count: Callable[[], int], now: float) -> bool:
        """
        Whether a sample is of the publisher that is followed.

        Parameters
        ----------
        info
            Information of rclpy on a message; middleware may give no numbers.
        count
            Function that counts the publishers; called where the number is not the next one.
        now
            Time of arrival in [s], on a clock that does not jump.

        """
        number = info.get('publication_sequence_number')
        if not isinstance(number, int) or number <= 0:
            return True
        is_next = self._last is not None and number == self._last + 1
        is_live = now - self._at <= max(_LEAST, _PERIODS * self._period)
        if is_live and not is_next and count() > 1:
            self.refused += 1
            return False
        if is_next:
            self._period = now - self._at
        self._last = number
        self._at = now
        return True

    def faults(self, publishers: Sequence[str]) -> list[str]:
        """Return a sentence where several nodes publish; none for one."""
        if len(publishers) < 2:
            return []
        others = f'{self.refused} samples of others were refused'
        return [f'{named(publishers)}; one is followed, {others}']
