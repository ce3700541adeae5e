# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Choice of frames to publish, where only some of them are."""

from __future__ import annotations


class Divider:
    """Divider of ticks, where only some of them make a frame."""

    def __init__(self) -> None:
        self._last: int | None = None

    def is_due(self, index: int, every: int) -> bool:
        """Whether tick `index` is the first in its group of `every` ticks."""
        group = index // every
        due = group != self._last
        self._last = group
        return due
