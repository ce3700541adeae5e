# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The messages of a rosbag2 bag as bytes, read by rosbags within bounds."""

from __future__ import annotations

from array import array
from collections.abc import Collection
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

import numpy as np

from tree_sway.errors import FormatError
from tree_sway.files.bounded import Arrays, bounded_arrays

_CURE = "if it was cut off, repair it with 'mcap recover' or 'sqlite3 FILE .recover'"


@dataclass(frozen=True)
class BagContent:
    """
    Contents of a bag: types of topics as ``package/msg/Name``, and the wanted messages.

    A message is its time of recording [ns], increasing, and its bytes.
    """

    types: dict[str, str]
    messages: dict[str, list[tuple[int, bytes]]]


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
        raise FormatError('no such bag', where=str(path), cure='check the path')
    if (path / 'record.yaml').is_file():
        what = 'a record of wind and motion, not a bag'
        cure = 'give a table of it, wind.csv or motion_1.csv; lab twin takes all of it'
        raise FormatError(what, where=str(path), cure=cure)
    arrays = bounded_arrays(messages_of_bag, path, *types, kind='a bag', cure=_CURE)
    topics = arrays['topics'].tolist()
    content = BagContent(dict(topics), {topic: [] for topic, kind in topics if kind in types})
    data = arrays['data'].tobytes()
    ends = list(accumulate(arrays['size'].tolist(), initial=0))
    rows = zip(arrays['topic'].tolist(), arrays['stamp'].tolist(), strict=True)
    for row, (topic, stamp) in enumerate(rows):
        content.messages[topics[topic][0]].append((stamp, data[ends[row] : ends[row + 1]]))
    return content


def messages_of_bag(path: str, *types: str) -> Arrays:
    """Yield topics and their types, (t, 2), and of each message topic, stamp, size and bytes."""
    from rosbags.rosbag2 import Reader

    parts = [Path(path)]
    topics = dict[str, str]()
    if parts[0].is_dir() and not (parts[0] / 'metadata.yaml').exists():
        parts = sorted(each for each in parts[0].iterdir() if each.suffix in ('.db3', '.mcap'))
        if not parts:
            raise ValueError('no metadata.yaml, no .db3 and no .mcap file in it')
    numbers = array('q')
    stamps = array('q')
    sizes = array('q')
    content = bytearray()
    for part in parts:
        with Reader(part) as reader:
            topics |= {each.topic: each.msgtype for each in reader.connections}
            wanted = [each for each in reader.connections if each.msgtype in types]
            number = {topic: i for i, topic in enumerate(topics)}
            for connection, stamp, data in reader.messages(wanted) if wanted else ():
                numbers.append(number[connection.topic])
                stamps.append(stamp)
                sizes.append(len(data))
                content += data
    yield 'topics', np.array(list(topics.items()), dtype=np.str_).reshape(-1, 2)
    yield from (('topic', np.array(numbers)), ('stamp', np.array(stamps)))
    yield from (('size', np.array(sizes)), ('data', np.array(memoryview(content))))
