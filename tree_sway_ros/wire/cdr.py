# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages as bytes: serialised once by rclpy, then their numbers overwritten in place.

Making 1000 Python Pose objects per frame costs 400 times as much as copying their bytes. So a
message of the right size is serialised once, with sentinels at its stamps and numbers; the
sentinels are found in the bytes, for any layout, and become array views. Every float64 of CDR lies
8-aligned from byte 4 on; the buffer is shifted so that the views are aligned in memory as well.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.errors import TransportError

_LITTLE_ENDIAN = 1
_HEADER = 4
"""Size of the encapsulation header [bytes]; alignment is counted from its end."""
_NAME = _HEADER + 8
"""Offset of the size of a frame's name, after the header's stamp."""
_POSE = 7 * 8
"""Size of a pose [bytes]."""
# Patterns that no other field of a message has: both numbers of a stamp, and a number's value.
# They are longer than the gaps between fields, where the serialiser leaves old bytes.
_STAMP = 0x5EC0_0000
_NUMBER = struct.unpack('<d', bytes.fromhex('0000c3d2e1f05a41'))[0]


class CdrTemplate:
    """
    The bytes of one message, with its stamps and float64 blocks as views.

    Parameters
    ----------
    message
        A ROS message, whose stamps `mark_stamp` has set, and whose blocks begin with `block_mark`.
    n_stamps
        Number of marked stamps, with numbers 0 .. n_stamps - 1.
    shapes
        Shape of each marked block, in the order of their numbers; an empty block needs no mark.
    tail
        Bytes of the message after its last block, where the serialiser adds padding that strict
        readers refuse; None to keep all.

    Raises
    ------
    TransportError
        If a mark is not found exactly once, or the machine does not write little endian.

    """

    def __init__(
        self,
        message: Any,
        n_stamps: int,
        shapes: Sequence[tuple[int, ...]],
        *,
        tail: int | None = None,
    ) -> None:
        from rclpy.serialization import serialize_message

        data = bytes(serialize_message(message))
        if data[1] != _LITTLE_ENDIAN:
            raise TransportError('the middleware writes big endian messages')
        if tail is not None:
            last = len(shapes) - 1
            size = 8 * math.prod(shapes[last])
            data = data[: _find(data, struct.pack('<d', _NUMBER + last)) + size + tail]
        self._size = len(data)
        backing = np.zeros(self._size + 8, dtype=np.uint8)
        # Byte 4 of the message at a multiple of 8 in memory.
        self._shift = -(backing.ctypes.data + 4) % 8
        self._buffer = backing[self._shift : self._shift + self._size]
        self._buffer[:] = np.frombuffer(data, dtype=np.uint8)
        self._stamps = [
            self._view(_find(data, 2 * struct.pack('<i', _STAMP + i)), np.int32, (2,))
            for i in range(n_stamps)
        ]
        self.blocks: list[NDArray[np.float64]] = [
            np.zeros(shape)
            if 0 in shape
            else self._view(_find(data, struct.pack('<d', _NUMBER + i)), np.float64, shape)
            for i, shape in enumerate(shapes)
        ]
        for block in self.blocks:
            block[...] = 0.0

    def to_bytes(self, stamp: int = 0) -> bytes:
        """Return the message as bytes for a publisher of rclpy; its stamps are a time in [ns]."""
        second, nanosecond = divmod(stamp, 1_000_000_000)
        for view in self._stamps:
            view[0] = second
            view[1] = nanosecond
        return self._buffer.tobytes()

    def _view(self, offset: int, kind: type, shape: tuple[int, ...]) -> NDArray[Any]:
        return np.ndarray(shape, dtype=kind, buffer=self._buffer, offset=offset)


def mark_stamp(stamp: Any, number: int = 0) -> None:
    """Mark a ``builtin_interfaces/Time`` as the stamp of that number."""
    stamp.sec = stamp.nanosec = _STAMP + number


def stamp_of(data: bytes) -> int:
    """Stamp of a serialised message that begins with a header, in [ns]."""
    second, nanosecond = struct.unpack_from('<iI', data, 4)
    return int(second * 1_000_000_000 + nanosecond)


def poses_of(data: bytes) -> NDArray[np.float64] | None:
    """
    Poses of a serialised ``geometry_msgs/PoseArray``, x y z qx qy qz qw, (n, 7).

    None for bytes that end before the poses do.
    """
    try:
        (name_size,) = struct.unpack_from('<I', data, _NAME)
        at = _aligned(_NAME + 4 + name_size, 4)
        (count,) = struct.unpack_from('<I', data, at)
    except struct.error:
        return None
    begin = _aligned(at + 4, 8)
    if len(data) < begin + _POSE * count:
        return None
    return np.frombuffer(data, np.float64, 7 * count, begin if count else 0).reshape(count, 7)


def _aligned(offset: int, size: int) -> int:
    """Return the next multiple of a size, counted from the end of the encapsulation header."""
    return offset + (_HEADER - offset) % size


def block_mark(number: int = 0) -> float:
    """Return the value for the first field of the float64 block of that number."""
    return float(_NUMBER + number)


def pose_array_template(n_poses: int, frame_id: str) -> CdrTemplate:
    """Bytes of a ``geometry_msgs/PoseArray``, whose block (n_poses, 7) has x y z qx qy qz qw."""
    from geometry_msgs.msg import Pose, PoseArray

    message = PoseArray()
    message.header.frame_id = frame_id
    mark_stamp(message.header.stamp)
    if n_poses:
        # The same object many times: only its numbers are written, once each.
        first = Pose()
        other = Pose()
        first.position.x = block_mark()
        message.poses = [first] + [other] * (n_poses - 1)
    return CdrTemplate(message, 1, [(n_poses, 7)])


def _find(data: bytes, pattern: bytes) -> int:
    offset = data.find(pattern)
    if offset < 0 or data.find(pattern, offset + 1) >= 0:
        raise TransportError('a message has an unexpected layout')
    return offset
