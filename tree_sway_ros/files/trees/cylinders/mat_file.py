"""
Variables of a MATLAB file, read by scipy (versions 4 to 7) or h5py (7.3) within known bounds.

A few bytes can claim gigabytes, nest without end or point to other files; so what a file claims is
held against its own size before a library acts on it. Source of the layout: MathWorks, MAT-File
Format (level 5), chapter 1.

"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.text_file import MAX_BYTES, read_bytes

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_HOLDERS = (1, 2, 3)
"""Classes of arrays that hold arrays: cell, struct, object."""
_MAX_DEPTH = 8
_DEFLATE = 1032
"""The most that deflate can shrink, so that no file holds more than this times its size."""

Variables = dict[str, Any]
"""Arrays by name; structs as dictionaries, several of them in a list."""


def looks_like_mat(head: str) -> bool:
    """Whether the beginning of a file is that of a MATLAB file."""
    return head.startswith(("MATLAB", "\ufffdHDF\r\n\x1a\n"))


def read_mat(path: Path) -> Variables:
    """
    Read the variables of a MATLAB file.

    Returns
    -------
    dict
        Numbers as arrays; a struct as a dictionary of such values, an array of structs as a list.

    Raises
    ------
    FormatError
        Not a MATLAB file, damaged, or claiming more than it can hold.
    MissingDependencyError
        If it is of version 7.3 and h5py is not installed.

    """
    head = read_bytes(path, at_most=_HEADER)
    is_hdf5 = b"HDF\r\n" in head[:8] or head.startswith(b"MATLAB 7.3")
    # Damaged files fail in many ways, each of them the file's fault.
    try:
        if is_hdf5:
            return _hdf5_variables(path)
        content = loadmat(io.BytesIO(_unpacked(read_bytes(path))), chars_as_strings=False)
        return {name: _plain(value, 0) for name, value in content.items() if name[:2] != "__"}
    except (FormatError, MissingDependencyError) as error:
        if error.where:
            raise
        what = f"not a MATLAB file that can be read: {error.what}"
        raise FormatError(what, where=str(path), cure="save it anew") from None
    except Exception as error:
        raise FormatError(
            f"not a MATLAB file that can be read: {type(error).__name__}: "
            f"{' '.join(str(error).split())}"[:200],
            where=str(path),
            cure="save it anew",
        ) from error


def numbers(value: Any, name: str) -> Floats:
    """
    Return a variable as numbers, without axes of length 1.

    Raises
    ------
    FormatError
        If it is none.

    """
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiub":
        raise FormatError(f"'{name}' is not numeric")
    return value.astype(np.float64).squeeze()


def _plain(value: Any, depth: int) -> Any:
    """Structs and cells of scipy's as dictionaries and lists."""
    if depth > _MAX_DEPTH or not isinstance(value, np.ndarray):
        return None
    if value.dtype.names:
        structs = [
            {name: _plain(one[name], depth + 1) for name in value.dtype.names}
            for one in value.ravel(order="F")
        ]
        return structs[0] if len(structs) == 1 else structs
    if value.dtype == object:
        return [_plain(one, depth + 1) for one in value.ravel(order="F")]
    return value


def _unpacked(content: bytes) -> bytes:
    """Return the same file with its variables unpacked, each checked by `_check_claims`."""
    order = {b"IM": "<", b"MI": ">"}.get(content[126:_HEADER])
    if order is None:
        raise FormatError("no header of a MATLAB file of version 5 to 7")
    plain, at, left = [content[:_HEADER]], _HEADER, MAX_BYTES
    while at < len(content):
        kind, body, at = _element(content, at, len(content), order, is_top=True)
        unpacked = content[body.start - 8 : body.stop]
        if kind == _COMPRESSED:
            engine = zlib.decompressobj()
            unpacked = engine.decompress(content[body.start : body.stop], left)
            if engine.unconsumed_tail:
                raise FormatError(f"variables larger than {MAX_BYTES >> 20} MiB")
        left -= len(unpacked)
        kind, body, _ = _element(unpacked, 0, len(unpacked), order)
        if kind == _MATRIX:
            _check_claims(unpacked, body, order, 0)
            plain.append(unpacked[: body.stop])
    return b"".join(plain)


def _element(
    data: bytes, at: int, end: int, order: str, *, is_top: bool = False
) -> tuple[int, range, int]:
    """Type and place of the data element that begins at a byte, and where the next one begins."""
    if at + 8 > end:
        raise FormatError("it ends in the middle of an element")
    kind, length = struct.unpack_from(order + "II", data, at)
    if kind >> 16:  # a small element has its length in the upper half, and its content in the tag
        kind, length = kind & 0xFFFF, kind >> 16
        body, following = range(at + 4, at + 4 + length), at + 8
    else:
        body = range(at + 8, at + 8 + length)
        following = body.stop if is_top or kind == _COMPRESSED else at + 8 + -(-length // 8) * 8
    if body.stop > min(end, following):
        raise FormatError("an element is longer than the file")
    return kind, body, following


def _check_claims(data: bytes, body: range, order: str, depth: int) -> None:
    """Refuse an array of more elements than it has bytes, and one that is nested too deep."""
    if depth > _MAX_DEPTH:
        raise FormatError(f"nested deeper than {_MAX_DEPTH}")
    if not body:
        return
    _, flags, at = _element(data, body.start, body.stop, order)
    _, shape, at = _element(data, at, body.stop, order)
    size = 1
    for length in struct.unpack_from(f"{order}{len(shape) // 4}i", data, shape.start):
        size *= length
        # A negative length, or so many elements that the array's own bytes cannot hold them.
        if length < 0 or size > len(body):
            raise FormatError(f"an array of {size} elements in {len(body)} bytes")
    if len(flags) < 4:
        raise FormatError("an array without flags")
    _, _, at = _element(data, at, body.stop, order)
    word = struct.unpack_from(order + "I", data, flags.start)[0]
    if word & 0xFF not in _HOLDERS:
        return
    while at < body.stop:
        kind, inner, at = _element(data, at, body.stop, order)
        if kind == _MATRIX:
            _check_claims(data, inner, order, depth + 1)


def _hdf5_variables(path: Path) -> Variables:
    try:
        import h5py
    except ImportError as error:
        raise MissingDependencyError(
            "a MATLAB file of version 7.3 needs h5py",
            where=str(path),
            cure="pip install h5py, or save it with the option -v7",
        ) from error
    left = [min(MAX_BYTES, _DEFLATE * path.stat().st_size)]
    with h5py.File(path, "r") as file:
        return {name: _hdf5_value(h5py, each, left, 0) for name, each in _members(h5py, file)}


def _members(h5py: Any, group: Any) -> Iterator[tuple[str, Any]]:
    """Members of a group that stand in this file."""
    for name in group:
        if name[0] != "#" and isinstance(group.get(name, getlink=True), h5py.HardLink):
            yield name, group[name]


def _hdf5_value(h5py: Any, each: Any, left: list[int], depth: int) -> Any:
    """Return a dataset, group or references to groups; `left` bytes may still be read of the file."""
    if depth > _MAX_DEPTH:
        raise FormatError(f"nested deeper than {_MAX_DEPTH}")
    if isinstance(each, h5py.Group):
        left[0] -= 64 * len(each)
        if left[0] < 0:
            raise FormatError("more groups than the file can hold")
        return {n: _hdf5_value(h5py, one, left, depth + 1) for n, one in _members(h5py, each)}
    if not isinstance(each, h5py.Dataset) or each.dtype.kind not in "fiubO" or not each.shape:
        return None
    if each.external or each.is_virtual:
        raise FormatError(f"{each.name} is stored in another file")
    left[0] -= 8 * each.size
    if left[0] < 0:
        raise FormatError(f"{each.name} has {each.size} values, more than the file can hold")
    if each.dtype.kind != "O":
        return np.transpose(each[()])  # MATLAB's columns are HDF5's rows
    if h5py.check_ref_dtype(each.dtype) is not h5py.Reference:
        return None
    return [_hdf5_value(h5py, each.file[one], left, depth + 1) for one in np.ravel(each[()]) if one]
