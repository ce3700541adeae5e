# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The newest samples of a source: those that no one has taken yet, and how fast they come."""

from __future__ import annotations

from collections import deque
import math
from typing import Generic, TypeVar

T = TypeVar('T')


class RecentSamples(Generic[T]):
    """
    Samples of any kind, which one thread adds and another one takes.

    Parameters
    ----------
    most
        Number of samples that wait; of more, the oldest are lost.
    counted
        Number of the newest ones whose rate is told.

    """

    def __init__(self, most: int, counted: int = 1) -> None:
        self._waiting = deque[tuple[float, T]](maxlen=most)
        self._times = deque[float](maxlen=counted)

    def add(self, time: float, sample: T) -> None:
        """Add a sample of a time of `time.monotonic` [s]."""
        self._times.append(time)
        self._waiting.append((time, sample))

    @property
    def rate(self) -> float:
        """Samples per second [Hz]; 0 before two of them."""
        times = list(self._times)
        passed = times[-1] - times[0] if times else 0.0
        return (len(times) - 1) / passed if passed > 0.0 else 0.0

    def drain(self, until: float = math.inf) -> list[T]:
        """Return the samples since the last call, up to a time of `time.monotonic` [s]."""
        found = []
        while self._waiting and not self._waiting[0][0] > until:
            found.append(self._waiting.popleft()[1])
        return found
