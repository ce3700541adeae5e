# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind in a ROS 2 bag, sqlite3 or mcap, read without ROS.

Any of the wind's four message types: Vector3Stamped, TwistStamped, TwistWithCovarianceStamped
(linear part) and Vector3, all of geometry_msgs. The time is the header's; a zero stamp or a
message without a header has its time of recording. Vectors point where the wind blows, east,
north, up (REP-103); ``direction_convention`` and ``yaw`` change that.
"""

from __future__ import annotations

from pathlib import Path

from tree_sway.core.wind import WindConvention
from tree_sway.files.recording.bag_reader import numbers_of, read_bag
from tree_sway.files.wind.record import WindRecord, WindRows

WIND_TYPES = tuple(
    f'geometry_msgs/msg/{name}'
    for name in ('Vector3Stamped', 'TwistStamped', 'TwistWithCovarianceStamped', 'Vector3')
)
"""Message types of wind."""


def read_bag_wind(
    path: Path, topic: str | None = None, yaw: float = 0.0, direction_convention: str = 'to'
) -> WindRecord:
    """
    Read the wind of a bag: its folder, or its ``.db3`` or ``.mcap`` file.

    The topic may be None if a single one has a type of `WIND_TYPES`. ``yaw`` is from east to the
    sensor's x axis, counter-clockwise, in [rad]; vectors point ``to`` where the wind blows, or
    ``from`` where it comes from.

    Raises
    ------
    FormatError
        Not a bag, no such topic, several to choose from, or no good message.
    MissingDependencyError
        If rosbags is not installed.

    """
    WindConvention(direction_convention)  # refused before the file is read
    bag = read_bag(path, WIND_TYPES)
    chosen = bag.chosen(topic, WIND_TYPES, 'wind', '--wind-option topic=')
    kind = bag.types[chosen]
    rows = WindRows(str(path), row_name='message')
    epoch = -1
    n_unstamped = 0
    for number, (recorded, data) in enumerate(bag.messages[chosen], start=1):
        found = numbers_of(data, 3, has_header=not kind.endswith('/Vector3'))
        if found is None:
            rows.refuse(number, 'it is too short')
            continue
        n_unstamped += not found.stamp
        stamp = found.stamp or recorded
        epoch = stamp if epoch < 0 else epoch
        x, y, z = found.values
        rows.add(number, (stamp - epoch) * 1e-9, (x, y, z))
    unstamped = f'{n_unstamped} messages without a stamp have their time of recording'
    notes = f'topic {chosen}, {kind}', unstamped * bool(n_unstamped)
    return rows.record(
        epoch=epoch * 1e-9, notes=notes, yaw=yaw, direction_convention=direction_convention
    )
