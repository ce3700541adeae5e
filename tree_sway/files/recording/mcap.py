# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The messages of an MCAP file, record by record from its beginning (mcap.dev/spec, version 0).

By hand, as rosbags reads none that a killed recorder left, and unpacks without a limit.
"""

from __future__ import annotations

from collections.abc import Callable
import mmap
from pathlib import Path
import struct
from typing import Any

from tree_sway.errors import FormatError

_MAGIC = b'\x89MCAP0\r\n'
_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _DATA_END = 0x03, 0x04, 0x05, 0x06, 0x0F
_HEAD, _IDS, _MESSAGE_HEAD = struct.Struct('<BQ'), struct.Struct('<HH'), struct.Struct('<HIQQ')
_CHUNK_HEAD = struct.Struct('<QQQI')  # times, size, checksum
_NUMBER, _LONG = struct.Struct('<I'), struct.Struct('<Q')

Note = Callable[[int, bytes], None]


class McapRecords:
    """
    Schemas and channels seen before, and what becomes of messages.

    Parameters
    ----------
    take
        Called with each topic and its type; returns what is called with the time [ns] and the
        bytes of each of its messages, or None for none.
    unpack
        Undoes a compression, by its name.

    """

    def __init__(
        self, take: Callable[[str, str], Note | None], unpack: Callable[[str, bytes], bytes]
    ) -> None:
        self._take, self._unpack = take, unpack
        self._schemas: dict[int, str] = {}
        self._notes: dict[int, Note | None] = {}
        self.is_ended = False

    def read_file(self, path: Path) -> bool:
        """Read a file as far as it goes; returns whether all its messages were there."""
        with (
            path.open('rb') as stream,
            mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data,
            memoryview(data) as view,
            view[len(_MAGIC) :] as rest,
        ):
            self._read(rest)
        return self.is_ended

    def _read(self, view: Any, *, in_chunk: bool = False) -> None:
        """Read records until one is not whole; of a chunk that is not, those that are."""
        at = 0
        while at + _HEAD.size <= len(view) and not self.is_ended:
            kind, size = _HEAD.unpack_from(view, at)
            at += _HEAD.size
            with view[at : at + size] as body:
                is_whole = len(body) == size
                if kind == _CHUNK:
                    if in_chunk:
                        raise FormatError('a chunk in a chunk')
                    self._read_chunk(body)
                elif is_whole:
                    self._read_one(kind, body)
            if not is_whole or kind == 0:
                return
            at += size

    def _read_chunk(self, body: Any) -> None:
        name, at = _text(body, _CHUNK_HEAD.size)
        (size,) = _LONG.unpack_from(body, at)
        with body[at + _LONG.size : at + _LONG.size + size] as packed:
            content = memoryview(self._unpack(name, bytes(packed))) if name else packed
            self._read(content, in_chunk=True)

    def _read_one(self, kind: int, body: Any) -> None:
        if kind == _MESSAGE:
            channel, _, time, _ = _MESSAGE_HEAD.unpack_from(body)
            note = self._notes.get(channel)
            if note is not None:
                note(time, bytes(body[_MESSAGE_HEAD.size :]))
        elif kind == _SCHEMA:
            self._schemas[_IDS.unpack_from(body)[0]] = _text(body, 2)[0]
        elif kind == _CHANNEL:
            channel, schema = _IDS.unpack_from(body)
            topic, at = _text(body, _IDS.size)
            if channel not in self._notes and _text(body, at)[0] == 'cdr':
                self._notes[channel] = self._take(topic, self._schemas.get(schema, ''))
        elif kind == _DATA_END:
            self.is_ended = True


def _text(body: Any, at: int) -> tuple[str, int]:
    """Read a string, and where it ends."""
    (size,) = _NUMBER.unpack_from(body, at)
    end = at + _NUMBER.size + size
    return bytes(body[at + _NUMBER.size : end]).decode('utf-8'), end
