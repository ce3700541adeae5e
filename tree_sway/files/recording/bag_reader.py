# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The messages of a rosbag2 bag as bytes, read by rosbags within bounds."""

from __future__ import annotations

from array import array
from collections.abc import Collection
import io
from pathlib import Path
import struct
from typing import NamedTuple

import numpy as np

from tree_sway.errors import FormatError
from tree_sway.files.bounded import Arrays, bounded_arrays

_CURE = "if it was cut off, repair it with 'mcap recover' or 'sqlite3 FILE .recover'"


_BODY = 4
"""Bytes of encapsulation, from which on numbers are aligned."""


class BagContent(NamedTuple):
    """
    Contents of a bag: types of topics as ``package/msg/Name``, and the wanted messages.

    A message is its time of recording [ns], increasing, and its bytes.
    """

    types: dict[str, str]
    messages: dict[str, list[tuple[int, bytes]]]

    def chosen(self, topic: str | None, kinds: Collection[str], what: str, form: str) -> str:
        """
        Return the topic of some types of a name, or the only one; else a `FormatError`.

        ``what`` is on them; ``form`` is how one is chosen, before its name.
        """
        known = sorted(name for name, kind in self.types.items() if kind in kinds)
        found = [name for name in known if not topic or name.lstrip('/') == topic.lstrip('/')]
        if len(found) == 1:
            return found[0]
        problem = f"no {what} on topic '{topic}'" if topic else f'{what} on {len(known)} topics'
        if known:
            cure = f'choose a topic: {", ".join(known)}, as {form}{known[0]}'
        else:
            there = ', '.join(f'{name} ({kind})' for name, kind in [*self.types.items()][:10])
            cure = f'there is {there or "nothing"}; {what} is one of {", ".join(kinds)}'
        raise FormatError(problem, cure=cure)


def read_bag(path: Path, types: Collection[str]) -> BagContent:
    """
    Read the messages of some types from a bag: its folder, or its ``.db3`` or ``.mcap`` file.

    Raises
    ------
    FormatError
        Not a bag, one that is damaged, or one that takes too much.
    MissingDependencyError
        If rosbags is not installed.

    """
    if not path.exists():
        raise FormatError('no such bag', cure='check the path')
    if (path / 'record.yaml').is_file():
        raise FormatError(
            'a record of wind and motion, not a bag',
            cure='give a table of it, wind.csv or motion_1.csv; lab twin takes all of it',
        )
    arrays = bounded_arrays(_messages_of_bag, path, *types, kind='a bag', cure=_CURE)
    topics = arrays['topics'].tolist()
    content = BagContent(dict(topics), {topic: [] for topic, kind in topics if kind in types})
    data = io.BytesIO(arrays['data'])
    for topic, stamp, size in arrays['messages'].tolist():
        content.messages[topics[topic][0]].append((stamp, data.read(size)))
    return content


class Numbers(NamedTuple):
    """Stamp [ns] and frame of a message's header, and the numbers behind it."""

    stamp: int
    frame: str
    values: tuple[float, ...]


def numbers_of(data: bytes, count: int, *, has_header: bool = True) -> Numbers | None:
    """Return the first numbers of a message of CDR; None if it is too short."""
    order = '<' if data[1:2] == b'\1' else '>'
    stamp, frame, at = 0, '', _BODY
    try:
        if has_header:
            second, nanosecond, size = struct.unpack_from(f'{order}iII', data, at)
            stamp = second * 1_000_000_000 + nanosecond
            frame = data[at + 12 : at + 12 + size].rstrip(b'\0').decode('utf-8', 'replace')
            at -= -(12 + size) // 8 * 8
        return Numbers(stamp, frame, struct.unpack_from(f'{order}{count}d', data, at))
    except struct.error:
        return None


def _messages_of_bag(path: str, *types: str) -> Arrays:
    """Yield topics and types, (t, 2), topic, stamp and size of each message, (n, 3), and bytes."""
    from rosbags.rosbag2 import Reader

    bag = Path(path)
    parts = [bag]
    topics = dict[str, str]()
    if bag.is_dir() and not (bag / 'metadata.yaml').exists():
        parts = sorted(each for each in bag.iterdir() if each.suffix in ('.db3', '.mcap'))
        if not parts:
            raise ValueError('no metadata.yaml, no .db3 and no .mcap file in it')
    messages = array('q')
    content = bytearray()
    for part in parts:
        with Reader(part) as reader:
            topics |= {each.topic: each.msgtype for each in reader.connections}
            wanted = [each for each in reader.connections if each.msgtype in types]
            number = {topic: i for i, topic in enumerate(topics)}
            for connection, stamp, data in reader.messages(wanted) if wanted else ():
                messages.extend((number[connection.topic], stamp, len(data)))
                content += data
    yield 'topics', np.array(list(topics.items()), dtype=np.str_).reshape(-1, 2)
    yield 'messages', np.array(messages).reshape(-1, 3)
    yield 'data', np.array(memoryview(content))
