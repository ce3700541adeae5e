# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Linear algebra on one thread, for the same bits on any number of processors.

OpenBLAS divides sums among its threads, so that the last bits of modes depend on their number. The
OpenBLAS libraries that numpy and scipy have loaded are set; other BLAS libraries are not changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import ctypes
from functools import cache
import threading

from numpy.linalg import _umath_linalg

_NAMES = ('scipy_openblas_{}64_', 'scipy_openblas_{}', 'openblas_{}64_', 'openblas_{}')


class _Users:
    """
    Blocks that need one thread of each OpenBLAS at present.

    The number of threads is a setting of the process, and blocks of several threads of the program
    overlap: the first one sets it, and the last one sets it back.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._n_blocks = 0
        self._before: list[int] = []

    def enter(self) -> None:
        """Set one thread for the first block."""
        switches = _switches()
        with self._lock:
            if self._n_blocks == 0:
                self._before = [get() for _, get in switches]
                for put, _ in switches:
                    put(1)
            self._n_blocks += 1

    def leave(self) -> None:
        """Set the number of threads back after the last block."""
        with self._lock:
            self._n_blocks -= 1
            if self._n_blocks == 0:
                for (put, _), count in zip(_switches(), self._before, strict=True):
                    put(count)


_USERS = _Users()


@contextmanager
def one_thread() -> Iterator[None]:
    """Run a block with one thread of each OpenBLAS, in other threads of the program too."""
    _USERS.enter()
    try:
        yield
    finally:
        _USERS.leave()


@cache
def _switches() -> tuple[tuple[Callable[[int], object], Callable[[], int]], ...]:
    """Functions that set and return the number of threads, for each OpenBLAS."""
    from scipy.linalg import _fblas  # it takes long to load

    found = []
    for module in (_umath_linalg, _fblas):
        try:
            library = ctypes.CDLL(module.__file__)
        except OSError:
            continue
        for name in _NAMES:
            put = getattr(library, name.format('set_num_threads'), None)
            get = getattr(library, name.format('get_num_threads'), None)
            if put is not None and get is not None:
                found.append((put, get))
                break
    return tuple(found)
