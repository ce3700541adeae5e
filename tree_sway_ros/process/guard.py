# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Guard around all callbacks of a node: exceptions are counted and logged, not raised.

An exception that leaves a callback ends the executor, and with it all nodes that share it; one in
the callback of a service leaves its caller without a reply.
"""

from __future__ import annotations

from collections.abc import Callable
import functools
import traceback
from typing import Any


class CallbackGuard:
    """Wrapper of callbacks; errors are logged once per place, with trace, and counted."""

    def __init__(self, log: Callable[[str], None]) -> None:
        self.count = 0
        self.latest = ''
        self._log = log
        self._places: set[tuple[str, str, int]] = set()

    def wrapped(self, callback: Callable[..., Any]) -> Callable[..., Any]:
        """
        Return a callback that never raises.

        On an exception it returns its last argument: of a service this is the response, so that
        the caller gets a reply.
        """

        @functools.wraps(callback)
        def guarded(*arguments: Any) -> Any:
            try:
                return callback(*arguments)
            except Exception as error:
                self.note(error)
                return arguments[-1] if arguments else None

        return guarded

    def note(self, error: Exception) -> None:
        """Count an exception; log the first one of its place."""
        self.count += 1
        self.latest = f'{type(error).__name__}: {error}'
        frames = traceback.extract_tb(error.__traceback__)
        last = frames[-1] if frames else None
        place = (type(error).__name__, last.filename, last.lineno or 0) if last else ('', '', 0)
        if place not in self._places:
            self._places.add(place)
            trace = ''.join(traceback.format_exception(error)).rstrip()
            self._log(f'a callback failed; further failures are only counted\n{trace}')
