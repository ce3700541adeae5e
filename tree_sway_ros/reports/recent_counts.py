# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Counts of the last reports, and whether so many were refused that it is a fault."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

_REPORTS = 6
"""Number of reports, each of a second, over which a count is recent."""
_SHARE, _FEWEST = 0.1, 3
"""Share of the recent samples, and their number, from which a refusal is a fault."""


class RecentCounts:
    """Growth of counts by name over the last seconds, for reports of each second."""

    def __init__(self) -> None:
        self._marks: deque[dict[str, int]] = deque([{}], maxlen=_REPORTS)

    def growth(self, counts: Mapping[str, int]) -> dict[str, int]:
        """Return by how much each of the present counts has grown, since some reports ago."""
        before = self._marks[0]
        self._marks.append(dict(counts))
        return {name: count - before.get(name, 0) for name, count in counts.items()}


def is_fault(refused: int, total: int) -> bool:
    """Whether a number of refused samples among all is more than a few."""
    return refused >= max(_FEWEST, _SHARE * total)


def listed(counts: Mapping[str, int]) -> str:
    """Return counts with their names, as text."""
    return ', '.join(f'{count} {name}' for name, count in counts.items())
