# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a command shows while it works: a bar for what is counted, a line for what is not.

Everything goes to standard error. Bars are tqdm's, on terminals alone; without tqdm, and where
there is no terminal, a line says what is done.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
import sys
import threading
from typing import TypeVar

T = TypeVar('T')

PATIENCE = 2.0
"""A wait as long as this is reported [s]."""


def bar(items: Collection[T], what: str) -> Iterator[T]:
    """Yield the items, and show how many of them are done, and of what: "MuJoCo", "settling"."""
    if sys.stderr is not None and sys.stderr.isatty():
        with suppress(ImportError):
            from tqdm import tqdm

            yield from tqdm(items, desc=what, delay=PATIENCE, leave=False, file=sys.stderr)
            return
    with waiting(what):
        yield from items


@contextmanager
def waiting(what: str) -> Iterator[None]:
    """Say what is done, if the work inside takes longer than people wait without a word."""
    timer = threading.Timer(PATIENCE, _report, [f'{what} ...'])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _report(text: str) -> None:
    if sys.stderr is not None:
        print(text, file=sys.stderr, flush=True)
