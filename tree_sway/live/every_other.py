# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Two senders behind one name, by their speeds: as where every other message is much faster.

Two instruments of one make have one period, so that their messages alternate. Gusts of one
instrument do not: the means of its even and of its odd messages are the same. Nothing is told of
senders of other periods, or of nearly equal wind.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats

_LENGTH = 32
"""Number of messages that are looked at together."""
_LEAST = 1.0
"""Least difference of the two means that is told [m/s]."""
_ERRORS = 8.0
"""Least ratio of that difference to its standard error [-]."""
_STEPS, _COARSEST = 1.5, 2.5
"""
Least ratio of it to the resolution of the speeds, of which no more than 2.5 m/s are taken.

A cup that counts two and a half pulses in its interval tells two and three by turns.
"""


class EveryOther:
    """Speeds of one source, looked at in windows of 32."""

    def __init__(self) -> None:
        self.total = 0
        """Number of messages in windows of which every other message was faster."""
        self.means: tuple[float, float] | None = None
        """Means of the slower and the faster ones [m/s], if the last window was such a one."""
        self._speeds = list[float]()

    def note(self, speed: float) -> bool:
        """Note the speed of the next message [m/s]; whether it tells of two for the first time."""
        self._speeds.append(speed)
        if len(self._speeds) < _LENGTH:
            return False
        self.means = _two_means(np.array(self._speeds))
        self._speeds.clear()
        is_first = self.means is not None and not self.total
        self.total += _LENGTH * (self.means is not None)
        return is_first

    @property
    def problem(self) -> str:
        """What it looks like, and what to do; empty if the last window was of one sender."""
        if self.means is None:
            return ''
        slow, fast = self.means
        return (
            f'every other message is faster ({slow:.1f} and {fast:.1f} m/s), as of two senders: '
            'give each an address of its own'
        )


def _two_means(speeds: Floats) -> tuple[float, float] | None:
    """Return the means of even and odd speeds, the lower first; None where they may be one."""
    even, odd = speeds[::2], speeds[1::2]
    low, high = sorted((float(even.mean()), float(odd.mean())))
    error = float(np.sqrt((even.var(ddof=1) + odd.var(ddof=1)) / (0.5 * _LENGTH)))
    steps = np.diff(np.unique(speeds))
    resolution = min(float(steps.min(initial=np.inf)), _COARSEST)
    is_told = high - low > max(_LEAST, _ERRORS * error, _STEPS * resolution)
    return (low, high) if is_told else None
