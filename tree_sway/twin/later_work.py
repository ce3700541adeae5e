# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Work in another thread that one step begins and a later one needs.

Gains, mountings and fits take milliseconds and change slowly. Each is due a fixed number of steps
after its beginning. Until then it is done a part at each step, or by a thread of the caller beside
the steps. The step at which its result is used is the same either way, and so is the motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Generic, Protocol, TypeVar

_T = TypeVar('_T')
_T_co = TypeVar('_T_co', covariant=True)


class Awaited(Protocol[_T_co]):
    """What is waited for, as a ``concurrent.futures.Future``."""

    def result(self) -> _T_co:
        """Wait for the result."""


class Submit(Protocol):
    """Begin a call beside the caller, as ``concurrent.futures.Executor.submit``."""

    def __call__(self, call: Callable[[], _T], /) -> Awaited[_T]:
        """Begin a call."""


class LaterWork(Generic[_T]):
    """
    Work in parts, whose result is due later.

    Parameters
    ----------
    parts
        Yields None after each part, and the result after the last one. With a ``submit`` it must
        not read what the steps change.
    n_steps
        Number of calls of `advance`, the last of which returns the result.
    submit
        Begins a call in another thread; None to work a part at each call.

    """

    def __init__(
        self, parts: Iterator[_T | None], n_steps: int, submit: Submit | None = None
    ) -> None:
        self._parts, self._left = parts, n_steps
        self._found: _T | None = None
        self._pending = None if submit is None else submit(self._finish)

    def advance(self) -> _T | None:
        """Go on by a step; return the result when it is due."""
        self._left -= 1
        if self._pending is None and self._found is None:
            self._found = next(self._parts)
        if self._left > 0:
            return None
        return self._finish() if self._pending is None else self._pending.result()

    def _finish(self) -> _T:
        while self._found is None:
            self._found = next(self._parts)
        return self._found
