# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A thread that is started and stopped with its node, repeatedly, and one for calls beside."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
import os
import threading
from typing import TypeVar

from tree_sway.errors import TransportError

_T = TypeVar('_T')

_PATIENCE = 6.0
"""Longest wait for the work under way in [s]."""


class Worker:
    """Thread for `_run` of a subclass; `_stopping` is set to end it."""

    def __init__(self, name: str) -> None:
        self._stopping = threading.Event()
        self._thread = threading.Thread(name=name)

    @property
    def is_stopping(self) -> bool:
        """Whether the thread is to end."""
        return self._stopping.is_set()

    def start(self) -> None:
        """Start the thread; a `TransportError` if the one of before has not ended."""
        if self._thread.is_alive():
            raise TransportError(
                f"the work of thread '{self._thread.name}' has not ended since it was stopped",
                cure='activate again when it has, or start the node again',
            )
        self._stopping.clear()
        self._thread = threading.Thread(target=self._run, name=self._thread.name, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End the thread, and wait for the work under way; may be called twice."""
        self._stopping.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(timeout=_PATIENCE)

    def _run(self) -> None:
        """Work until `_stopping` is set."""
        raise NotImplementedError


def submit_beside(call: Callable[[], _T], /) -> Future[_T]:
    """Begin a call in the one thread for work beside the steps of trees with motion sensors."""
    return _beside().submit(call)


@cache
def _beside() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(1, thread_name_prefix='beside the steps')


if hasattr(os, 'register_at_fork'):  # a child process has no threads of its parent
    os.register_at_fork(after_in_child=_beside.cache_clear)
