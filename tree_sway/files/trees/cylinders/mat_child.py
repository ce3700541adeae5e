# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The process that `mat_file` reads a MATLAB file in: numbers out, whatever the file does to it.

Run as ``python mat_child.py FILE``; it writes the arrays of numbers in the file to its standard
output, in numpy's own format, by their paths such as ``QSM/cylinder/radius``.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
import sys
from typing import Any

import numpy as np

MEMORY, SECONDS = 768 << 20, 10
"""What reading a file may take [bytes] and [s] of processor."""
_MAX_DEPTH, _MAX_ARRAYS = 8, 100_000

Arrays = Iterator[tuple[str, Any]]


def main(path: str) -> None:
    """Write the arrays of a file to standard output."""
    with open(path, 'rb') as stream:
        head = stream.read(128)
    is_hdf5 = b'HDF\r\n' in head[:8] or head.startswith(b'MATLAB 7.3')
    found: dict[str, Any] = {}
    for name, array in _of_hdf5(path) if is_hdf5 else _of_matlab(path):
        found[name] = array
        if len(found) > _MAX_ARRAYS:
            raise ValueError(f'more than {_MAX_ARRAYS} arrays')
    np.savez(sys.stdout.buffer, **found)


def _of_matlab(path: str) -> Arrays:
    from scipy.io import loadmat

    for name, value in loadmat(path, chars_as_strings=False).items():
        if name[:2] != '__':
            yield from _arrays(name, value, 0)


def _arrays(name: str, value: Any, depth: int) -> Arrays:
    """Arrays of numbers in a variable; structs and cells of several have numbers in their path."""
    if depth > _MAX_DEPTH:
        raise ValueError(f'nested deeper than {_MAX_DEPTH}')
    if not isinstance(value, np.ndarray):
        return
    if value.dtype.kind in 'fiub':
        yield name, value
    elif value.dtype.kind in 'OV':
        for number, one in enumerate(value.ravel(order='F')):
            inner = name if value.dtype.names and value.size == 1 else f'{name}/{number}'
            if not value.dtype.names:
                yield from _arrays(inner, one, depth + 1)
            for each in value.dtype.names or ():
                yield from _arrays(f'{inner}/{each}', one[each], depth + 1)


def _of_hdf5(path: str) -> Arrays:
    import h5py

    def members(group: Any, above: str, depth: int) -> Arrays:
        if depth > _MAX_DEPTH:
            raise ValueError(f'nested deeper than {_MAX_DEPTH}')
        for name in group:
            if name[0] != '#' and isinstance(group.get(name, getlink=True), h5py.HardLink):
                yield from inside(group[name], f'{above}{name}', depth)

    def inside(each: Any, name: str, depth: int) -> Arrays:
        if isinstance(each, h5py.Group):
            yield from members(each, f'{name}/', depth + 1)
        elif isinstance(each, h5py.Dataset) and each.shape and each.dtype.kind in 'fiubO':
            if each.external or each.is_virtual:
                raise ValueError(f'{each.name} is stored in another file')
            if each.dtype.kind != 'O':
                yield name, np.transpose(each[()])  # MATLAB's columns are HDF5's rows
            elif h5py.check_ref_dtype(each.dtype) is h5py.Reference:
                for number, one in enumerate(np.ravel(each[()])):
                    if one:
                        yield from inside(each.file[one], f'{name}/{number}', depth + 1)

    with h5py.File(path, 'r') as file:
        yield from members(file, '', 0)


if __name__ == '__main__':
    with suppress(ImportError):  # of systems other than Unix, where the parent's clock is left
        import resource

        for kind, most in ((resource.RLIMIT_AS, MEMORY), (resource.RLIMIT_CPU, SECONDS)):
            hard = resource.getrlimit(kind)[1]
            unlimited = hard == resource.RLIM_INFINITY
            resource.setrlimit(kind, (most if unlimited else min(most, hard), hard))
    try:
        main(sys.argv[1])
    except ModuleNotFoundError as error:
        sys.exit(f'no module {error.name}')
    except Exception as error:
        sys.exit(f'{type(error).__name__}: {error}')
