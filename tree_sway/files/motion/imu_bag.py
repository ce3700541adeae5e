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
from tree_sway.files.paths import of_file
from tree_sway.files.recording.bag_reader import header_of, read_bag

IMU = 'sensor_msgs/msg/Imu'
_NUMBERS = 37
"""Numbers behind the header: a quaternion and two vectors, each with a covariance of nine."""

_MOST_BACK = 0.1
"""Largest share of messages that are not later than the one before."""


@of_file
def read_imu_bag(path: Path, topic: str | None = None) -> MotionRecord:
    """
    Read the motion of a bag: its folder, or its ``.db3`` or ``.mcap`` file.

    The topic may be None if there is a single one of this type.

    Raises
    ------
    FormatError
        Not a bag, no such topic, several to choose from, no good message on it, or times that
        are not those of samples.
    MissingDependencyError
        If rosbags is not installed.

    """
    bag = read_bag(path, (IMU,))
    chosen = bag.chosen(topic, (IMU,), 'motion', path, f'{path.name}?topic=')
    rows = [_sample(data, recorded) for recorded, data in bag.messages[chosen]]
    frames = {frame for _, frame, _ in rows if frame is not None}
    n_short = sum(frame is None for _, frame, _ in rows)
    if n_short == len(rows):
        what = f'no message on {chosen}' + (f', {n_short} are too short' if rows else '')
        raise FormatError(what, cure='record while the sensor publishes')
    if len(frames) > 1:
        raise FormatError(
            f'{chosen} has messages of {len(frames)} frames: {", ".join(sorted(frames)[:4])}',
            cure='record each sensor on a topic of its own',
        )
    epoch = rows[0][0] * 1e-9
    time = np.array([(stamp - rows[0][0]) * 1e-9 for stamp, _, _ in rows])
    values = np.stack([numbers for _, _, numbers in rows])
    parts = []
    for first, size in ((25, 3), (13, 3), (0, 4)):
        is_absent = float(values[0, first + size]) == -1.0
        parts.append(None if is_absent else values[:, first : first + size])
    n_back = int(np.count_nonzero(np.diff(time) <= 0.0))
    if n_back > _MOST_BACK * len(rows):
        raise FormatError(
            f'time goes back or stands in {n_back} of {len(rows)} messages on {chosen}',
            cure='stamp each by the clock of its sensor, or with zero for the time of recording',
        )
    counted = ((n_short, 'are too short'), (n_back, 'are not later than the one before'))
    notes = (f'topic {chosen}, {IMU}', *(f'{n} messages {what}' for n, what in counted if n))
    return MotionRecord(time, parts[0], parts[1], parts[2], str(path), epoch, notes)


def _sample(data: bytes, recorded: int) -> tuple[int, str | None, Floats]:
    """
    Read a message of CDR.

    The stamp in [ns] is that of recording where it is zero; the frame and the numbers follow, of a
    message that is too short None and not a number.
    """
    try:
        order, stamp, frame, at = header_of(data)
        numbers = struct.unpack_from(f'{order}{_NUMBERS}d', data, at)
    except struct.error:
        return recorded, None, np.full(_NUMBERS, np.nan)
    return stamp or recorded, frame, np.array(numbers)
