# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Ending of a process soon after Ctrl-C, whatever it is doing.

Ctrl-C and SIGTERM set a flag that a loop checks, or interrupt work before the loop. Python handles
signals between two of its own instructions, and a factorisation or a file may take seconds
without one; so a thread checks as well, and ends the process after a timeout.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import signal
import sys
import threading
from types import FrameType

_SHORTEST = 0.3
"""`Ending.LONGEST` while a process starts, with nothing open that must be closed."""
_GRACE = 0.2
"""Time [s] after which the operating system ends a process."""
_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Ending:
    """
    A context that handles SIGINT and SIGTERM, in the main thread only.

    After a signal no exception leaves it, as interrupted work may raise any. Behind a last one the
    process is over: Python's own end would wait for threads of libraries, and take down modules
    one by one, which takes seconds on a busy machine.
    """

    LONGEST = 1.5
    """Time from the signal to the end of a running process [s], if it does not end before."""

    def __init__(self, *, is_last: bool = False) -> None:
        self._is_last = is_last
        self.is_asked = False
        self.limit = _SHORTEST
        self._breaks_in = True
        self._over = threading.Event()
        self._pipe: tuple[int, int] | None = None
        self._before: list[object] = []

    def look(self) -> None:
        """From now on a loop checks `is_asked`: do not interrupt any more."""
        self._breaks_in = False
        self.limit = self.LONGEST
        if self.is_asked:
            raise KeyboardInterrupt

    def __enter__(self) -> Ending:
        if threading.current_thread() is not threading.main_thread():
            return self
        self._before = [signal.signal(number, self._hear) for number in _SIGNALS]
        self._pipe = os.pipe()
        os.set_blocking(self._pipe[1], False)
        signal.set_wakeup_fd(self._pipe[1], warn_on_full_buffer=False)
        threading.Thread(target=self._watch, name='ending', daemon=True).start()
        return self

    def __exit__(self, *_: object) -> bool:
        if not self._before:
            return False
        if self._is_last and self.is_asked:
            for each in (sys.stdout, sys.stderr):
                with contextlib.suppress(AttributeError, OSError, ValueError):  # none, or closed
                    each.flush()
            os._exit(0)
        self._over.set()
        for number, before in zip(_SIGNALS, self._before, strict=True):
            # Further signals are ignored: a second Ctrl-C during the end is not an error.
            after = signal.SIG_IGN if self.is_asked else before
            signal.signal(number, after)  # type: ignore[arg-type]
        faulthandler.cancel_dump_traceback_later()
        if self._pipe is not None:
            signal.set_wakeup_fd(-1)
            os.close(self._pipe[1])
        return self.is_asked

    def _hear(self, _number: int, _frame: FrameType | None) -> None:
        is_first = not self.is_asked
        self.is_asked = True
        if is_first:
            self._end_by_all_means()
        if is_first and self._breaks_in:
            sys.unraisablehook = lambda _args: None  # nor print unraisable exceptions
            raise KeyboardInterrupt

    def _end_by_all_means(self) -> None:
        """Leaving the graph, the middleware may block the interpreter: then C ends the process."""
        self._nowhere = open(os.devnull, 'w')
        faulthandler.dump_traceback_later(self.limit + _GRACE, exit=True, file=self._nowhere)

    def _watch(self) -> None:
        assert self._pipe is not None
        while heard := os.read(self._pipe[0], 1):
            if heard[0] in _SIGNALS and not self._over.wait(self.limit):
                sys.stdout.flush()
                os._exit(0)
        os.close(self._pipe[0])
