"""
The one way a hot function is compiled: cached on disk, IEEE division, types kept for the checker.

"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit
from numba.core import types
from numba.extending import overload

from tree_sway_ros.kernel_cache import KernelCache

_F = TypeVar("_F", bound=Callable[..., Any])


_LOOSE = {"contract", "reassoc", "nsz"}


def kernel(function: _F) -> _F:
    """
    Compile a function of numbers and arrays to machine code at its first call.

    Division by zero gives an infinity as in numpy, so that loops vectorise; the lock is released;
    the code is kept on disk (`kernel_cache`). The plain function stays reachable as ``py_func``.

    """
    return _compiled(function)


def fused(function: _F) -> _F:
    """
    Compile like `kernel`, but let a product and a sum be one instruction and reorder sums.

    For what is placed and summed, where the last bit does not matter; the result is still the same
    bit for bit on one machine. Not for code that counts on rounding.

    """
    return _compiled(function, fastmath=_LOOSE)


def inlined(function: _F) -> _F:
    """
    Compile like `fused` and paste the body into each caller, so that a loop of calls vectorises.

    For short functions of numbers in the innermost loop; callers compile longer.

    """
    return _compiled(function, fastmath=_LOOSE, inline="always")


def _compiled(function: _F, **options: Any) -> _F:
    dispatcher = njit(error_model="numpy", nogil=True, **options)(function)
    if hasattr(dispatcher, "_cache"):  # not where NUMBA_DISABLE_JIT leaves the plain function
        dispatcher._cache = KernelCache(function, repr(sorted(options)))
    return cast(_F, dispatcher)


def like(value: float, model: Any) -> Any:
    """
    Return a constant in the precision of a model number, so that a kernel serves float32 and
    float64.

    Outside compiled code the constant is left as it is: Python numbers adapt by themselves.

    """
    return value


@overload(like, inline="always")
def _like(value, model):  # type: ignore[no-untyped-def]
    if model == types.float32:
        return lambda value, model: np.float32(value)
    return lambda value, model: value
