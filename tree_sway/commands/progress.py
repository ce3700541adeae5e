# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Progress of commands: a bar for counted work, a line for other work.

All output goes to standard error. Bars are those of tqdm, only on terminals; without tqdm or
terminal there is a line.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
import sys
import threading
from typing import TypeVar

from tree_sway.errors import shown

T = TypeVar('T')

PATIENCE = 2.0
"""Shortest wait that is reported [s]."""


def bar(items: Collection[T], what: str) -> Iterator[T]:
    """Yield the items, and show their progress under a label: "MuJoCo", "settling"."""
    if sys.stderr is not None and sys.stderr.isatty():
        with suppress(ImportError):
            from tqdm import tqdm

            # The bar moves the cursor, which `sys.stderr` escapes inside a command.
            terminal = sys.__stderr__
            yield from tqdm(items, desc=shown(what), delay=PATIENCE, leave=False, file=terminal)
            return
    with waiting(what):
        yield from items


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


def _report(text: str) -> None:
    if sys.stderr is not None:
        print(text, file=sys.stderr, flush=True)
