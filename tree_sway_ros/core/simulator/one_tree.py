# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the simulator of one tree shares with that of a forest, so that both are used alike."""

from __future__ import annotations

from typing import TypeVar

from tree_sway_ros.core.wind.gust_travel import GustHistory

_One = TypeVar('_One', bound='OneTree')


class OneTree:
    """A simulator of one tree; its face is `TreeSimulator`."""

    gusts: GustHistory | None = None
    """No gusts travel within a tree."""

    @property
    def simulators(self: _One) -> tuple[_One, ...]:
        """Return the simulator of each tree: this one."""
        return (self,)
