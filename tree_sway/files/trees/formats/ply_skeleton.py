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
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.foreign_file import foreign_file
from tree_sway.files.text_file import read_bytes
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.rooted import cylinders_of_edges
from tree_sway.files.trees.tree_options import FITTED

_TYPES = {
    'char': 'i1', 'uchar': 'u1', 'short': 'i2', 'ushort': 'u2', 'int': 'i4', 'uint': 'u4',
    'float': 'f4', 'double': 'f8', 'int8': 'i1', 'uint8': 'u1', 'int16': 'i2', 'uint16': 'u2',
    'int32': 'i4', 'uint32': 'u4', 'float32': 'f4', 'float64': 'f8',
}  # fmt: skip
_ORDERS = {'ascii': '', 'binary_little_endian': '<', 'binary_big_endian': '>'}
_HEAD = 65_536
"""Bytes in which the header ends."""
_AGAIN = 'save it again as PLY'
Properties = list[tuple[str, str]]
Elements = dict[str, tuple[int, Properties]]


def _read(path: Path) -> tuple[Cylinders, ...]:
    """Tree of a skeleton."""
    data = read_bytes(path)
    try:
        order, elements, body = _header(data)
    except (ValueError, LookupError, IndexError, UnicodeDecodeError):
        raise FormatError('a damaged header of PLY', cure=_AGAIN) from None
    _refuse_others(elements)
    try:
        tables = _tables(data[body:], order, elements)
    except (ValueError, OverflowError, MemoryError):
        raise FormatError('other vertices or edges than its header says', cure=_AGAIN) from None
    names = [name for name, _ in elements['vertex'][1]]
    point = tables['vertex'][:, [names.index(axis) for axis in 'xyz']]
    radius = tables['vertex'][:, names.index('radius')]
    for row in np.flatnonzero(~np.isfinite(point.sum(axis=1) + radius))[:1]:
        raise FormatError(
            'a place or a radius that is no number',
            where=f'vertex {row}',
            cure='remove it and its edges',
        )
    edges = tables['edge'][:, -2:].astype(np.int64)
    return (cylinders_of_edges(point, edges, radius, of_nodes=True),)


def _header(data: bytes) -> tuple[str, Elements, int]:
    """Return order of bytes, elements by name, and where their values begin."""
    end = data.index(b'end_header', 0, _HEAD)
    order = ''
    elements: Elements = {}
    for line in data[:end].decode('ascii', 'replace').splitlines():
        words = line.split()
        if words[:1] == ['format']:
            order = _ORDERS[words[1]]
        elif words[:1] == ['element']:
            elements[words[1]] = int(words[2]), []
        elif words[:1] == ['property']:
            own = [*elements.values()][-1][1]
            if words[1] == 'list':  # of two vertices, if of an edge
                own.append(('n', _TYPES[words[2]]))
                own.extend((f'{words[4]}{number}', _TYPES[words[3]]) for number in (1, 2))
            else:
                own.append((words[2], _TYPES[words[1]]))
    return order, elements, data.index(b'\n', end) + 1


def _refuse_others(elements: Elements) -> None:
    """Name a file that is no skeleton with radii."""
    counts = {name: count for name, (count, _) in elements.items()}
    names = {name for name, _ in elements.get('vertex', (0, []))[1]}
    if not counts.get('vertex'):
        what, cure = 'PLY without vertices', _AGAIN
    elif counts.get('face'):
        what, cure = foreign_file(Path('mesh.ply'))
        cure += ': the skeleton with its radii, or the cylinders'
    elif not counts.get('edge'):
        what, cure = foreign_file(Path('cloud.las'))
    elif not {'x', 'y', 'z', 'radius'} <= names:
        what = 'a skeleton without radii'
        cure = 'give each vertex a property radius [m], beside x, y and z'
    else:
        return
    raise FormatError(f'{what}, not a tree', cure=cure)


def _tables(data: bytes, order: str, elements: Elements) -> dict[str, Floats]:
    """Values of each element, (rows, values), up to the edges."""
    tables: dict[str, Floats] = {}
    rows = [line.split() for line in data.splitlines() if line.strip()] if not order else []
    begin = 0
    for name, (count, properties) in elements.items():
        kind = np.dtype([(f'{at}', order + each) for at, (_, each) in enumerate(properties)])
        if not 0 <= count <= len(data):
            raise ValueError('count')
        if order:
            read: NDArray[np.void] = np.frombuffer(data, kind, count, begin)
            tables[name] = structured_to_unstructured(read, np.float64)
            begin += count * kind.itemsize
        else:
            own = rows[begin : begin + count]
            tables[name] = np.array(own, dtype=np.float64).reshape(count, len(properties))
            begin += count
        if name == 'edge' and len(properties) == 3 and (tables[name][:, 0] != 2.0).any():
            raise ValueError('list')
        if {'vertex', 'edge'} <= tables.keys():
            break
    return tables


FORMAT = FileFormat('ply', (), contains(r'\A[p]ly\s*\n'), _read, FITTED)
