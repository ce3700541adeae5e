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

from numpy.linalg import _umath_linalg

_NAMES = ('scipy_openblas_{}64_', 'scipy_openblas_{}', 'openblas_{}64_', 'openblas_{}')


@contextmanager
def one_thread() -> Iterator[None]:
    """Run a block with one thread of each OpenBLAS, in other threads of the program too."""
    before = [(put, get()) for put, get in _switches()]
    try:
        for put, _ in before:
            put(1)
        yield
    finally:
        for put, count in before:
            put(count)


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
