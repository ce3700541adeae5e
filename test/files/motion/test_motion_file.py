# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records of motion sensors: tables of several makers, bags with Imu messages, bad files."""

from __future__ import annotations

from pathlib import Path
import struct

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion.motion_file import read_motion
from tree_sway.files.wind.wind_file import read_wind

PHYPHOX = """"Time (s)","Acceleration x (m/s^2)","Acceleration y (m/s^2)","Acceleration z (m/s^2)"
0.010,0.12,-0.34,9.78
0.020,0.15,-0.30,9.81
0.030,0.10,-0.33,9.80
"""


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / 'motion.csv'
    path.write_text(text, encoding='utf-8')
    return path


def test_an_export_of_phyphox_is_read(tmp_path: Path) -> None:
    record = read_motion(written(tmp_path, PHYPHOX))
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[1], [0.15, -0.30, 9.81])
    assert record.rate is None
    np.testing.assert_allclose(record.time, [0.01, 0.02, 0.03])


def test_units_of_an_imu_are_converted(tmp_path: Path) -> None:
    text = 'time [ms],ax [g],ay [g],az [g],gx [deg/s],gy [deg/s],gz [deg/s]\n0,0,0,1,180,0,0\n'
    record = read_motion(written(tmp_path, text + '10,0,0,1,0,90,0\n'))
    assert record.acceleration is not None
    assert record.rate is not None
    np.testing.assert_allclose(record.acceleration[0], [0.0, 0.0, 9.80665])
    np.testing.assert_allclose(record.rate, [[np.pi, 0.0, 0.0], [0.0, np.pi / 2.0, 0.0]])
    np.testing.assert_allclose(record.time, [0.0, 0.01])


def test_orientations_are_read(tmp_path: Path) -> None:
    record = read_motion(written(tmp_path, 't,qx,qy,qz,qw\n0,0,0,0,1\n1,0,0,1,0\n'))
    assert record.orientation is not None
    np.testing.assert_allclose(record.orientation[1], [0.0, 0.0, 1.0, 0.0])


def test_a_cell_that_is_no_number_is_left_to_the_sensor(tmp_path: Path) -> None:
    record = read_motion(written(tmp_path, 'time,ax,ay,az\n0,0,0,9.8\n1,nan,0,9.8\n2,0,0,9.8\n'))
    assert record.acceleration is not None
    assert np.isnan(record.acceleration[1, 0])


def test_times_of_dates_are_those_of_the_wind(tmp_path: Path) -> None:
    text = 'time,ax,ay,az\n2026-03-01T12:00:02Z,0,0,9.8\n2026-03-01T12:00:03Z,0,0,9.8\n'
    record = read_motion(written(tmp_path, text))
    assert record.epoch is not None
    start = record.epoch - 2.0
    np.testing.assert_allclose(record.times_after(start), [2.0, 3.0])
    np.testing.assert_allclose(record.times_after(None, 0.5), [0.5, 1.5])


@pytest.mark.parametrize('head', ['time,x', 'ax,ay,az', 'time,ax,ay'])
def test_a_table_without_time_or_motion_is_refused(tmp_path: Path, head: str) -> None:
    row = ','.join('1' for _ in head.split(','))
    with pytest.raises(FormatError, match=r'no (time|motion) among') as caught:
        read_motion(written(tmp_path, f'{head}\n{row}\n'))
    assert caught.value.cure


def imu_message(second: int, *, turned: bool) -> bytes:
    """Serialise a sensor_msgs/Imu in CDR, as the standard lays it out."""
    frame = b'imu\0'
    head = b'\0\1\0\0' + struct.pack('<iII', second, 500_000_000, len(frame)) + frame
    none = [-1.0, *[0.0] * 8]
    known = [0.01, *[0.0] * 8]
    numbers = [0.0, 0.0, 0.0, 1.0, *(known if turned else none), 0.1, 0.2, 0.3, *known]
    return head + struct.pack('<37d', *numbers, 1.0, 2.0, 9.8, *known)


@pytest.mark.parametrize('turned', [True, False])
def test_a_bag_with_imu_is_read(tmp_path: Path, turned: bool) -> None:
    writer = pytest.importorskip('rosbags.rosbag2')
    stores = pytest.importorskip('rosbags.typesys')
    store = stores.get_typestore(stores.Stores.ROS2_JAZZY)
    path = tmp_path / 'bag'
    with writer.Writer(path, version=9) as bag:
        topic = bag.add_connection('/tree/imu', 'sensor_msgs/msg/Imu', typestore=store)
        for k in range(3):
            bag.write(topic, 10**9 * k + 7, imu_message(1_700_000_000 + k, turned=turned))
    record = read_motion(path)
    assert record.acceleration is not None
    assert record.rate is not None
    np.testing.assert_allclose(record.acceleration[2], [1.0, 2.0, 9.8])
    np.testing.assert_allclose(record.rate[0], [0.1, 0.2, 0.3])
    np.testing.assert_allclose(record.time, np.arange(3))
    assert record.epoch == 1_700_000_000.5
    assert (record.orientation is not None) is turned


def test_a_bag_without_imu_is_refused(tmp_path: Path) -> None:
    writer = pytest.importorskip('rosbags.rosbag2')
    path = tmp_path / 'bag'
    with writer.Writer(path, version=9):
        pass
    with pytest.raises(FormatError, match='on 0 topics'):
        read_motion(path)


def test_the_folder_of_a_record_is_told_from_a_bag(tmp_path: Path) -> None:
    (tmp_path / 'record.yaml').write_text('tree_sway_record: 1\n', encoding='utf-8')
    with pytest.raises(FormatError, match=r'give a table of it, wind\.csv or motion_1\.csv'):
        read_motion(str(tmp_path))
    with pytest.raises(FormatError, match='a record of wind and motion, not a bag'):
        read_wind(tmp_path)
