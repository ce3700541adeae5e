# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How the laboratory's functions are compiled by numba: division as IEEE has it, stored on disk.

numba finds what it stored by the file of a function alone, so that after an edit the callers of a
changed function would run the old code: its folder has a digest of all source in its name.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
import shutil
import sys
import time
from typing import Any, cast, TypeVar

from tree_sway.cache import cache_folder, ROOT, source_digest
from tree_sway.errors import MissingDependencyError

try:
    import numba
    from numba.extending import register_jitable
except ImportError as error:
    raise MissingDependencyError(
        f"the laboratory's truths are compiled by numba, which cannot be imported ({error})",
        cure="pip install 'numba>=0.59'",
    ) from error

_F = TypeVar('_F', bound=Callable[..., Any])

_UNUSED = 30 * 86_400.0
"""Age after which what older source made is removed [s]."""

_OPTIONS = {
    'error_model': 'numpy', 'nogil': True, '_nrt': False,
    'fastmath': {'contract', 'reassoc', 'nsz'},
}  # fmt: skip

if (_folder := cache_folder()) is not None:
    _digest = source_digest(ROOT / 'core') + source_digest(Path(__file__).parent)
    numba.config.CACHE_DIR = str(_folder / f'numba-{_digest}')
    for _other in _folder.glob('numba-*'):
        if time.time() - _other.stat().st_mtime > _UNUSED:
            shutil.rmtree(_other, ignore_errors=True)


@contextmanager
def _one_compiler() -> Iterator[None]:
    """Let one process compile at a time, so that the others find its code on disk."""
    if _folder is None or sys.platform == 'win32':
        yield
        return
    import fcntl

    with open(_folder / 'numba.lock', 'w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def kernel(function: _F) -> _F:
    """
    Compile a function of numbers and arrays to machine code at its first call.

    Division by zero gives an infinity as in numpy, so that loops vectorise; the lock is released.
    Rows are copied number by number: where one is assigned as a whole, the words of an error are
    compiled, too, for 3 s. The plain function stays reachable as ``py_func``.
    """
    return cast(_F, numba.njit(error_model='numpy', nogil=True, cache=True)(function))


def fused(function: _F) -> _F:
    """
    Compile like `kernel`, but let a product and a sum be one instruction and reorder loops' sums.

    It is not for code that depends on rounding.
    """
    return cast(_F, numba.njit(**_OPTIONS, cache=True)(function))


def part(function: _F) -> _F:
    """
    Let kernels call a function, which is compiled like `fused` as a part of each.

    Outside of kernels it is the plain function.
    """
    register_jitable(**_OPTIONS, forceinline=True)(function)
    return function


def entry_of(function: Callable[..., Any], *arguments: Any) -> Callable[..., Any]:
    """
    Return the machine code of a kernel for arguments of these types, for many calls.

    A call of the kernel itself checks the type of each argument first. The machine code has no
    checks: only arguments of the same types and layouts may be passed.
    """
    types = tuple(numba.typeof(argument) for argument in arguments)
    with _one_compiler():
        function.compile(types)  # type: ignore[attr-defined]
    found: Callable[..., Any] = function.get_overload(types)  # type: ignore[attr-defined]
    return found
