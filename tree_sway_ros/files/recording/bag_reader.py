# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The messages of a rosbag2 bag as the bytes that they came as, read without ROS and without rosbags.

Its two storages are read from end to end, with neither the index nor the metadata that a recorder
writes last: a bag that was cut off gives all that is there.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from contextlib import closing
from dataclasses import dataclass, field
import importlib
from pathlib import Path
import sqlite3
import tempfile
from typing import Any

from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.recording.mcap import read_mcap
from tree_sway_ros.files.text_file import reason_of

_ZSTD = b'\x28\xb5\x2f\xfd'
"""What zstd begins with, as no message in CDR does."""
_SUFFIXES = ('.db3', '.mcap', '.db3.zstd', '.mcap.zstd')


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
        Not a bag, or one that is damaged before its first message.
    MissingDependencyError
        If it is compressed, and the package that undoes this is not installed.

    """
    source = str(path)
    if not path.exists():
        raise FormatError('no such bag', where=source, cure='check the path')
    files = [path]
    if path.is_dir():
        files = [each for each in sorted(path.iterdir()) if each.name.endswith(_SUFFIXES)]
    content = BagContent(damage='' if files else 'no .db3 and no .mcap file in it')
    for file in files:
        try:
            _read_file(file, types, content)
        except MissingDependencyError:
            raise
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


def _read_file(path: Path, types: Collection[str], content: BagContent) -> None:
    if path.suffix == '.zstd':
        with tempfile.TemporaryDirectory() as folder:
            unpacked = Path(folder, path.stem)
            unpacked.write_bytes(_unzstd(path.read_bytes()))
            return _read_file(unpacked, types, content)

    def take(topic: str, type_name: str) -> Callable[[int, bytes], None] | None:
        content.types[topic] = type_name
        if type_name not in types:
            return None
        kept = content.messages.setdefault(topic, [])
        return lambda time, data: kept.append((time, _unzstd(data) if data[:4] == _ZSTD else data))

    with path.open('rb') as stream:
        head = stream.read(32)
    if head.startswith(b'\x89MCAP'):
        is_whole = read_mcap(path, take, {'zstd': _unzstd, 'lz4': _unlz4})
    else:
        _read_sqlite(path, take)
        page, pages = int.from_bytes(head[16:18], 'big'), int.from_bytes(head[28:32], 'big')
        is_whole = path.stat().st_size >= page * pages  # page 1 stands for 65,536: never less
    if not is_whole:
        content.damage = f'{path.name} was cut off before its end'


def _read_sqlite(
    path: Path, take: Callable[[str, str], Callable[[int, bytes], None] | None]
) -> None:
    with closing(sqlite3.connect(f'{path.resolve().as_uri()}?mode=ro', uri=True)) as base:
        base.execute('PRAGMA writable_schema = ON')  # or a file that was cut off is refused whole
        rows = base.execute("SELECT id, name, type FROM topics WHERE serialization_format = 'cdr'")
        wanted = {number: take(name, type_name) for number, name, type_name in rows}
        for topic, time, data in base.execute('SELECT topic_id, timestamp, data FROM messages'):
            note = wanted.get(topic)
            if note is not None:
                note(time, data)


def _unzstd(data: bytes) -> bytes:
    """Undo as much of it as is there."""
    names = ('compression.zstd', 'backports.zstd', 'zstandard')  # of Python 3.14, rosbags, Ubuntu
    made = _module(*names).ZstdDecompressor()
    if hasattr(made, 'decompressobj'):
        made = made.decompressobj()
    return bytes(made.decompress(data))


def _unlz4(data: bytes) -> bytes:
    return bytes(_module('lz4.frame').LZ4FrameDecompressor().decompress(data))


def _module(*names: str) -> Any:
    """Import the first of some modules that is there."""
    for name in names:
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    package = names[-1].split('.')[0]
    cure = f'install python3-{package}, or pip install {package}'
    raise MissingDependencyError(f'the bag is compressed, and {package} is not there', cure=cure)
