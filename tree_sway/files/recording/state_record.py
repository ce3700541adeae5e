# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The recorded state of a tree: its description and `tree_state`, in the messages sent."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
import struct

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.recording.bag_reader import read_bag

STATE_TYPE = 'sensor_msgs/msg/JointState'
DESCRIPTION_TYPE = 'std_msgs/msg/String'
_STAMP = struct.Struct('<iI')
_AFTER_HEAD = 4  # of CDR, whose third and fourth bytes are options


@dataclass(frozen=True, eq=False)
class StateRecord:
    """
    A state over time: messages as CDR bytes, and the last description as a CDR string.

    Times count from the first message in [s], increasing, (n,); ``epoch`` is its stamp in seconds
    after 1970. ``refused`` messages are those whose time does not go on or that cannot be read.
    """

    time: Floats
    epoch: float
    states: tuple[bytes, ...]
    description: bytes
    source: str
    refused: int = 0
    notes: tuple[str, ...] = ()


def read_state_record(path: Path, name: str = 'tree_state') -> StateRecord:
    """
    Read the state and the description of a bag, its folder or its file.

    ``name`` is the topic of the state, or the end of its name; the description is looked for
    beside it.

    Raises
    ------
    FormatError
        Not a bag, or one without both.
    MissingDependencyError
        If rosbags is not installed.

    """
    source = str(path)
    bag = read_bag(path, (STATE_TYPE, DESCRIPTION_TYPE))
    end = f'/{name.lstrip("/")}'
    topics = [t for t, kind in bag.types.items() if kind == STATE_TYPE and f'/{t}'.endswith(end)]
    topic = topics[0] if topics else ''
    described = bag.messages.get(f'{topic.rpartition("/")[0]}/tree_description', [])
    description = described[-1][1] if described else b''
    sent = [data for _, data in bag.messages.get(topic, [])]
    found = [(_stamp(data), data) for data in sent if len(data) >= _AFTER_HEAD + _STAMP.size]
    if not found or b'"state"' not in description:
        raise FormatError(
            f"no '{name}' with the description that it is read by",
            where=source,
            cure='record both: tree-sway record',
        )
    kept = [found[0]]
    for each in found[1:]:
        if each[0] > kept[-1][0]:
            kept.append(each)
    stamps = np.array([stamp for stamp, _ in kept])
    return StateRecord(
        1e-9 * (stamps - stamps[0]),
        1e-9 * float(stamps[0]),
        tuple(data for _, data in kept),
        description,
        source,
        len(sent) - len(kept),
        (f'{topic}: {len(kept)} states',),
    )


def restamped(data: bytes, stamp: int) -> bytes:
    """Return a message that begins with a header, as CDR bytes, with another stamp [ns]."""
    head = _STAMP.pack(*divmod(stamp, 1_000_000_000))
    return data[:_AFTER_HEAD] + head + data[_AFTER_HEAD + len(head) :]


def _stamp(data: bytes) -> int:
    second, nanosecond = _STAMP.unpack_from(data, _AFTER_HEAD)
    return int(second) * 1_000_000_000 + int(nanosecond)
