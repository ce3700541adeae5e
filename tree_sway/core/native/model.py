# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A model of the native core: its bytes, and the checked model that they give."""

from __future__ import annotations

from collections.abc import Mapping
import ctypes
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.native.library import LIBRARY, Opened, VERSION
from tree_sway.errors import FormatError

_MAGIC = b'SWAYTREE'
_HEADER = struct.Struct('<8sII')
_ENTRY = struct.Struct('<24sII4QQ')
_TYPES = {np.dtype(np.float64): 0, np.dtype(np.float32): 1, np.dtype(np.int64): 2}
_LINE = 64
_ROOM = 300
"""Bytes for an error."""

AT_POSE = 2
"""How a limp tree is stepped, in `Sizes.is_stepped`."""


class Sizes(ctypes.Structure):
    """``sway_sizes`` of the header."""

    _fields_ = tuple(
        (name, ctypes.c_int64)
        for name in ('segments', 'branches', 'keys', 'coordinates', 'delays', 'is_stepped')
    )

    segments: int
    branches: int
    keys: int
    coordinates: int
    delays: int
    is_stepped: int


def bytes_of(arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Return the bytes of a model: its arrays by the names of ``doc/sway_model.md``."""
    entries = []
    contents = []
    offset = _whole_lines(_HEADER.size + _ENTRY.size * len(arrays))
    for name, given in arrays.items():
        array = np.ascontiguousarray(np.atleast_1d(given))
        array = array.astype(array.dtype.newbyteorder('<'), copy=False)
        shape = (*array.shape, 0, 0, 0, 0)[:4]
        kind = _TYPES[array.dtype.newbyteorder('=')]
        entries.append(_ENTRY.pack(name.encode(), kind, array.ndim, *shape, offset))
        contents.append(array.tobytes().ljust(_whole_lines(array.nbytes), b'\0'))
        offset += len(contents[-1])
    header = b''.join([_HEADER.pack(_MAGIC, VERSION, len(arrays)), *entries])
    return b''.join([header.ljust(_whole_lines(len(header)), b'\0'), *contents])


def _whole_lines(size: int) -> int:
    return -(-size // _LINE) * _LINE


class NativeModel:
    """
    A model that the native core has checked.

    Parameters
    ----------
    content
        Bytes of a model, as `bytes_of` returns them.

    Raises
    ------
    FormatError
        Bytes that are no model; the error names the array.

    """

    def __init__(self, content: bytes) -> None:
        error = ctypes.create_string_buffer(_ROOM)
        handle = LIBRARY.sway_model_open(content, len(content), error, _ROOM)
        if not handle:
            cure = 'convert the tree again by tree-sway convert'
            raise FormatError(error.value.decode(), where='model', cure=cure)
        self.opened = Opened(handle, LIBRARY.sway_model_close)
        self.sizes = Sizes()
        LIBRARY.sway_model_sizes(handle, ctypes.byref(self.sizes))
