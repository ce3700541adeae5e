# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A glTF 2.0 document under construction: JSON, and the bytes of its accessors."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

_COMPONENTS = {
    'int8': 5120,
    'uint8': 5121,
    'uint16': 5123,
    'uint32': 5125,
    'float32': 5126,
}
_SHAPES = {1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4', 16: 'MAT4'}
_SAMPLER = {'magFilter': 9729, 'minFilter': 9987, 'wrapS': 10497, 'wrapT': 10497}
"""Linear, between small copies of a picture too, which goes on beyond its edges."""
ARRAY_BUFFER = 34962
ELEMENT_ARRAY_BUFFER = 34963


class GltfDocument:
    """A document of one scene to which objects and arrays are added."""

    def __init__(self) -> None:
        """Begin with an empty document."""
        asset = {'version': '2.0', 'generator': 'tree_sway'}
        self._json: dict[str, Any] = {'asset': asset, 'scene': 0, 'samplers': [_SAMPLER]}
        self._bytes = bytearray()

    def add(self, kind: str, **properties: Any) -> int:
        """Add an object to a list such as ``nodes``, without fields of None; return its number."""
        objects: list[dict[str, Any]] = self._json.setdefault(kind, [])
        objects.append({name: value for name, value in properties.items() if value is not None})
        return len(objects) - 1

    def set(self, **properties: Any) -> None:  # noqa: A003
        """Set properties of the document itself."""
        self._json.update(properties)

    def add_array(
        self,
        array: NDArray[Any],
        *,
        target: int | None = None,
        bounds: bool = False,
        is_share: bool = False,
    ) -> int:
        """
        Add an array as an accessor and return its number.

        It is (n,), (n, 2), (n, 3), (n, 4), or matrices by columns (n, 4, 4); for `ARRAY_BUFFER`
        (vertices) or `ELEMENT_ARRAY_BUFFER` (indices). Bounds are written for positions and times;
        shares are stored as integers.
        """
        columns = array.reshape(len(array), -1)
        rows = columns.astype(columns.dtype.newbyteorder('<'), order='C')
        stride = None
        if target == ARRAY_BUFFER and rows.strides[0] % 4:  # vertices begin at multiples of 4
            missing = -rows.strides[0] % 4 // rows.itemsize
            rows = np.pad(rows, ((0, 0), (0, missing)))
            stride = rows.strides[0]
        return self.add(
            'accessors',
            bufferView=self._add_bytes(rows.tobytes(), byteStride=stride, target=target),
            componentType=_COMPONENTS[array.dtype.name],
            normalized=is_share or None,
            count=len(array),
            type=_SHAPES[columns.shape[1]],
            min=columns.min(axis=0).tolist() if bounds else None,
            max=columns.max(axis=0).tolist() if bounds else None,
        )

    def add_picture(self, name: str, png: bytes) -> int:
        """Add a PNG that goes on beyond its edges as a texture and return its number."""
        view = self._add_bytes(png)
        image = self.add('images', name=name, mimeType='image/png', bufferView=view)
        return self.add('textures', source=image, sampler=0)

    def _add_bytes(self, data: bytes, **properties: int | None) -> int:
        """Add a view of bytes, filled up to a multiple of 4, and return its number."""
        begin = len(self._bytes)
        self._bytes += data + b'\0' * (-len(data) % 4)
        return self.add(
            'bufferViews', buffer=0, byteOffset=begin, byteLength=len(data), **properties
        )

    def glb(self) -> bytes:
        """Return the document in the binary form."""
        buffers = [{'byteLength': len(self._bytes)}]
        text = json.dumps({**self._json, 'buffers': buffers}, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        chunks = b''
        for kind, data in ((b'JSON', text), (b'BIN\0', self._bytes)):
            chunks += struct.pack('<I4s', len(data), kind) + data
        return struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks
