# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Slow work on the newest request, on a thread that ends when there is none."""

from __future__ import annotations

from collections.abc import Callable
import logging
import threading
from typing import Generic, TypeVar

T = TypeVar('T')

_LOGGER = logging.getLogger('tree_sway.page')


class Newest(Generic[T]):
    """
    Work on one request at a time; a request that a newer one replaces is never begun.

    Parameters
    ----------
    work
        Function called with each request, on the thread.
    name
        Name of the thread.

    """

    def __init__(self, work: Callable[[T], None], name: str) -> None:
        self._work = work
        self._name = name
        self._lock = threading.Lock()
        self._wanted: T | None = None
        self._is_working = False

    @property
    def wanted(self) -> T | None:
        """Newest request until its work is done, then None."""
        return self._wanted

    def want(self, request: T) -> None:
        """Work on a request as soon as the work under way is done."""
        with self._lock:
            self._wanted = request
            if self._is_working:
                return
            self._is_working = True
        threading.Thread(target=self._go_on, args=(request,), name=self._name, daemon=True).start()

    def _go_on(self, request: T) -> None:
        while True:
            try:
                self._work(request)
            except Exception:
                _LOGGER.exception('%s failed', self._name)
            with self._lock:
                newer = self._wanted
                if newer is None or newer is request:
                    self._wanted = None
                    self._is_working = False
                    return
            request = newer
