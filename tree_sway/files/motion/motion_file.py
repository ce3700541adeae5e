# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Read a record of a motion sensor from a table or a bag."""

from __future__ import annotations

from pathlib import Path

from tree_sway.files.kinds import expected
from tree_sway.files.motion.imu_bag import read_imu_bag
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.motion.motion_table import read_motion_table
from tree_sway.files.paths import path_of

_BAGS = ('.db3', '.mcap')


def read_motion(path: str | Path, topic: str | None = None) -> MotionRecord:
    """
    Read what a motion sensor on a tree measured.

    Parameters
    ----------
    path
        Table, or the folder or file of a bag with ``sensor_msgs/Imu``. One topic of several may be
        named behind it: ``bag?topic=/tree/imu``.
    topic
        Topic of a bag; None if there is one.

    Raises
    ------
    FormatError
        A file without time or motion.

    """
    if topic is None and isinstance(path, str):
        path, _, behind = path.partition('?topic=')
        topic = behind or None
    file = path_of(path)
    is_bag = file.is_dir() or file.suffix in _BAGS
    with expected(file, 'motion'):
        return read_imu_bag(file, topic) if is_bag else read_motion_table(file)
