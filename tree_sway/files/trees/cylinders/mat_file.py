# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Variables of a MATLAB file, read by scipy (versions 4 to 7) or h5py (7.3), within bounds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.bounded import Arrays, bounded_arrays
from tree_sway.files.text_file import read_bytes

Variables = dict[str, Any]
"""Arrays by name; structs as dictionaries, several of them in one with numbers for names."""
_MAX_DEPTH = 8


def looks_like_mat(head: str) -> bool:
    """Whether the beginning of a file is that of a MATLAB file."""
    return head.startswith(('MATLAB', '\ufffdHDF\r\n\x1a\n'))


def read_mat(path: Path) -> Variables:
    """
    Read the arrays of numbers of a MATLAB file, those of structs and cells in dictionaries.

    Raises
    ------
    FormatError
        Not a MATLAB file, damaged, or one that takes too much memory or time.
    MissingDependencyError
        If it is of version 7.3 and h5py is not installed.

    """
    read_bytes(path, at_most=1)
    cure = 'save it again with the option -v7'
    variables: Variables = {}
    arrays = bounded_arrays(numbers_of_mat, path, kind='a MATLAB file', cure=cure)
    for name, array in arrays.items():
        *above, last = name.split('/')
        place = variables
        for step in above:
            place = place.setdefault(step, {})
        place[last] = array
    return variables


def numbers(value: Any, name: str) -> Floats:
    """Return a variable as numbers, without axes of length 1; a `FormatError` for others."""
    if not isinstance(value, np.ndarray):
        raise FormatError(f"'{name}' is not numeric")
    return value.astype(np.float64).squeeze()


def numbers_of_mat(path: str) -> Arrays:
    """Yield the arrays of numbers in a file by their paths, such as ``QSM/cylinder/radius``."""
    with open(path, 'rb') as stream:
        head = stream.read(128)
    if b'HDF\r\n' in head[:8] or head.startswith(b'MATLAB 7.3'):
        import h5py

        with h5py.File(path, 'r') as file:
            yield from _of_hdf5(file, '', 0)
        return
    from scipy.io import loadmat

    found = loadmat(path, simplify_cells=True)
    yield from _of_matlab('', {name: each for name, each in found.items() if name[:2] != '__'}, 0)


def _of_matlab(name: str, value: Any, depth: int) -> Arrays:
    """Arrays of numbers in a variable; structs and cells of several have numbers in their path."""
    _check_depth(depth)
    inside: Any = enumerate(value) if isinstance(value, list) else ()
    if isinstance(value, np.ndarray) and value.dtype.kind == 'O':
        inside = enumerate(value.ravel(order='F'))
    for each, one in value.items() if isinstance(value, dict) else inside:
        yield from _of_matlab(f'{name}/{each}'.lstrip('/'), one, depth + 1)
    if isinstance(value, np.ndarray | float | int) and np.asarray(value).dtype.kind in 'fiub':
        yield name, np.asarray(value)


def _of_hdf5(node: Any, name: str, depth: int) -> Arrays:
    """Arrays of numbers in a group or a dataset; references, which cells are, are followed."""
    import h5py

    _check_depth(depth)
    if isinstance(node, h5py.Group):
        for each in node:
            if each[0] != '#' and isinstance(node.get(each, getlink=True), h5py.HardLink):
                yield from _of_hdf5(node[each], f'{name}/{each}'.lstrip('/'), depth + 1)
    elif isinstance(node, h5py.Dataset) and node.shape and node.dtype.kind in 'fiubO':
        if node.external or node.is_virtual:
            raise ValueError(f'{node.name} is stored in another file')
        if node.dtype.kind != 'O':
            yield name, np.transpose(node[()])  # MATLAB's columns are HDF5's rows
        elif h5py.check_ref_dtype(node.dtype) is h5py.Reference:
            for number, one in enumerate(np.ravel(node[()])):
                if one:
                    yield from _of_hdf5(node.file[one], f'{name}/{number}', depth + 1)


def _check_depth(depth: int) -> None:
    if depth > _MAX_DEPTH:
        raise ValueError(f'nested deeper than {_MAX_DEPTH}')
