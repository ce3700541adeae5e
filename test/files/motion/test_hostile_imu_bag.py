# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bags of motion whose clock goes back, or whose messages are of something else."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip('rosbags', reason='rosbags is not installed')

from rosbags.rosbag2 import StoragePlugin, Writer  # noqa: E402
from rosbags.typesys import get_typestore, Stores  # noqa: E402

from tree_sway.errors import FormatError  # noqa: E402
from tree_sway.files.motion import read_motion  # noqa: E402

STORE = get_typestore(Stores.ROS2_JAZZY)
IMU = 'sensor_msgs/msg/Imu'
COUNT = 100


def message(second: int) -> bytes:
    """Write a sample of a second."""
    types = STORE.types
    vector, none = types['geometry_msgs/msg/Vector3'], np.zeros(9)
    stamp = types['builtin_interfaces/msg/Time'](second, 5)
    header = types['std_msgs/msg/Header'](stamp, 'imu')
    turn = types['geometry_msgs/msg/Quaternion'](0.0, 0.0, 0.0, 1.0)
    sample = types[IMU](
        header, turn, none, vector(0.0, 0.1, 0.0), none, vector(0.1, 0.0, 9.8), none
    )
    return bytes(STORE.serialize_cdr(sample, IMU))


@pytest.fixture(params=[StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def bag(request, tmp_path: Path) -> Callable[..., Path]:
    def write(of: Callable[[int], bytes]) -> Path:
        with Writer(tmp_path / 'bag', version=9, storage_plugin=request.param) as writer:
            connection = writer.add_connection('/imu', IMU, typestore=STORE)
            for k in range(COUNT):
                writer.write(connection, (2000 + k) * 10**9, of(k))
        return tmp_path / 'bag'

    return write


@pytest.mark.parametrize(
    ('of', 'why'),
    [
        (lambda k: message(1000 - k), 'time goes back or stands in 99 of 100 messages on /imu'),
        (lambda k: message(1000), 'time goes back or stands in 99 of 100'),
        (lambda k: message(1000 + k)[:100], 'no message on /imu, 100 are too short'),
        (lambda k: b'', 'no message on /imu, 100 are too short'),
    ],
)
def test_a_bag_of_no_samples_is_refused(bag, of: Callable[[int], bytes], why: str) -> None:
    with pytest.raises(FormatError, match=why):
        read_motion(bag(of))


def test_what_is_odd_in_a_few_messages_is_said(bag) -> None:
    def of(k: int) -> bytes:
        return message(1000 + k - 5 * (k > 50))[: 100 if k % 30 == 29 else None]

    record = read_motion(bag(of))
    assert record.acceleration is not None
    assert np.isnan(record.acceleration[:, 0]).sum() == 3
    assert '3 messages are too short' in record.notes
    assert any('are not later than the one before' in note for note in record.notes)
