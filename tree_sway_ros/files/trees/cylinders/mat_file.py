# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Variables of a MATLAB file, read by scipy (versions 4 to 7) or h5py (7.3) within known bounds.

A few bytes can claim gigabytes, nest without end or point to other files; so what a file claims is
held against its own size before a library acts on it. Source of the layout: MathWorks, MAT-File
Format (level 5), chapter 1.
"""

from __future__ import annotations

from collections.abc import Iterator
import io
from pathlib import Path
import struct
from typing import Any
import zlib

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.text_file import MAX_BYTES, read_bytes, reason_of

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_CELL, _STRUCT, _OBJECT, _TEXT, _NUMERIC = 1, 2, 3, 4, range(6, 16)
_BYTES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8}
"""Bytes of a number of each type."""
_TEXT_TYPES = (2, 4, 16, 17, 18)
_MAX_NAME = 4096
_MAX_DEPTH = 8
_DEFLATE = 1032
"""The most that deflate can shrink, so that no file holds more than this times its size."""

Variables = dict[str, Any]
"""Arrays by name; structs as dictionaries, several of them in a list."""


def looks_like_mat(head: str) -> bool:
    """Whether the beginning of a file is that of a MATLAB file."""
    return head.startswith(('MATLAB', '\ufffdHDF\r\n\x1a\n'))


def read_mat(path: Path) -> Variables:
    """
    Read the variables of a MATLAB file: arrays of numbers, dictionaries of structs, and lists.

    Raises
    ------
    FormatError
        Not a MATLAB file, damaged, or claiming more than it can hold.
    MissingDependencyError
        If it is of version 7.3 and h5py is not installed.

    """
    head = read_bytes(path, at_most=_HEADER)
    is_hdf5 = b'HDF\r\n' in head[:8] or head.startswith(b'MATLAB 7.3')
    # Damaged files fail in many ways, each of them the file's fault.
    try:
        if is_hdf5:
            return _hdf5_variables(path)
        from scipy.io import loadmat  # it takes long to load, and only these files need it

        content = loadmat(io.BytesIO(_unpacked(read_bytes(path))), chars_as_strings=False)
        return {name: _plain(value, 0) for name, value in content.items() if name[:2] != '__'}
    except (FormatError, MissingDependencyError) as error:
        if error.where:
            raise
        what = f'not a MATLAB file that can be read: {error.what}'
        raise FormatError(what, where=str(path), cure='save it anew') from None
    except Exception as error:
        raise FormatError(
            f'not a MATLAB file that can be read: {reason_of(error)}',
            where=str(path),
            cure='save it anew',
        ) from error


def numbers(value: Any, name: str) -> Floats:
    """Return a variable as numbers, without axes of length 1; a `FormatError` if it is none."""
    if not isinstance(value, np.ndarray) or value.dtype.kind not in 'fiub':
        raise FormatError(f"'{name}' is not numeric")
    return value.astype(np.float64).squeeze()


def _plain(value: Any, depth: int) -> Any:
    """Structs and cells of scipy's as dictionaries and lists."""
    if depth > _MAX_DEPTH or not isinstance(value, np.ndarray):
        return None
    if value.dtype.names:
        structs = [
            {name: _plain(one[name], depth + 1) for name in value.dtype.names}
            for one in value.ravel(order='F')
        ]
        return structs[0] if len(structs) == 1 else structs
    if value.dtype == object:
        return [_plain(one, depth + 1) for one in value.ravel(order='F')]
    return value


def _unpacked(content: bytes) -> bytes:
    """Return the same file with its variables unpacked, each as of `_readable`."""
    order = {b'IM': '<', b'MI': '>'}.get(content[126:_HEADER])
    if order is None:
        raise FormatError('no header of a MATLAB file of version 5 to 7')
    plain, at, left = [content[:_HEADER]], _HEADER, MAX_BYTES
    while at < len(content):
        kind, body, at = _element(content, at, len(content), order, is_top=True)
        unpacked = content[body.start - 8 : body.stop]
        if kind == _COMPRESSED:
            engine = zlib.decompressobj()
            unpacked = engine.decompress(content[body.start : body.stop], left)
            if engine.unconsumed_tail:
                raise FormatError(f'variables larger than {MAX_BYTES >> 20} MiB')
        left -= len(unpacked)
        kind, body, _ = _element(unpacked, 0, len(unpacked), order)
        variable = _readable(unpacked, body, order, 0) if kind == _MATRIX else b''
        plain.append(variable if len(variable) > 8 else b'')
    return b''.join(plain)


def _element(
    data: bytes, at: int, end: int, order: str, *, is_top: bool = False
) -> tuple[int, range, int]:
    """Type and place of the data element that begins at a byte, and where the next one begins."""
    if at + 8 > end:
        raise FormatError('it ends in the middle of an element')
    kind, length = struct.unpack_from(order + 'II', data, at)
    if kind >> 16:  # a small element has its length in the upper half, and its content in the tag
        kind, length = kind & 0xFFFF, kind >> 16
        body, following = range(at + 4, at + 4 + length), at + 8
    else:
        body = range(at + 8, at + 8 + length)
        following = body.stop if is_top or kind == _COMPRESSED else at + 8 + -(-length // 8) * 8
    if body.stop > min(end, following):
        raise FormatError('an element is longer than the file')
    return kind, body, following


def _readable(data: bytes, body: range, order: str, depth: int) -> bytes:
    """
    Return an array, an empty one in place of each that is neither numbers, text, cell nor struct.

    A damaged one, on which scipy may end the process, is refused.
    """
    if depth > _MAX_DEPTH:
        raise FormatError(f'nested deeper than {_MAX_DEPTH}')
    if not body:
        return struct.pack(order + 'II', _MATRIX, 0)
    kind, flags, at = _element(data, body.start, body.stop, order)
    if (kind, len(flags), at - flags.start) != (6, 8, 8):
        raise FormatError('an array without flags')
    word = struct.unpack_from(order + 'I', data, flags.start)[0]
    of_class, parts = word & 0xFF, 2 if word & 0x800 else 1  # a complex array has two parts
    _, shape, at = _element(data, at, body.stop, order)
    size = 1
    for length in struct.unpack_from(f'{order}{len(shape) // 4}i', data, shape.start):
        size *= length
        # A negative length, or so many elements that the array's own bytes cannot hold them.
        if length < 0 or size > len(body):
            raise FormatError(f'an array of {size} elements in {len(body)} bytes')
    _, _, at = _element(data, at, body.stop, order)
    inside = list[tuple[int, range]]()
    while at < body.stop:
        kind, part, at = _element(data, at, body.stop, order)
        inside.append((kind, part))
    if of_class in _NUMERIC:
        of_type = [
            _BYTES.get(kind, 0) * size == len(part) and kind in _BYTES for kind, part in inside
        ]
        if of_type != [True] * parts:
            raise FormatError(f'numbers that are not {size} of a known type')
    elif of_class == _TEXT:
        if [kind in _TEXT_TYPES for kind, _ in inside] != [True]:
            raise FormatError('a text of no known type')
    elif of_class not in (_CELL, _STRUCT, _OBJECT):
        return struct.pack(order + 'II', _MATRIX, 0)
    else:
        return _readable_holder(data, body, order, depth, (of_class, size), inside)
    return struct.pack(order + 'II', _MATRIX, len(body)) + data[body.start : body.stop]


def _readable_holder(
    data: bytes,
    body: range,
    order: str,
    depth: int,
    claim: tuple[int, int],
    inside: list[tuple[int, range]],
) -> bytes:
    """Return a cell array or struct of readable arrays; see `_readable`."""
    of_class, size = claim
    first = {_CELL: 0, _STRUCT: 2, _OBJECT: 3}[of_class]
    if first and len(inside) >= first:
        (_, width), (_, names) = inside[first - 2 : first]
        length = struct.unpack_from(order + 'I', data, width.start)[0] if len(width) == 4 else 0
        size *= len(names) // length if 0 < length <= _MAX_NAME else -1
    if [kind for kind, _ in inside[first:]] != [_MATRIX] * size:
        raise FormatError(f'a cell array or struct of {len(inside) - first} arrays, not {size}')
    head = data[body.start : inside[first][1].start - 8] if size else data[body.start : body.stop]
    arrays = [_readable(data, part, order, depth + 1) for _, part in inside[first:]]
    content = b''.join([head, *arrays])
    return struct.pack(order + 'II', _MATRIX, len(content)) + content


def _hdf5_variables(path: Path) -> Variables:
    try:
        import h5py
    except ImportError as error:
        raise MissingDependencyError(
            'a MATLAB file of version 7.3 needs h5py',
            where=str(path),
            cure='pip install h5py, or save it with the option -v7',
        ) from error
    left = [min(MAX_BYTES, _DEFLATE * path.stat().st_size)]
    with h5py.File(path, 'r') as file:
        return {name: _hdf5_value(h5py, each, left, 0) for name, each in _members(h5py, file)}


def _members(h5py: Any, group: Any) -> Iterator[tuple[str, Any]]:
    """Members of a group that stand in this file."""
    for name in group:
        if name[0] != '#' and isinstance(group.get(name, getlink=True), h5py.HardLink):
            yield name, group[name]


def _hdf5_value(h5py: Any, each: Any, left: list[int], depth: int) -> Any:
    """Return a dataset, group or references to groups; `left` bytes may still be read."""
    if depth > _MAX_DEPTH:
        raise FormatError(f'nested deeper than {_MAX_DEPTH}')
    if isinstance(each, h5py.Group):
        left[0] -= 64 * len(each)
        if left[0] < 0:
            raise FormatError('more groups than the file can hold')
        return {n: _hdf5_value(h5py, one, left, depth + 1) for n, one in _members(h5py, each)}
    if not isinstance(each, h5py.Dataset) or each.dtype.kind not in 'fiubO' or not each.shape:
        return None
    if each.external or each.is_virtual:
        raise FormatError(f'{each.name} is stored in another file')
    left[0] -= 8 * each.size
    if left[0] < 0:
        raise FormatError(f'{each.name} has {each.size} values, more than the file can hold')
    if each.dtype.kind != 'O':
        return np.transpose(each[()])  # MATLAB's columns are HDF5's rows
    if h5py.check_ref_dtype(each.dtype) is not h5py.Reference:
        return None
    return [
        _hdf5_value(h5py, each.file[one], left, depth + 1) for one in np.ravel(each[()]) if one
    ]
