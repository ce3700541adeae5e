# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind in a ROS 2 bag, sqlite3 or mcap, read without ROS through rosbags.

Any of the wind's four message types: Vector3Stamped, TwistStamped, TwistWithCovarianceStamped
(linear part) and Vector3, all of geometry_msgs. The time is the header's; a zero stamp or a message
without a header has the time it was recorded at. Vectors point where the wind blows, east, north,
up (REP-103); ``direction_convention`` and ``yaw`` say otherwise.

"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tree_sway_ros.core.wind.convention import WindConvention
from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.text_file import reason_of
from tree_sway_ros.files.wind.record import WindRecord, WindRows

WIND_TYPES = tuple(
    f"geometry_msgs/msg/{name}"
    for name in ("Vector3Stamped", "TwistStamped", "TwistWithCovarianceStamped", "Vector3")
)
"""Message types that can hold wind."""


def read_bag_wind(
    path: Path, topic: str | None = None, yaw: float = 0.0, direction_convention: str = "to"
) -> WindRecord:
    """
    Read the wind of a bag.

    Parameters
    ----------
    path
        The bag's folder, or its ``.db3`` or ``.mcap`` file.
    topic
        Topic of the wind; may be None if only one topic has one of `WIND_TYPES`.
    yaw
        From east to the sensor's x axis, counter-clockwise, in [rad].
    direction_convention
        ``to`` where vectors point where the wind blows, ``from`` where it comes from.

    Raises
    ------
    FormatError
        Not a bag, no such topic, several to choose from, or no good message.
    MissingDependencyError
        If rosbags is not installed.

    """
    WindConvention(direction_convention)  # refused before the file is read
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
    rows = WindRows(source, row_name="message")
    epoch, n_unstamped, notes = -1, 0, list[str]()
    # A damaged bag fails in rosbags, sqlite3, lz4 or struct: whatever it is, it is the bag's fault.
    try:
        with AnyReader([bag_of(path)], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
            connection = _chosen(bag.connections, topic, source)
            for number, (_, recorded, data) in enumerate(bag.messages([connection]), start=1):
                message = bag.deserialize(data, connection.msgtype)
                stamp = _stamp(message)
                n_unstamped += not stamp
                epoch = (stamp or recorded) if epoch < 0 else epoch
                vector = _vector(message)
                seconds = ((stamp or recorded) - epoch) * 1e-9
                rows.add(number, seconds, (vector.x, vector.y, vector.z))
    except FormatError:
        raise
    except Exception as error:
        reason = reason_of(error)
        if not rows.time:
            raise FormatError(
                f"not a bag that can be read: {reason}",
                where=source,
                cure="if it was cut off, mend it with 'mcap recover' or 'sqlite3 FILE .recover'",
            ) from error
        notes.append(f"damaged after {len(rows.time)} messages, which were read: {reason}")
    notes.append(f"topic {connection.topic}, {connection.msgtype}")
    if n_unstamped:
        notes.append(f"{n_unstamped} messages without a stamp have the time they were recorded at")
    return rows.record(
        epoch=epoch * 1e-9,
        notes=tuple(notes),
        yaw=yaw,
        direction_convention=direction_convention,
    )


def bag_of(path: Path) -> Path:
    """Return the folder of a bag's file if its metadata is there, else the file itself."""
    return path.parent if path.is_file() and (path.parent / "metadata.yaml").exists() else path


def _chosen(connections: list[Any], topic: str | None, source: str) -> Any:
    of_wind = {c.topic: c for c in connections if c.msgtype in WIND_TYPES}
    if topic is not None:
        for name in (topic, f"/{topic}"):
            if name in of_wind:
                return of_wind[name]
    elif len(of_wind) == 1:
        return next(iter(of_wind.values()))
    names = ", ".join(sorted(of_wind)) or "none"
    if topic is not None:
        raise FormatError(f"no wind on topic '{topic}'", where=source, cure=f"wind is on: {names}")
    if of_wind:
        raise FormatError("wind on several topics", where=source, cure=f"choose a topic: {names}")
    there = ", ".join(f"{c.topic} ({c.msgtype})" for c in connections[:10]) or "nothing"
    raise FormatError(
        f"no topic of a wind type; there is {there}",
        where=source,
        cure=f"types: {', '.join(WIND_TYPES)}",
    )


def _stamp(message: Any) -> int:
    """Stamp of the header in [ns]; 0 if it is zero or there is no header."""
    header = getattr(message, "header", None)
    return 0 if header is None else header.stamp.sec * 1_000_000_000 + header.stamp.nanosec


def _vector(message: Any) -> Any:
    """Return the vector of any of the four types."""
    for name in ("vector", "twist"):
        message = getattr(message, name, message)
    return getattr(getattr(message, "twist", message), "linear", message)
