# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The clock of a record: dates of its rows, and how long it waits."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timezone
import math
import threading
import time

_LOOK = 0.1


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


def iso_date(date: float, timespec: str) -> str:
    """Return a date in [s] since 1970 as ISO 8601, to ``milliseconds`` or ``microseconds``."""
    stamp = datetime.fromtimestamp(date, timezone.utc).isoformat(timespec=timespec)
    return stamp.replace('+00:00', 'Z')


def wait(end: float, is_over: Callable[[], object]) -> bool:
    """Wait until a time of `time.monotonic`, or until something is over; False after Ctrl-C."""
    pause = threading.Event()
    try:
        while (left := end - time.monotonic()) > 0.0:
            pause.wait(min(_LOOK, left))
            if is_over():
                break
    except KeyboardInterrupt:
        return False
    return True
