# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a start is doing, said as it begins and again while it goes on."""

from __future__ import annotations

from collections.abc import Callable
import threading
import time

AGAIN = 5.0
"""A stage that goes on is said again after so long [s]."""


class Progress:
    """
    A context for a start that may take long: a stage is said again after ``again`` [s].

    It is logged from another thread as well.
    """

    def __init__(self, log: Callable[[str], None], again: float = AGAIN) -> None:
        self._log = log
        self._again = again
        self._begin = time.monotonic()
        self._stage = ''
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._repeat, name='progress', daemon=True)

    def stage(self, text: str) -> None:
        """Say what begins."""
        self._stage = text
        self._log(text)

    @property
    def elapsed(self) -> float:
        """Time since the start began [s]."""
        return time.monotonic() - self._begin

    def __enter__(self) -> Progress:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _repeat(self) -> None:
        while not self._over.wait(self._again):
            self._log(f'{self._stage}: {self.elapsed:.0f} s so far')
