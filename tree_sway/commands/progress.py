# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Progress of commands: a bar for counted work, a line for other work.

All output goes to standard error. Bars are those of tqdm, only on terminals; without tqdm or
terminal there is a line now and then, with the time that is left.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
import sys
import threading
import time
from typing import Any, TypeVar

from tree_sway.errors import shown

T = TypeVar('T')

PATIENCE = 2.0
"""Shortest wait that is reported [s]."""

_BETWEEN = 10.0
"""Time between two lines of progress [s]."""


def bar(items: Collection[T], what: str) -> Iterator[T]:
    """Yield the items, and show their progress under a label: "MuJoCo", "settling"."""
    counted = _bar_on_terminal(what, iterable=items)
    if counted is not None:
        yield from counted
        return
    with counting(len(items), what, is_bar=False) as tell:
        for done, item in enumerate(items):
            tell(done)
            yield item


@contextmanager
def counting(total: int, what: str, *, is_bar: bool = True) -> Iterator[Callable[[int], object]]:
    """Give a function that shows how many of a total are done, by a bar if there can be one."""
    counted = _bar_on_terminal(what, total=total) if is_bar and total > 1 else None
    if counted is None:
        with waiting(what):
            yield _Lines(what, total).tell
        return
    with counted:
        yield lambda done: counted.update(done - counted.n)


def _bar_on_terminal(what: str, **given: Any) -> Any:
    """Make a bar of tqdm; None without it or without a terminal."""
    if sys.stderr is None or not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        return None
    # The bar moves the cursor, which `sys.stderr` escapes inside a command.
    return tqdm(**given, desc=shown(what), delay=PATIENCE, leave=False, file=sys.__stderr__)


@contextmanager
def waiting(what: str) -> Iterator[None]:
    """Print a label, if the work inside takes longer than a short wait."""
    timer = threading.Timer(PATIENCE, _report, [f'{what} ...'])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


class _Lines:
    """Lines that tell now and then how many of a total are done, and what time is left."""

    def __init__(self, what: str, total: int) -> None:
        self._what = what
        self._total = total
        self._told = time.monotonic()
        self._first = 0
        self._since = 0.0

    def tell(self, done: int) -> None:
        """Print a line if the last is long ago; the first that are done, set up others."""
        now = time.monotonic()
        if done and not self._first:
            self._first = done
            self._since = now
        if not done or now - self._told <= _BETWEEN:
            return
        self._told = now
        text = f'{self._what}: {done} of {self._total}'
        if done > self._first:
            left = (now - self._since) * (self._total - done) / (done - self._first)
            text = f'{text}, about {max(left, 1.0):.0f} s left'
        _report(text)


def _report(text: str) -> None:
    if sys.stderr is not None:
        print(text, file=sys.stderr, flush=True)
