# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages ``sensor_msgs/Imu`` in a ROS 2 bag, read without ROS.

Units and frames are those of REP-103 and REP-145: m/s^2 with gravity, rad/s, and an orientation to
east, north, up. A quantity whose covariance begins with -1 is not measured.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tree_sway.errors import FormatError
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.paths import of_file
from tree_sway.files.recording.bag_reader import numbers_of, read_bag

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
    chosen = bag.chosen(topic, (IMU,), 'motion', f'{path.name}?topic=')
    messages = bag.messages[chosen]
    rows = [numbers_of(data, _NUMBERS) for _, data in messages]
    frames = {row.frame for row in rows if row}
    n_short = rows.count(None)
    if n_short == len(rows):
        what = f'no message on {chosen}' + (f', {n_short} are too short' if rows else '')
        raise FormatError(what, cure='record while the sensor publishes')
    if len(frames) > 1:
        raise FormatError(
            f'{chosen} has messages of {len(frames)} frames: {", ".join(sorted(frames)[:4])}',
            cure='record each sensor on a topic of its own',
        )
    stamps = [(row and row.stamp) or stamp for row, (stamp, _) in zip(rows, messages, strict=True)]
    time = np.array([(stamp - stamps[0]) * 1e-9 for stamp in stamps])
    values = np.array([row.values if row else [np.nan] * _NUMBERS for row in rows])
    acceleration, rate, orientation = (
        None if values[0, end] == -1.0 else values[:, begin:end]
        for begin, end in ((25, 28), (13, 16), (0, 4))
    )
    n_back = int(np.count_nonzero(np.diff(time) <= 0.0))
    if n_back > _MOST_BACK * len(rows):
        raise FormatError(
            f'time goes back or stands in {n_back} of {len(rows)} messages on {chosen}',
            cure='stamp each by the clock of its sensor, or with zero for the time of recording',
        )
    counted = ((n_short, 'are too short'), (n_back, 'are not later than the one before'))
    notes = (f'topic {chosen}, {IMU}', *(f'{n} messages {what}' for n, what in counted if n))
    return MotionRecord(time, acceleration, rate, orientation, str(path), stamps[0] * 1e-9, notes)
