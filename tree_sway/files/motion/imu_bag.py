# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages ``sensor_msgs/Imu`` in a ROS 2 bag, read without ROS.

Units and frames are those of REP-103 and REP-145: m/s^2 with gravity, rad/s, and an orientation to
east, north, up. A quantity whose covariance begins with -1 is not measured.
"""

from __future__ import annotations

from pathlib import Path
import struct

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.recording.bag_reader import header_of, read_bag

IMU = 'sensor_msgs/msg/Imu'
_NUMBERS = 37
"""Numbers behind the header: a quaternion and two vectors, each with a covariance of nine."""


def read_imu_bag(path: Path, topic: str | None = None) -> MotionRecord:
    """
    Read the motion of a bag: its folder, or its ``.db3`` or ``.mcap`` file.

    The topic may be None if there is a single one of this type.

    Raises
    ------
    FormatError
        Not a bag, no such topic, several to choose from, or no message on it.
    MissingDependencyError
        If rosbags is not installed.

    """
    bag = read_bag(path, (IMU,))
    chosen = bag.chosen(topic, (IMU,), 'motion', path, f'{path.name}?topic=')
    rows = []
    frames = set[str]()
    for recorded, data in bag.messages[chosen]:
        try:
            stamp, frame, numbers = _sample(data, recorded)
            rows.append((stamp, numbers))
            frames.add(frame)
        except struct.error:
            rows.append((recorded, np.full(_NUMBERS, np.nan)))
    if not rows:
        what = f'no message on {chosen}'
        cure = 'record while the sensor publishes'
        raise FormatError(what, where=str(path), cure=cure)
    if len(frames) > 1:
        what = f'{chosen} has messages of {len(frames)} frames: {", ".join(sorted(frames)[:4])}'
        raise FormatError(what, where=str(path), cure='record each sensor on a topic of its own')
    epoch = rows[0][0] * 1e-9
    time = np.array([(each - rows[0][0]) * 1e-9 for each, _ in rows])
    values = np.stack([each for _, each in rows])
    parts = []
    for first, size in ((25, 3), (13, 3), (0, 4)):
        is_absent = float(values[0, first + size]) == -1.0
        parts.append(None if is_absent else values[:, first : first + size])
    notes = (f'topic {chosen}, {IMU}',)
    return MotionRecord(time, parts[0], parts[1], parts[2], str(path), epoch, notes)


def _sample(data: bytes, recorded: int) -> tuple[int, str, Floats]:
    """
    Read a message of CDR.

    The stamp in [ns] is that of recording where it is zero; the frame and the numbers follow.
    """
    order, stamp, frame, at = header_of(data)
    numbers = struct.unpack_from(f'{order}{_NUMBERS}d', data, at)
    return stamp or recorded, frame, np.array(numbers)
