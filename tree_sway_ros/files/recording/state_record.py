# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The recorded state of a tree: its description and `tree_state` as the messages that were sent."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.text_file import reason_of
from tree_sway_ros.files.wind.bag import bag_of

STATE_TYPE = "sensor_msgs/msg/JointState"
DESCRIPTION_TYPE = "std_msgs/msg/String"
_STAMP = struct.Struct("<iI")
_AFTER_HEAD = 4  # of CDR, whose third and fourth bytes are options


@dataclass(frozen=True, eq=False)
class StateRecord:
    """
    A state over time.

    Parameters
    ----------
    time
        Of each message after the first in [s], increasing, (n,).
    epoch
        Stamp of the first in seconds after 1970.
    states
        Messages as CDR bytes.
    description
        The last description as a CDR string.
    source
        The file.
    refused
        How many messages were left out, as their time does not go on or they cannot be read.

    """

    time: Floats
    epoch: float
    states: tuple[bytes, ...]
    description: bytes
    source: str
    refused: int = 0
    notes: tuple[str, ...] = ()


def read_state_record(path: Path, name: str = "tree_state") -> StateRecord:
    """
    Read the state and the description of a bag.

    Parameters
    ----------
    path
        The bag's folder, or its ``.db3`` or ``.mcap`` file.
    name
        Topic of the state, or the end of its name; the description is looked for beside it.

    Raises
    ------
    FormatError
        Not a bag, or one without both.
    MissingDependencyError
        If rosbags is not installed.

    """
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise MissingDependencyError(
            "bags need rosbags", where=str(path), cure="pip install rosbags"
        ) from error
    source = str(path)
    if not path.exists():
        raise FormatError("no such bag", where=source, cure="check the path")
    found: list[tuple[int, bytes]] = []
    description = b""
    try:
        with AnyReader([bag_of(path)], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
            topic = next(
                (
                    c.topic
                    for c in bag.connections
                    if c.msgtype == STATE_TYPE and f"/{c.topic}".endswith(f"/{name.lstrip('/')}")
                ),
                "",
            )
            beside = f"{topic.rpartition('/')[0]}/tree_description"
            wanted = [c for c in bag.connections if c.topic in (topic, beside)]
            for connection, _, data in bag.messages(wanted) if wanted else ():
                if connection.msgtype == DESCRIPTION_TYPE:
                    description = bytes(data)
                elif connection.msgtype == STATE_TYPE:
                    found.append((_stamp(bytes(data)), bytes(data)))
    except Exception as error:  # rosbags, sqlite3, lz4 or struct: it is the bag's fault
        raise FormatError(
            f"not a bag that can be read: {reason_of(error)}", where=source
        ) from error
    if not found or b'"state"' not in description:
        raise FormatError(
            f"no '{name}' with the description that it is read by",
            where=source,
            cure="record both: tree-sway record",
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
        len(found) - len(kept),
        (f"{topic}: {len(kept)} states",),
    )


def restamped(data: bytes, stamp: int) -> bytes:
    """A message that begins with a header, as CDR bytes, with another stamp [ns]."""
    head = _STAMP.pack(*divmod(stamp, 1_000_000_000))
    return data[:_AFTER_HEAD] + head + data[_AFTER_HEAD + len(head) :]


def _stamp(data: bytes) -> int:
    second, nanosecond = _STAMP.unpack_from(data, _AFTER_HEAD)
    return int(second) * 1_000_000_000 + int(nanosecond)
