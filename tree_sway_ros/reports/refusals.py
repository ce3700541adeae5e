# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages that a node refused, by kind, for its report."""

from __future__ import annotations

from collections.abc import Sequence
import threading

from tree_sway_ros.reports.diagnostics import OK, Status, WARN


class Refusals:
    """
    Counts of refused messages, and why the last of each kind was; for several threads.

    Parameters
    ----------
    kinds
        Kinds of messages. Each has a status at all times: one that comes and goes is stale for an
        aggregator.

    """

    def __init__(self, kinds: Sequence[str]) -> None:
        self._lock = threading.Lock()
        self._refused = dict.fromkeys(kinds, (0, ''))

    def note(self, kind: str, why: str) -> None:
        """Count a refused message of a kind."""
        with self._lock:
            self._refused[kind] = self._refused[kind][0] + 1, why

    def statuses(self) -> list[Status]:
        """Report each kind: how many were refused, and why the last one was."""
        with self._lock:
            refused = dict(self._refused)
        return [
            Status(kind, WARN, f'{count} refused: {why}', {'refused': count})
            if count
            else Status(kind, OK, 'none refused', {'refused': 0})
            for kind, (count, why) in refused.items()
        ]
