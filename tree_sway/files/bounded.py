# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Read a file by a library in a separate process, with bounded memory and time.

A few bytes can claim gigabytes, nest without end, or end the process that a library runs in. The
reader runs in a child process, whose program is this file, and returns arrays in numpy's own
format, which is read without pickles.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from importlib import import_module
import io
import json
import os
from pathlib import Path
import subprocess
import sys
from typing import Any, IO

import numpy as np

from tree_sway.errors import FormatError, MissingDependencyError, TreeSwayError
from tree_sway.extras import cure_of_missing
from tree_sway.files.text_file import MAX_BYTES, reason_of

MEMORY, SECONDS = 768 << 20, 20
"""Limits of reading a file: memory, and each unpacked file [bytes]; processor [s]."""
_MAX_ARRAYS = 100_000
_CELL_END, _ROW_END = '\x1f', '\x1e'
_IS_TOLD = 'told '
"""Begin of an error of the function that names file and cure itself."""

Arrays = Iterator[tuple[str, Any]]


def bounded_arrays(
    read: Callable[..., Arrays], path: Path, *words: str, kind: str, cure: str
) -> dict[str, Any]:
    """
    Return the named arrays that a function of a module yields for a path and further words.

    It costs the start of a process, some 0.2 s, and Ctrl-C ends it.

    Raises
    ------
    FormatError
        The function raised one, or another error, or took more than `MEMORY` or `SECONDS`; then
        its message has the ``kind`` of file and the cure.
    MissingDependencyError
        The function imports a module that is not installed.

    """
    command = [sys.executable, __file__, read.__module__, read.__name__, str(path.absolute())]
    found = os.pathsep.join(filter(None, [os.environ.get('PYTHONPATH', ''), *sys.path]))
    environment = {**os.environ, 'PYTHONPATH': found, 'OPENBLAS_NUM_THREADS': '1'}
    try:
        ended = subprocess.run(
            [*command, *words], capture_output=True, env=environment, timeout=2 * SECONDS
        )
        code = ended.returncode
        reason = ended.stderr.decode('utf-8', 'replace').strip().split('\n')[-1]
    except subprocess.TimeoutExpired:
        code, reason = -1, ''
    if reason.startswith('no module '):
        missing = reason.rsplit(' ', 1)[1]
        raise MissingDependencyError(
            f'to read {kind} needs {missing}', where=str(path), cure=cure_of_missing(missing)
        )
    if reason.startswith(_IS_TOLD):
        what, where, remedy = json.loads(reason.removeprefix(_IS_TOLD))
        place = where.replace(str(path.absolute()), str(path))
        raise FormatError(what, where=place, cure=remedy)
    if code:
        budget = f'it takes more than {MEMORY >> 20} MiB of memory or {SECONDS} s, or is damaged'
        why = budget if code < 0 or 'MemoryError' in reason else reason
        raise FormatError(f'not {kind} that can be read: {why}', where=str(path), cure=cure)
    with np.load(io.BytesIO(ended.stdout)) as arrays:
        return {name: arrays[name] for name in arrays.files}


def packed_rows(rows: Iterable[Sequence[object]]) -> np.ndarray[Any, np.dtype[np.uint8]]:
    """Texts of the cells of rows as one array; a `ValueError` above `MAX_BYTES`."""
    texts = bytearray()
    for row in rows:
        cells = ('' if cell is None or isinstance(cell, bytes) else str(cell) for cell in row)
        clean = (cell.replace(_CELL_END, ' ').replace(_ROW_END, ' ') for cell in cells)
        texts += (_CELL_END.join(clean) + _ROW_END).encode('utf-8', 'replace')
        if len(texts) > MAX_BYTES:
            raise ValueError(f'more than {MAX_BYTES >> 20} MiB of text')
    return np.frombuffer(texts, np.uint8)


def unpacked_rows(array: np.ndarray[Any, np.dtype[np.uint8]]) -> Iterator[list[str]]:
    """Yield the rows of `packed_rows`."""
    for text in array.tobytes().decode('utf-8').split(_ROW_END)[:-1]:
        yield text.split(_CELL_END)


def _main(*words: str) -> None:
    with suppress(ImportError):  # of systems other than Unix, where the parent has a timeout
        import resource

        for kind, most in (
            (resource.RLIMIT_AS, MEMORY),
            (resource.RLIMIT_CPU, SECONDS),
            (resource.RLIMIT_FSIZE, MEMORY),
        ):
            hard = resource.getrlimit(kind)[1]
            unlimited = hard == resource.RLIM_INFINITY
            resource.setrlimit(kind, (most if unlimited else min(most, hard), hard))
    _answer(sys.stdout.buffer, *words)


def _answer(to: IO[bytes], module: str, name: str, path: str, *words: str) -> None:
    """Write the arrays of a function of a module; end the program with the error it raises."""
    found = dict[str, Any]()
    try:
        for each, array in getattr(import_module(module), name)(path, *words):
            found[each] = array
            if len(found) > _MAX_ARRAYS:
                raise ValueError(f'more than {_MAX_ARRAYS} arrays')
        np.savez(to, **found)
    except ModuleNotFoundError as error:
        sys.exit(f'no module {error.name}')
    except TreeSwayError as error:
        sys.exit(_IS_TOLD + json.dumps([error.what, error.where, error.cure]))
    except Exception as error:
        sys.exit(reason_of(error))


if __name__ == '__main__':
    _main(*sys.argv[1:])
