# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A skeleton as PLY, such as AdTree exports: vertices with a radius, and edges; other PLY is named.

An edge is a list of two vertices, or ``vertex1`` and ``vertex2``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.foreign_file import foreign_file
from tree_sway.files.text_file import read_bytes
from tree_sway.files.trees.cylinders.cylinders import Trees
from tree_sway.files.trees.cylinders.rooted import cylinders_of_edges
from tree_sway.files.trees.tree_options import FITTED

_TYPES = dict(
    zip(
        'char uchar short ushort int uint float double '
        'int8 uint8 int16 uint16 int32 uint32 float32 float64'.split(),
        'i1 u1 i2 u2 i4 u4 f4 f8'.split() * 2,
        strict=True,
    )
)
_ORDERS = {'ascii': '', 'binary_little_endian': '<', 'binary_big_endian': '>'}
_HEAD = 65_536
"""Bytes in which the header ends."""
_AGAIN = 'save it again as PLY'
Elements = dict[str, tuple[int, dict[str, str]]]
"""Number of each kind of element, and the types of its properties by their names."""


def _read(path: Path) -> Trees:
    """Tree of a skeleton."""
    data = read_bytes(path)
    try:
        order, elements, begin = _header(data)
    except (ValueError, LookupError):
        raise FormatError('a damaged header of PLY', cure=_AGAIN) from None
    _refuse_others(elements)
    try:
        tables = _tables(data[begin:], order, elements)
    except (ValueError, OverflowError, MemoryError):
        raise FormatError('other vertices or edges than its header says', cure=_AGAIN) from None
    names = [*elements['vertex'][1]]
    *point, radius = (tables['vertex'][:, names.index(each)] for each in ('x', 'y', 'z', 'radius'))
    for row in np.flatnonzero(~np.isfinite(sum(point) + radius))[:1]:
        raise FormatError(
            'a place or a radius that is no number',
            where=f'vertex {row}',
            cure='remove it and its edges',
        )
    edges = tables['edge'][:, -2:].astype(np.int64)
    return (cylinders_of_edges(np.column_stack(point), edges, radius, of_nodes=True),)


def _header(data: bytes) -> tuple[str, Elements, int]:
    """Return order of bytes, elements by name, and where their values begin."""
    end = data.index(b'end_header', 0, _HEAD)
    order = ''
    elements: Elements = {}
    own: dict[str, str] = {}
    for line in data[:end].decode('ascii', 'replace').splitlines():
        match line.split():
            case ['format', form, *_]:
                order = _ORDERS[form]
            case ['element', name, count]:
                own = {}
                elements[name] = int(count), own
            case ['property', 'list', size, kind, name]:  # of two vertices, if of an edge
                own |= {'n': _TYPES[size], f'{name}1': _TYPES[kind], f'{name}2': _TYPES[kind]}
            case ['property', kind, name]:
                own[name] = _TYPES[kind]
    return order, elements, data.index(b'\n', end) + 1


def _refuse_others(elements: Elements) -> None:
    """Name a file that is no skeleton with radii."""
    counts = {name: count for name, (count, _) in elements.items()}
    if not counts.get('vertex'):
        what, cure = 'PLY without vertices', _AGAIN
    elif counts.get('face'):
        what, cure = foreign_file(Path('mesh.ply'))
        cure += ': the skeleton with its radii, or the cylinders'
    elif not counts.get('edge'):
        what, cure = foreign_file(Path('cloud.las'))
    elif not {'x', 'y', 'z', 'radius'} <= elements['vertex'][1].keys():
        what = 'a skeleton without radii'
        cure = 'give each vertex a property radius [m], beside x, y and z'
    elif len(elements['edge'][1]) < 2:
        what, cure = 'edges without two vertices', 'give each edge vertex1 and vertex2'
    else:
        return
    raise FormatError(f'{what}, not a tree', cure=cure)


def _tables(data: bytes, order: str, elements: Elements) -> dict[str, Floats]:
    """Values of each element, (rows, values), up to the edges."""
    tables: dict[str, Floats] = {}
    cells = [] if order else data.split()
    begin = 0
    for name, (count, types) in elements.items():
        kind = np.dtype([(each, order + of) for each, of in types.items()])
        if not 0 <= count <= len(data):
            raise ValueError('count')
        if order:
            tables[name] = structured_to_unstructured(
                np.frombuffer(data, kind, count, begin), np.float64
            )
            begin += count * kind.itemsize
        else:
            end = begin + count * len(types)
            tables[name] = np.array(cells[begin:end], np.float64).reshape(count, len(types))
            begin = end
        if name == 'edge' and 'n' in types and (tables[name][:, 0] != 2.0).any():
            raise ValueError('list')
        if {'vertex', 'edge'} <= tables.keys():
            break
    return tables


FORMAT = FileFormat('ply', (), contains(r'\A[p]ly\s*\n'), _read, FITTED)
