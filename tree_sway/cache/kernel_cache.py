# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Compiled kernels on disk, keyed by all their source.

numba's own cache checks only the file of a function, so that after an edit the callers of a
changed function run the old code. Here the key is a digest of all modules of the core, and of the
package of a function if it is a different one, beside signature, processor, compiler version and
flags. A kernel that cannot be read from disk is compiled again; one that cannot be written is
stored in memory. Processes that need the same kernel at once compile it once (`kernel_claim`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
import hashlib
from importlib import import_module
import os
from pathlib import Path
import pickle
import re
import sys
from typing import Any

from tree_sway.cache.folder import cache_folder, complain, read_own, write_own
from tree_sway.cache.kernel_claim import KernelClaim
from tree_sway.cache.source import ROOT, source_digest

PLAIN_VARIABLE = 'TREE_SWAY_NO_NUMBA'
"""Environment variable that turns the compiler off, if it is neither empty nor 0."""

OLDEST_COMPILER = (0, 59)
"""Oldest version of numba that can compile these kernels."""


@cache
def why_no_compiler() -> str:
    """Return why kernels cannot be compiled, in a few words; empty where they can."""
    if os.environ.get(PLAIN_VARIABLE, '0') not in ('', '0'):
        return f'{PLAIN_VARIABLE} is set'
    reason = _what_is_wrong_with_numba()
    if reason:
        complain(
            f'{reason}: trees are solved in numpy, some 100 times slower (4 ms for a frame of '
            '1,000 segments); install numba 0.59 or later'
        )
    return reason


def _what_is_wrong_with_numba() -> str:
    try:
        found = import_module('numba').__version__
    except ModuleNotFoundError:
        return 'numba is not installed'
    except Exception as error:  # any error of a broken installation
        return f'numba cannot be imported ({type(error).__name__})'
    numbers = tuple(int(part) for part in re.findall(r'\d+', found)[:2])
    if numbers < OLDEST_COMPILER:
        return f'numba {found} is older than {".".join(map(str, OLDEST_COMPILER))}'
    return ''


class KernelCache:
    """
    Cache of compiled code for a numba dispatcher, in place of numba's own.

    Parameters
    ----------
    function
        The plain function.
    flags
        Compiler options; part of the key.

    """

    def __init__(self, function: Callable[..., Any], flags: str) -> None:
        """Find the source of the kernel."""
        numba = import_module('numba')
        self._codec = import_module('numba.core.caching').CompileResultCacheImpl
        self._dumps = import_module('numba.core.serialize').dumps
        code = function.__code__
        own = Path(code.co_filename).parent
        while (own.parent / '__init__.py').is_file():  # up to its package
            own = own.parent
        digest = source_digest(ROOT / 'core') + source_digest(own) * (own != ROOT)
        self._name = f'{function.__module__.rpartition(".")[2]}.{function.__qualname__}'
        self._key = '\0'.join(
            [
                *(function.__module__, function.__qualname__, str(code.co_firstlineno), digest),
                *(flags, numba.__version__, sys.version, str(numba.config.BOUNDSCHECK)),
            ]
        )
        self._enabled = bool(digest)
        self._claims: dict[Path, KernelClaim] = {}

    @property
    def cache_path(self) -> str:
        """Folder of the files, empty without one."""
        return str(cache_folder() or '')

    def enable(self) -> None:
        """Enable reading and writing."""
        self._enabled = True

    def disable(self) -> None:
        """Disable reading and writing."""
        self._enabled = False

    def flush(self) -> None:
        """Do nothing: changed source has a different key."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return compiled code for a signature, or None where this process is to compile it."""
        path = self._path(sig, target_context.codegen())
        if path is None:
            return None
        if not path.is_file():
            claim = KernelClaim(path)
            if not path.is_file():
                self._claims[path] = claim
                return None
            claim.release()  # another process has compiled it meanwhile
        # The typing of numba takes long to load; compiled code does not need it, of it, and
        # whatever compiles loads it then.
        import_module('numba.core.runtime').rtsys.initialize(target_context)
        try:
            payload = pickle.loads(read_own(path))
            return self._codec.rebuild(None, target_context, payload)
        except Exception as error:
            complain(f'a compiled kernel cannot be read ({type(error).__name__}): {path}')
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Write compiled code atomically."""
        path = self._path(sig, data.codegen)
        if path is None:
            return
        try:
            if self._codec.check_cachable(None, data):
                write_own(path, self._dumps(self._codec.reduce(None, data)))
        except OSError as error:
            complain(f'compiled kernels cannot be stored: {error}')
        finally:
            if path in self._claims:
                self._claims.pop(path).release()

    def _path(self, sig: Any, codegen: Any) -> Path | None:
        folder = cache_folder() if self._enabled else None
        if folder is None:
            return None
        key = f'{self._key}\0{sig}\0{codegen.magic_tuple()}'.encode()
        name = re.sub(r'[^\w.]', '_', self._name)
        return folder / f'{name}-{hashlib.blake2b(key, digest_size=16).hexdigest()}.kernel'
