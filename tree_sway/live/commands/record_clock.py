# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The clock that dates the rows of a record."""

from __future__ import annotations

import math
import time


class RecordClock:
    """
    The clock of this machine, which does not go back within a record.

    It follows a clock that is set forward, as on a machine that learns the date late. Rows that a
    clock set back would date before earlier ones are refused by readers.
    """

    def __init__(self) -> None:
        self._ahead = -math.inf

    def date(self, at: float) -> float:
        """Return the date in [s] since 1970 of a time of `time.monotonic`."""
        self._ahead = max(self._ahead, time.time() - time.monotonic())
        return at + self._ahead
