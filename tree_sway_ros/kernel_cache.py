# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Compiled kernels on disk, keyed by all the source that goes into them.

numba's own cache looks at the file of a function alone, so that after an edit the callers of a
changed function run the old code. Here the key is a digest of a function's module and of every
module of this package that it imports, directly or not, beside signature, processor, compiler
version and flags. A kernel that cannot be read from disk is compiled again; one that cannot be
written is kept in memory.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
import hashlib
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
import os
from pathlib import Path
import pickle
import re
import sys
import tempfile
from typing import Any
import warnings

ROOT = Path(__file__).resolve().parent
"""Folder of the package."""

FOLDER_VARIABLE = 'TREE_SWAY_CACHE'
"""Environment variable that names another folder for compiled kernels."""

PLAIN_VARIABLE = 'TREE_SWAY_NO_NUMBA'
"""Environment variable that leaves the compiler out, if it is set to anything but nothing or 0."""

OLDEST_COMPILER = (0, 59)
"""Versions of numba before this one do not come to an end of these kernels."""

_IMPORT = re.compile(
    r'^[ \t]*(?:from[ \t]+tree_sway_ros\.([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)'
    r'|import[ \t]+tree_sway_ros\.([\w.]+))',
    re.MULTILINE,
)


@cache
def why_no_compiler() -> str:
    """Why kernels cannot be compiled here, in a few words; empty where they can."""
    if os.environ.get(PLAIN_VARIABLE, '0') not in ('', '0'):
        return f'{PLAIN_VARIABLE} is set'
    reason = _what_is_wrong_with_numba()
    if reason:
        _complain(
            f'{reason}: trees are solved in numpy, some 100 times slower (3 ms for a frame of '
            "1,000 segments), and the model 'segments' not at all; install numba 0.59 or later"
        )
    return reason


def _what_is_wrong_with_numba() -> str:
    try:
        found = version('numba')
    except PackageNotFoundError:
        return 'numba is not installed'
    numbers = tuple(int(part) for part in re.findall(r'\d+', found)[:2])
    if numbers < OLDEST_COMPILER:
        return f'numba {found} is older than {".".join(map(str, OLDEST_COMPILER))}'
    try:
        import_module('numba')
    except Exception as error:  # whatever a broken installation raises
        return f'numba {found} cannot be imported ({type(error).__name__})'
    return ''


class KernelCache:
    """
    What a numba dispatcher asks for compiled code, in place of numba's own cache.

    Parameters
    ----------
    function
        The plain function.
    flags
        Options it is compiled with; part of the key.

    """

    def __init__(self, function: Callable[..., Any], flags: str) -> None:
        """Find out what the kernel is made from."""
        numba = import_module('numba')
        self._codec = import_module('numba.core.caching').CompileResultCacheImpl
        self._dumps = import_module('numba.core.serialize').dumps
        code = function.__code__
        digest = source_digest(Path(code.co_filename))
        self._name = f'{function.__module__.rpartition(".")[2]}.{function.__qualname__}'
        self._key = '\0'.join(
            [
                *(function.__module__, function.__qualname__, str(code.co_firstlineno), digest),
                *(flags, numba.__version__, sys.version, str(numba.config.BOUNDSCHECK)),
            ]
        )
        self._enabled = bool(digest)

    @property
    def cache_path(self) -> str:
        """Folder of the files, empty where there is none."""
        return str(kernel_folder() or '')

    def enable(self) -> None:
        """Read and write from now on."""
        self._enabled = True

    def disable(self) -> None:
        """Neither read nor write from now on."""
        self._enabled = False

    def flush(self) -> None:
        """Forget nothing: another source has another key."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return compiled code for a signature, or None if there is none that can be used."""
        path = self._path(sig, target_context.codegen())
        if path is None or not path.is_file():
            return None
        # What numba knows to compile from takes long to load; code that is compiled asks for none
        # of it, and whatever compiles loads it then.
        import_module('numba.core.runtime').rtsys.initialize(target_context)
        try:
            payload = pickle.loads(path.read_bytes())
            return self._codec.rebuild(None, target_context, payload)
        except Exception as error:
            _complain(f'a compiled kernel cannot be read ({type(error).__name__}): {path}')
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Write compiled code, all of it or nothing."""
        path = self._path(sig, data.codegen)
        if path is None or not self._codec.check_cachable(None, data):
            return
        partial = path.with_suffix(f'.{os.getpid()}.part')
        try:
            partial.write_bytes(self._dumps(self._codec.reduce(None, data)))
            partial.replace(path)
        except OSError as error:
            _complain(f'compiled kernels cannot be kept: {error}')
            partial.unlink(missing_ok=True)

    def _path(self, sig: Any, codegen: Any) -> Path | None:
        folder = kernel_folder() if self._enabled else None
        if folder is None:
            return None
        key = f'{self._key}\0{sig}\0{codegen.magic_tuple()}'.encode()
        name = re.sub(r'[^\w.]', '_', self._name)
        return folder / f'{name}-{hashlib.blake2b(key, digest_size=16).hexdigest()}.kernel'


@cache
def source_digest(path: Path) -> str:
    """Digest of a source file and of all modules of ours it imports; empty if unreadable."""
    try:
        found: dict[Path, bytes] = {path: path.read_bytes()}
    except OSError:
        return ''
    waiting = [path]
    while waiting:
        for other in _imported(waiting.pop()):
            if other not in found:
                found[other] = other.read_bytes()
                waiting.append(other)
    digest = hashlib.blake2b(found.pop(path), digest_size=16)
    for other in sorted(found):
        digest.update(str(other.relative_to(ROOT)).encode() + b'\0' + found[other])
    return digest.hexdigest()


@cache
def _imported(path: Path) -> tuple[Path, ...]:
    """Files of this package that a file imports."""
    files = []
    for module, names, plain in _IMPORT.findall(path.read_text(encoding='utf-8')):
        base = ROOT.joinpath(*(module or plain).split('.'))
        if base.with_suffix('.py').is_file():
            files.append(base.with_suffix('.py'))
        else:
            inner = (base / f'{name}.py' for name in re.findall(r'\w+', names))
            files += [file for file in inner if file.is_file()]
    return tuple(files)


@cache
def kernel_folder() -> Path | None:
    """Folder for compiled kernels: the one asked for, the user's, a temporary one; or None."""
    asked = os.environ.get(FOLDER_VARIABLE) or os.environ.get('NUMBA_CACHE_DIR')
    home = os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~/.cache')
    own = f'tree_sway_ros-{os.getuid()}' if hasattr(os, 'getuid') else 'tree_sway_ros'
    places = [Path(asked)] if asked else []
    places += [Path(home) / 'tree_sway_ros', Path(tempfile.gettempdir()) / own]
    for place in places:
        if _usable(place):
            return place
    _complain('no folder for compiled kernels can be written; they are compiled in every process')
    return None


def _usable(place: Path) -> bool:
    """Whether a folder is there or can be made, belongs to this user alone, and can be written."""
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if hasattr(os, 'getuid') and place.stat().st_uid != os.getuid():
            return False
        with tempfile.TemporaryFile(dir=place) as probe:
            probe.write(b'\0' * 4096)
    except OSError:
        return False
    return True


_said: set[str] = set()


def _complain(text: str) -> None:
    """Say it on one line, once per process and cause."""
    cause = text.split(':')[0]
    if cause not in _said:
        _said.add(cause)
        warnings.warn_explicit(text, RuntimeWarning, 'tree_sway_ros', 1)
