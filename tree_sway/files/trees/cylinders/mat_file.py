# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Variables of a MATLAB file, read within bounds: by scipy, those of version 7.3 by netCDF4.

Version 7.3 is HDF5: groups are structs, and the axes of arrays are in reverse order. Elements of
cells and of arrays of structs are references there, which netCDF4 passes over.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.bounded import Arrays, bounded_arrays
from tree_sway.files.text_file import read_bytes

Variables = dict[str, Any]
"""Arrays by name; a struct is a dictionary, an array of structs one with numbers as names."""
_MAX_DEPTH = 8
_IS_HDF5 = b'MATLAB 7.3'
"""Beginning of a file of version 7.3."""


def read_mat(path: Path) -> Variables:
    """
    Read the arrays of numbers of a MATLAB file, those of structs and cells in dictionaries.

    Raises
    ------
    FormatError
        Not a MATLAB file, damaged, or above the limits of memory or time.
    MissingDependencyError
        A file of version 7.3, and netCDF4 is not installed.

    """
    read_bytes(path, at_most=1)
    cure = 'save it again with the option -v7'
    variables: Variables = {}
    arrays = bounded_arrays(_numbers_of_mat, path, kind='a MATLAB file', cure=cure)
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


def _numbers_of_mat(path: str) -> Arrays:
    """Yield the arrays of numbers in a file by their paths, such as ``QSM/cylinder/radius``."""
    with Path(path).open('rb') as file:
        is_hdf5 = file.read(len(_IS_HDF5)) == _IS_HDF5
    if is_hdf5:
        from netCDF4 import Dataset

        with Dataset(path) as root:
            yield from _of_hdf5('', root, 0)
        return
    from scipy.io import loadmat

    found = loadmat(path, simplify_cells=True)
    yield from _of_matlab('', {name: each for name, each in found.items() if name[:2] != '__'}, 0)


def _of_hdf5(name: str, group: Any, depth: int) -> Arrays:
    """Arrays of numbers in a group of a file of version 7.3; an empty one holds its own shape."""
    if depth > _MAX_DEPTH:
        raise ValueError(f'nested deeper than {_MAX_DEPTH}')
    for each, variable in group.variables.items():
        variable.set_auto_mask(False)
        if variable.dtype.kind in 'fiu' and 'MATLAB_empty' not in variable.ncattrs():
            yield f'{name}/{each}'.lstrip('/'), variable[:].T
    for each, inside in group.groups.items():
        if each != '#refs#':
            yield from _of_hdf5(f'{name}/{each}'.lstrip('/'), inside, depth + 1)


def _of_matlab(name: str, value: Any, depth: int) -> Arrays:
    """Arrays of numbers in a variable; structs and cells of several have numbers in their path."""
    if depth > _MAX_DEPTH:
        raise ValueError(f'nested deeper than {_MAX_DEPTH}')
    inside: Any = enumerate(value) if isinstance(value, list) else ()
    if isinstance(value, np.ndarray) and value.dtype.kind == 'O':
        inside = enumerate(value.ravel(order='F'))
    for each, one in value.items() if isinstance(value, dict) else inside:
        yield from _of_matlab(f'{name}/{each}'.lstrip('/'), one, depth + 1)
    if isinstance(value, np.ndarray | float | int) and np.asarray(value).dtype.kind in 'fiub':
        yield name, np.asarray(value)
