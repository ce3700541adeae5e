# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures in messages ``sensor_msgs/Image`` and ``CompressedImage``, to arrays in grey."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.errors import FormatError

_ENCODINGS = {
    'mono8': (1, ''),
    'bgr8': (3, 'COLOR_BGR2GRAY'),
    'rgb8': (3, 'COLOR_RGB2GRAY'),
    'bgra8': (4, 'COLOR_BGRA2GRAY'),
    'rgba8': (4, 'COLOR_RGBA2GRAY'),
}
"""Bytes of a pixel of each encoding, and the name of its conversion."""

_LARGEST = 1 << 26
"""Largest number of pixels, so that a small message cannot take all memory."""

_PNG, _PNG_END = b'\x89PNG\r\n\x1a\n', b'IEND'
_JPEG, _JPEG_END = b'\xff\xd8', b'\xff\xd9'
_PADDED = 64
"""Bytes at the end of a compressed picture among which its end is sought."""


def picture_from_message(cv2: Any, message: Any) -> Any:
    """
    Return the picture of a message in grey, (high, wide).

    Parameters
    ----------
    cv2
        The module of OpenCV.
    message
        An ``Image`` or a ``CompressedImage``.

    Raises
    ------
    FormatError
        Another encoding, a size that does not fit the data, or data that are cut off.

    """
    if not hasattr(message, 'encoding'):
        return _decompressed(cv2, bytes(message.data))
    if message.encoding not in _ENCODINGS:
        known = ', '.join(_ENCODINGS)
        raise FormatError(f"encoding '{message.encoding}'", cure=f'publish one of {known}')
    depth, conversion = _ENCODINGS[message.encoding]
    high, wide, step = message.height, message.width, message.step
    _refuse_size(wide, high)
    if step < depth * wide or len(message.data) != step * high:
        what = f'{wide} x {high} pixels of {message.encoding} in {len(message.data)} bytes'
        raise FormatError(f'{what}, with a step of {step}')
    rows = np.frombuffer(message.data, dtype=np.uint8).reshape(high, step)[:, : depth * wide]
    if not conversion:
        return np.ascontiguousarray(rows)
    colors = np.ascontiguousarray(rows).reshape(high, wide, depth)
    return cv2.cvtColor(colors, getattr(cv2, conversion))


def _decompressed(cv2: Any, data: bytes) -> Any:
    """Return the picture of a file in grey."""
    end = _PNG_END if data.startswith(_PNG) else _JPEG_END
    if not data.startswith((_PNG, _JPEG)):
        raise FormatError('neither JPEG nor PNG', cure='publish one of both')
    if end not in data[-_PADDED:]:
        raise FormatError(f'a picture that is cut off after {len(data)} bytes')
    _refuse_size(*(_size_of_png if end == _PNG_END else _size_of_jpeg)(data))
    try:
        picture = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)
    except cv2.error:
        picture = None
    if picture is None:
        raise FormatError(f'{len(data)} bytes that are no picture')
    return picture


def _refuse_size(wide: int, high: int) -> None:
    if not 0 < wide * high <= _LARGEST:
        raise FormatError(f'a picture of {wide} x {high} pixels')


def _size_of_png(data: bytes) -> tuple[int, int]:
    """Width and height of a PNG, by its first chunk."""
    return int.from_bytes(data[16:20], 'big'), int.from_bytes(data[20:24], 'big')


def _size_of_jpeg(data: bytes) -> tuple[int, int]:
    """Width and height of a JPEG, by its frame header; 0 without one."""
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        mark = data[at + 1]
        if mark == 0xFF:  # a filling byte
            at += 1
        elif 0xC0 <= mark <= 0xCF and mark not in (0xC4, 0xC8, 0xCC):
            high, wide = (int.from_bytes(data[at + k : at + k + 2], 'big') for k in (5, 7))
            return wide, high
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], 'big')
    return 0, 0
