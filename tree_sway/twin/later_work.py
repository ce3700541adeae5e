# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Work beside the steps that one step begins and a later one needs.

Gains, mountings and fits take milliseconds and change slowly. Each is found in another thread, and
used a fixed number of steps after its beginning, so that the motion does not depend on how fast
that is.
"""

from __future__ import annotations

from collections.abc import Callable
import os
from typing import Generic, TypeVar

from tree_sway.worker import submit_beside

_T = TypeVar('_T')


class LaterWork(Generic[_T]):
    """
    Work whose result is due later.

    Parameters
    ----------
    find
        Finds the result. It must not read what the steps change. A process that is forked before
        the result is due has no thread of its parent, and calls it again.
    n_steps
        Number of calls of `advance`, the last of which returns the result.

    """

    def __init__(self, find: Callable[[], _T], n_steps: int) -> None:
        self._find, self._process = find, os.getpid()
        self._pending, self._left = submit_beside(find), n_steps

    def advance(self) -> _T | None:
        """Go on by a step; return the result when it is due."""
        self._left -= 1
        if self._left > 0:
            return None
        return self._pending.result() if os.getpid() == self._process else self._find()
