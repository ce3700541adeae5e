# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How all hot functions are compiled: cached on disk, IEEE division, typed for the checker.

Where numba is missing (`WHY_PLAIN`), functions of numbers run as plain Python; functions over a
whole tree have a twin in numpy, in the module with ``numpy_`` before its name.
"""

from __future__ import annotations

from collections.abc import Callable
import gc
import threading
from typing import Any, cast, TypeVar

from tree_sway.cache.kernel_cache import KernelCache, why_no_compiler

_F = TypeVar('_F', bound=Callable[..., Any])

WHY_PLAIN = why_no_compiler()
"""Why nothing is compiled, in a few words; empty where kernels are."""

_LOOSE = {'contract', 'reassoc', 'nsz'}

LOOP_OPTIONS = {
    'fastmath': _LOOSE, 'forceinline': True, 'error_model': 'numpy', 'nogil': True,
    'no_cfunc_wrapper': True, '_nrt': False,
}  # fmt: skip
"""How functions are compiled that are parts of kernels."""

_COMPILER = threading.Lock()
"""Held while the collector is off. numba itself compiles for one thread at a time."""


def kernel(function: _F) -> _F:
    """
    Compile a function of numbers and arrays to machine code at its first call.

    Division by zero gives an infinity as in numpy, so that loops vectorise; the lock is released;
    the code is stored on disk (`kernel_cache`). The plain function stays reachable as ``py_func``.
    """
    return _compiled(function)


def fused(function: _F) -> _F:
    """
    Compile like `kernel`, but let a product and a sum be one instruction and reorder loops' sums.

    It is for placing and sums, where the last bit does not matter. The result is still the same
    bit for bit on one machine, for a callee becomes part of each caller: were it called, a caller
    would run whichever copy of it was loaded first. It is not for code that depends on rounding.
    """
    return _compiled(function, fastmath=_LOOSE, forceinline=True, _nrt=False)


def part(function: _F) -> _F:
    """
    Let kernels call a function, which is compiled like `fused` as a part of each.

    Outside of kernels it is the plain function: an entry for Python takes a third longer to
    compile.
    """
    function.py_func = function  # type: ignore[attr-defined]
    if not WHY_PLAIN:
        from numba.extending import register_jitable

        register_jitable(**LOOP_OPTIONS)(function)
    return function


def _compiled(function: _F, **options: Any) -> _F:
    if WHY_PLAIN:
        function.py_func = function  # type: ignore[attr-defined]
        return function
    from numba import njit

    dispatcher = njit(error_model='numpy', nogil=True, no_cfunc_wrapper=True, **options)(function)
    if hasattr(dispatcher, '_cache'):  # not where NUMBA_DISABLE_JIT leaves the plain function
        dispatcher._cache = KernelCache(function, repr(sorted(options)))
    return cast(_F, dispatcher)


def entry_of(function: Callable[..., Any], *arguments: Any) -> Callable[..., Any]:
    """
    Return the machine code of a kernel for arguments of these types, for many calls.

    A call of the kernel itself checks the type of each argument first, which for a small tree
    takes a fifth of a step. The machine code has no checks: only arguments of the same types and
    layouts may be passed.
    """
    find = getattr(function, 'get_overload', None)
    if find is None:
        return function
    from numba import typeof

    types = tuple(typeof(argument) for argument in arguments)
    # The compiler makes little garbage; to look for it takes a tenth of the first start.
    with _COMPILER:
        before = gc.get_threshold()
        gc.set_threshold(0)
        try:
            function.compile(types)  # type: ignore[attr-defined]
        finally:
            gc.set_threshold(*before)
    return cast(Callable[..., Any], find(types))
