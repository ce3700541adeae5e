# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A sample of wind as CDR bytes of ``geometry_msgs/Vector3Stamped``, read and written without ROS.

The bytes are those that a Zenoh bridge of ROS 2 carries, so that it may be at either end.
"""

from __future__ import annotations

import struct

from tree_sway.errors import FormatError

_HEAD = b'\0\1\0\0'  # CDR, little endian
_STAMP = struct.Struct('<iII')
_VECTOR = struct.Struct('<3d')
_SECOND = 1_000_000_000


def encode_wind(stamp: int, vector: tuple[float, float, float], frame_id: str = 'map') -> bytes:
    """Write a sample of a time [ns] in [m/s]."""
    name = frame_id.encode() + b'\0'
    body = _STAMP.pack(*divmod(stamp, _SECOND), len(name)) + name
    return _HEAD + body + bytes(-len(body) % 8) + _VECTOR.pack(*vector)


def decode_wind(data: bytes) -> tuple[int, tuple[float, float, float]]:
    """Read a sample: its time [ns] and vector [m/s]; a `FormatError` if the bytes hold none."""
    try:
        second, nanosecond, length = _STAMP.unpack_from(data, len(_HEAD))
        begin = _STAMP.size + length
        x, y, z = _VECTOR.unpack_from(data, len(_HEAD) + begin + -begin % 8)
    except struct.error as error:
        raise FormatError(f'{len(data)} bytes that hold no wind ({error})') from error
    if data[:2] != _HEAD[:2] or nanosecond >= _SECOND:
        raise FormatError('a wind that is not little endian, or at no time')
    return second * _SECOND + nanosecond, (x, y, z)
