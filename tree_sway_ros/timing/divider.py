# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which of the solver's frames are published, where only some of them are."""

from __future__ import annotations


class Divider:
    """Decides when the next frame is due, where only some of the ticks make one."""

    def __init__(self) -> None:
        self._last: int | None = None

    def is_due(self, index: int, every: int) -> bool:
        """Whether tick `index` is the first in its group of `every` ticks."""
        group = index // every
        due = group != self._last
        self._last = group
        return due
