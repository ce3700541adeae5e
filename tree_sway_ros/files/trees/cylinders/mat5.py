"""
Variables of a MATLAB file of version 5 to 7, read in Python alone.

A damaged file can crash a reader in C along with the process; here the worst is an error. Numeric
arrays, structs and arrays of structs are read, each only when it is asked for; what else a file may
hold is passed over. Source: MathWorks, MAT-File Format (level 5), chapter 1.

"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import FormatError
from tree_sway_ros.files.text_file import MAX_BYTES

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {
    1: "i1",
    2: "u1",
    3: "i2",
    4: "u2",
    5: "i4",
    6: "u4",
    7: "f4",
    9: "f8",
    12: "i8",
    13: "u8",
}
_CELL, _STRUCT, _OBJECT, _NUMERIC = 1, 2, 3, range(6, 16)


@dataclass(frozen=True, slots=True)
class MatArray:
    """
    A variable or field, as its bytes.

    Parameters
    ----------
    name
        Name of the variable or field.
    kind
        Its class in the format: 1 cell array, 2 struct, 6 to 15 numeric.
    shape
        Its dimensions.
    order
        ``<`` or ``>``: the order of bytes.
    data
        What follows the name.

    """

    name: str
    kind: int
    shape: tuple[int, ...]
    order: str
    data: memoryview

    def numbers(self) -> Floats:
        """
        Values of a numeric array.

        Raises
        ------
        FormatError
            If it is not numeric, or damaged.

        """
        if self.kind not in _NUMERIC:
            raise FormatError(f"'{self.name}' is not numeric")
        kind, values, _ = _element(self.data, self.order)
        if kind not in _NUMBERS or len(values) % int(_NUMBERS[kind][1]):
            raise FormatError("numbers of no known type")
        array = np.frombuffer(values, dtype=self.order + _NUMBERS[kind]).astype(np.float64)
        if array.size != _size(self.shape):
            raise FormatError(f"{array.size} values for the shape {self.shape}")
        return array.reshape(self.shape, order="F")

    def structs(self) -> Iterator[dict[str, MatArray]]:
        """
        Fields of each struct in an array of structs or a cell array; nothing if it is neither.

        Raises
        ------
        FormatError
            If it is damaged.

        """
        if self.kind == _CELL:
            for cell in self._cells():
                # A cell within a cell is passed over, so that no file can nest without end.
                yield from cell.structs() if cell.kind != _CELL else ()
        if self.kind not in (_STRUCT, _OBJECT):
            return
        data = self.data
        if self.kind == _OBJECT:
            _, _, data = _element(data, self.order)
        _, width, data = _element(data, self.order)
        _, names, data = _element(data, self.order)
        length = int.from_bytes(width[:4], "little" if self.order == "<" else "big")
        if not 0 < length <= 4096:
            raise FormatError(f"field names of {length} bytes")
        fields = [_text(names[i : i + length]) for i in range(0, len(names), length)]
        for _ in range(_size(self.shape) if fields else 0):
            element = {}
            for field in fields:
                kind, content, data = _element(data, self.order)
                if kind != _MATRIX:
                    raise FormatError(f"field '{field}' is no array")
                if len(content):
                    element[field] = replace(_array(content, self.order), name=field)
            yield element

    def _cells(self) -> Iterator[MatArray]:
        data = self.data
        for _ in range(_size(self.shape)):
            kind, content, data = _element(data, self.order)
            if kind == _MATRIX and len(content):
                yield _array(content, self.order)


def read_mat5(content: bytes) -> dict[str, MatArray]:
    """
    Read the variables of a file.

    Raises
    ------
    FormatError
        If it is not of version 5 to 7, or damaged.

    """
    order = {b"IM": "<", b"MI": ">"}.get(content[126:_HEADER])
    if order is None:
        raise FormatError("no header of a MATLAB file of version 5 to 7")
    variables, data = {}, memoryview(content)[_HEADER:]
    while len(data):
        kind, body, data = _element(data, order, is_top=True)
        if kind == _COMPRESSED:
            kind, body, _ = _element(memoryview(_unpacked(body)), order)
        if kind == _MATRIX and len(body):
            array = _array(body, order)
            variables[array.name] = array
    return variables


def _element(
    data: memoryview, order: str, *, is_top: bool = False
) -> tuple[int, memoryview, memoryview]:
    """Type and content of the first data element, and what comes after it."""
    if len(data) < 8:
        raise FormatError("it ends in the middle of an element")
    kind, length = struct.unpack(order + "II", data[:8])
    begin = 8
    if kind >> 16:  # a small element has its length in the upper half, and its content in the tag
        kind, length, begin = kind & 0xFFFF, kind >> 16, 4
    end = begin + length
    if end > (8 if begin == 4 else len(data)):
        raise FormatError("an element is longer than the file")
    if begin == 4:
        following = 8
    else:
        following = end if is_top and kind == _COMPRESSED else -(-end // 8) * 8
    return kind, data[begin:end], data[following:]


def _unpacked(data: memoryview) -> bytes:
    engine = zlib.decompressobj()
    try:
        content = engine.decompress(data, MAX_BYTES)
    except zlib.error as error:
        raise FormatError(f"damaged: {error}") from None
    if engine.unconsumed_tail:
        raise FormatError(f"a variable larger than {MAX_BYTES >> 20} MiB")
    return content


def _array(data: memoryview, order: str) -> MatArray:
    _, flags, data = _element(data, order)
    _, shape, data = _element(data, order)
    _, name, data = _element(data, order)
    if len(flags) < 4 or len(shape) % 4 or len(shape) > 128:
        raise FormatError("an array without flags or shape")
    word = int(np.frombuffer(flags[:4], dtype=order + "u4")[0])
    sizes = tuple(int(size) for size in np.frombuffer(shape, dtype=order + "i4"))
    if any(size < 0 for size in sizes):
        raise FormatError(f"an array of shape {sizes}")
    return MatArray(_text(name), word & 0xFF, sizes, order, data)


def _size(shape: tuple[int, ...]) -> int:
    size = 1
    for length in shape:
        size *= length
    return size


def _text(data: memoryview) -> str:
    return bytes(data).split(b"\0")[0].decode("latin-1")
