# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A replay waits for the samples that a step reads."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import threading
import time
from typing import Any

UNHEARD = -1
"""In place of the stamp of a topic's newest sample, before any: no stamp is negative."""

_PATIENCE, _PATIENCE_AT_FIRST = 3.0, 10.0
"""
Times [s] of the machine for which a replay waits for a sample or a publisher, and from when a
publisher is found for its first sample.

"""

_STOP_CHECK = 0.05
"""Interval [s] of checks whether the node is ended while it waits."""


class SampleWait:
    """
    Waits in the thread of the steps, once for each sample that is lost.

    Parameters
    ----------
    node
        The solver, with its pacer.
    lacking
        Function that tells, for the end of a step in [ns], which topics have yet to send what it
        reads, and their newest stamps [ns].

    """

    def __init__(self, node: Any, lacking: Callable[[int], Iterable[tuple[str, int]]]) -> None:
        self._node = node
        self._lacking = lacking
        self._event = threading.Event()
        self._missed: set[tuple[str, int]] = set()
        self.note_arrival = self._event.set
        """Function to call after each sample."""

    def wait(self, to: int) -> None:
        """Wait for the samples that act before a time in [ns]."""
        end = time.monotonic() + _PATIENCE
        found: set[str] = set()
        clock = self._node.get_clock()
        while (
            not self._node.pacer.is_stopping and clock.now().nanoseconds >= to
        ):  # or was set back
            self._event.clear()
            lacking = set(self._lacking(to))
            if lacking <= self._missed:
                return
            unheard = {topic for topic, newest in lacking - self._missed if newest == UNHEARD}
            published = {topic for topic in unheard if self._node.count_publishers(topic)}
            if published - found:
                found |= published
                end = time.monotonic() + _PATIENCE_AT_FIRST
            if (left := end - time.monotonic()) <= 0.0:
                self._missed = lacking
                return
            self._event.wait(min(left, _STOP_CHECK))
