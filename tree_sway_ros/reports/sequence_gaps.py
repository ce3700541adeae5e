# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages that were lost between one publisher and a subscription, by their sequence numbers."""

from __future__ import annotations

from collections.abc import Mapping


class SequenceGaps:
    """
    Count of lost messages.

    Each publisher numbers its messages, and a message does not name its publisher: gaps count only
    if there was one publisher from one report to the next.
    """

    def __init__(self) -> None:
        self.lost = 0
        """Number of lost messages up to the last report."""
        self._last: int | None = None
        self._pending = 0
        self._publishers = 1

    def note(self, info: Mapping[str, object]) -> None:
        """Note the information of rclpy on a message; middleware may give no numbers."""
        number = info.get('publication_sequence_number')
        if not isinstance(number, int) or number <= 0:
            return
        if self._last is not None and number > self._last:
            self._pending += number - self._last - 1
        self._last = number

    def report(self, publishers: int) -> int:
        """Return the messages lost since the last report, with the present publishers."""
        pending = self._pending
        self._pending = 0
        was_one = self._publishers == 1
        self._publishers = publishers
        if publishers != 1 or not was_one:
            self._last = None
            return 0
        self.lost += pending
        return pending
