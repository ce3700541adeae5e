# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees whose steps stay clamped: they show fewer coordinates.

A table of winds clamps the energy of a tree, so that no tree is flung away. A gust may reach that
limit; a tree that stays at it follows no wind any more. It then continues from rest without the
coordinates that matter least, the stiffest among them, until it is reset: that a smaller wind
would suffer them again is not known before.
"""

from __future__ import annotations

LONGEST_CLAMPED = 1.0
"""Time in [s] for which steps may be clamped, less the time of steps between that are not."""

FEWEST = 3
"""Smallest number of coordinates that are left."""


class ClampWatch:
    """Sums the time for which the steps of a tree were clamped."""

    def __init__(self) -> None:
        self._seconds = 0.0
        self._last = 0

    def is_stuck(self, step: int, dt: float) -> bool:
        """
        Note a clamped step; return whether the tree has been clamped for too long.

        Steps that are not clamped need no call: ``step`` is the number of the step, of dt [s].
        """
        n_free = step - self._last - 1
        self._seconds = max(self._seconds - n_free * dt, 0.0) + dt
        self._last = step
        if self._seconds < LONGEST_CLAMPED:
            return False
        self._seconds = 0.0
        return True


def fewer(count: int) -> int:
    """Return the next smaller number of coordinates to show, two thirds of a count."""
    return min(count, max(FEWEST, 2 * count // 3))
