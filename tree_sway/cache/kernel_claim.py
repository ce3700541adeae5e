# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One process compiles a kernel; others that need it wait and then read it from disk.

A claim is a locked file beside the kernel. The system drops the lock when its process ends, so a
process that was killed holds up nobody.
"""

from __future__ import annotations

from contextlib import suppress
import os
from pathlib import Path
import sys
import time

LONGEST_WAIT = 60.0
"""Time after which a kernel is compiled although another process claims it [s]."""

_PAUSE = 0.02
"""Time between two attempts [s]."""


class KernelClaim:
    """The right to compile the kernel of one file."""

    def __init__(self, kernel: Path) -> None:
        """Wait until no other process holds the claim, at most `LONGEST_WAIT`."""
        self._path = kernel.with_suffix('.claim')
        self._handle: int | None = None
        if sys.platform != 'win32':  # which has no such locks: each process compiles for itself
            with suppress(OSError):
                self._handle = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
                self._lock(self._handle)

    @staticmethod
    def _lock(handle: int) -> None:
        import fcntl

        deadline = time.monotonic() + LONGEST_WAIT
        while time.monotonic() < deadline:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                time.sleep(_PAUSE)

    def release(self) -> None:
        """Let others compile or read; those that wait for the removed file find the kernel."""
        if self._handle is not None:
            self._path.unlink(missing_ok=True)
            os.close(self._handle)
            self._handle = None
