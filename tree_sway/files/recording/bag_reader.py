# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The messages of a rosbag2 bag as the bytes that they came as, read without ROS and without rosbags.

Its two storages are read from end to end, with neither the index nor the metadata that a recorder
writes last: a bag that was cut off gives all that is there. What it may take is bounded: messages
by `MEMORY`, what is compressed by `UNPACKED` times the size of its file, a query by `SECONDS`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from contextlib import closing, suppress
from dataclasses import dataclass, field
import importlib
import io
from pathlib import Path
import sqlite3
import tempfile
import time
from typing import Any

from tree_sway.errors import FormatError, MissingDependencyError
from tree_sway.files.recording.mcap import McapRecords
from tree_sway.files.text_file import reason_of

MEMORY = 768 << 20
"""Memory that messages of a bag may take [bytes]."""
UNPACKED, SECONDS = 50, 20.0
"""Largest ratio of what is compressed to the size of its file [-]; longest query [s]."""
_LEAST_UNPACKED = 16 << 20
_OVERHEAD = 150  # bytes of Python's for each message
_PIECE = 1 << 16
_PLAIN = """
    SELECT count(*), (SELECT count(*) FROM pragma_table_xinfo('messages') WHERE hidden)
    FROM sqlite_master
    WHERE type = 'table' AND sql LIKE 'CREATE TABLE%' AND name IN ('topics', 'messages')"""
"""Tables, and computed columns: what is computed as it is read may be of any size."""
_TOPICS = "SELECT id, name, type FROM topics WHERE serialization_format = 'cdr'"
_MESSAGES = 'SELECT topic_id, timestamp, data FROM messages'
_ZSTD = b'\x28\xb5\x2f\xfd'
"""What zstd begins with, as no message in CDR does."""
_SUFFIXES = ('.db3', '.mcap', '.db3.zstd', '.mcap.zstd')
_MODULES = {
    'zstd': ('compression.zstd', 'backports.zstd', 'zstandard'),  # Python 3.14, rosbags, Ubuntu
    'lz4': ('lz4.frame',),
}


@dataclass
class BagContent:
    """
    What a bag holds: types of topics as ``package/msg/Name``, and messages of those asked for.

    A message is its time of recording [ns], increasing, and its bytes. ``damage`` is what ended
    the reading too soon; empty if the bag is whole.
    """

    types: dict[str, str] = field(default_factory=dict)
    messages: dict[str, list[tuple[int, bytes]]] = field(default_factory=dict)
    damage: str = ''


def read_bag(path: Path, types: Collection[str]) -> BagContent:
    """
    Read the messages of some types from a bag: its folder, or its ``.db3`` or ``.mcap`` file.

    Raises
    ------
    FormatError
        Not a bag, one that is damaged before its first message, or one that takes too much.
    MissingDependencyError
        If it is compressed, and the package that undoes this is not installed.

    """
    source = str(path)
    if not path.exists():
        raise FormatError('no such bag', where=source, cure='check the path')
    files = [path]
    if path.is_dir():
        files = [each for each in sorted(path.iterdir()) if each.name.endswith(_SUFFIXES)]
    reader = _Reader(types)
    content = reader.content
    if not files:
        content.damage = 'no .db3 and no .mcap file in it'
    for file in files:
        try:
            reader.read(file)
        except MissingDependencyError:
            raise
        except FormatError as error:
            raise error.at(source) from None
        except Exception as error:  # sqlite3, lz4, zstd or struct: it is the bag's fault
            content.damage = reason_of(error)
    if content.damage and not content.types:
        raise FormatError(
            f'not a bag that can be read: {content.damage}',
            where=source,
            cure="if it was cut off, mend it with 'mcap recover' or 'sqlite3 FILE .recover'",
        )
    for messages in content.messages.values():
        messages.sort(key=lambda message: message[0])
    return content


class _Reader:
    """Files of one bag to its content, and what they may still take."""

    def __init__(self, types: Collection[str]) -> None:
        self.content = BagContent()
        self._types = types
        self._memory = MEMORY
        self._packed = 0

    def read(self, path: Path) -> None:
        """Read a file of the bag."""
        self._packed = max(_LEAST_UNPACKED, UNPACKED * path.stat().st_size)
        if path.suffix != '.zstd':
            return self._read_storage(path)
        with tempfile.TemporaryDirectory() as folder:
            unpacked = Path(folder, path.stem)
            with path.open('rb') as packed, unpacked.open('wb') as whole:
                for piece in self._pieces('zstd', packed):
                    whole.write(piece)
            return self._read_storage(unpacked)

    def _read_storage(self, path: Path) -> None:
        with path.open('rb') as stream:
            head = stream.read(32)
        if head.startswith(b'\x89MCAP'):
            is_whole = McapRecords(self._take, self._unpack).read_file(path)
        else:
            self._read_sqlite(path)
            page, pages = int.from_bytes(head[16:18], 'big'), int.from_bytes(head[28:32], 'big')
            is_whole = path.stat().st_size >= page * pages  # page 1 is 65,536 bytes: never less
        if not is_whole:
            self.content.damage = f'{path.name} was cut off before its end'

    def _take(self, topic: str, type_name: str) -> Callable[[int, bytes], None] | None:
        self.content.types[topic] = type_name
        if type_name not in self._types:
            return None
        kept = self.content.messages.setdefault(topic, [])

        def note(stamp: int, data: bytes) -> None:
            content = self._unpack('zstd', data) if data[:4] == _ZSTD else data
            self._memory -= len(content) + _OVERHEAD
            if self._memory < 0:
                raise FormatError(
                    f'messages of more than {MEMORY >> 20} MiB', cure='record in shorter bags'
                )
            kept.append((stamp, content))

        return note

    def _read_sqlite(self, path: Path) -> None:
        # The journal of a recorder that was killed would have to be rolled back in the file.
        how = 'mode=ro' + '&immutable=1' * Path(f'{path}-journal').exists()
        with closing(sqlite3.connect(f'{path.resolve().as_uri()}?{how}', uri=True)) as base:
            base.execute('PRAGMA writable_schema = ON')  # or one that was cut off is refused whole
            end = time.monotonic() + SECONDS
            base.set_progress_handler(lambda: time.monotonic() > end, 100_000)
            if base.execute(_PLAIN).fetchone() != (2, 0):
                raise FormatError('no plain tables of topics and messages')
            notes = {number: self._take(str(name), str(kind)) for number, name, kind in
                     base.execute(_TOPICS)}  # fmt: skip
            for topic, stamp, data in base.execute(_MESSAGES):
                note = notes.get(topic)
                if note is not None:
                    note(stamp, data)

    def _unpack(self, name: str, data: bytes) -> bytes:
        """Undo as much of a compression as is there."""
        return b''.join(self._pieces(name, io.BytesIO(data)))

    def _pieces(self, name: str, packed: Any) -> Any:
        with _module(name).open(packed, 'rb') as stream, suppress(EOFError):
            while piece := stream.read(_PIECE):
                self._packed -= len(piece)
                if self._packed < 0:
                    raise FormatError(f'it unpacks to more than {UNPACKED} times its size')
                yield piece


def _module(name: str) -> Any:
    """Import the first module that undoes a compression and is there."""
    for each in _MODULES[name]:
        try:
            return importlib.import_module(each)
        except ImportError:
            continue
    package = _MODULES[name][-1].split('.')[0]
    cure = f'install python3-{package}, or pip install {package}'
    raise MissingDependencyError(f'the bag is compressed, and {package} is not there', cure=cure)
