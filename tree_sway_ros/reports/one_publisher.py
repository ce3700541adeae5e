# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Samples of one of the publishers of a topic, so that two instruments are never mixed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
import math

_PERIODS = 3.0
_LEAST = 1.0
"""Silence after which a publisher gives way: a number of its periods, and no less in [s]."""


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
