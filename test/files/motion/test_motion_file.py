# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records of motion sensors: tables of several makers, bags with Imu messages, bad files."""

from __future__ import annotations

from pathlib import Path
import re
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


def rows(times: list[str]) -> str:
    """Rows of a moving sensor at times of any form."""
    return ''.join(f'{time},{k},0,9.8\n' for k, time in enumerate(times))


@pytest.mark.parametrize(
    ('head', 'cells'),
    [
        (  # x-io
            'Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),'
            'Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)',
            '90,0,0,0,0,1',
        ),
        (  # WitMotion
            'Time(s),AsX(°/s),AsY(°/s),AsZ(°/s),AccX(g),AccY(g),AccZ(g),AngleX(°)',
            '90,0,0,0,0,1,3',
        ),
        (  # Movella DOT
            'Timestamp (us),Gyr_X (dps),Gyr_Y (dps),Gyr_Z (dps),Acc_X,Acc_Y,Acc_Z',
            '90,0,0,0,0,9.80665',
        ),
    ],
)
def test_both_quantities_of_an_imu_are_read_and_named(
    tmp_path: Path, head: str, cells: str
) -> None:
    later = 20000 if '(us)' in head else 1
    record = read_motion(written(tmp_path, f'{head}\n0,{cells}\n{later},{cells}\n'))
    assert record.acceleration is not None
    assert record.rate is not None
    np.testing.assert_allclose(record.acceleration[0], [0.0, 0.0, 9.80665])
    np.testing.assert_allclose(record.rate[0], [np.pi / 2.0, 0.0, 0.0])
    assert record.notes[0].startswith('motion.csv: read ')


def test_axes_without_a_name_are_known_by_their_unit(tmp_path: Path) -> None:
    text = 'elapsed (s),x-axis (deg/s),y-axis (deg/s),z-axis (deg/s)\n0,180,0,0\n1,0,0,0\n'
    record = read_motion(written(tmp_path, text))
    assert record.acceleration is None
    assert record.rate is not None
    np.testing.assert_allclose(record.rate[0], [np.pi, 0.0, 0.0])


def test_dates_come_before_seconds_of_a_record(tmp_path: Path) -> None:
    text = 'time,seconds_elapsed,qz,qy,qx,qw\n1777802400000000000,5,0,0,0,1\n'
    record = read_motion(written(tmp_path, text + '1777802400500000000,5.5,0,0,0,1\n'))
    assert record.epoch == 1777802400.0
    np.testing.assert_allclose(record.time, [0.0, 0.5])


def test_a_table_of_a_spreadsheet_is_read_in_its_encoding(tmp_path: Path) -> None:
    path = tmp_path / 'motion.csv'
    path.write_text('t_ms,ax,ay,az\n0,0,0,9.8\n20,0,0,9.8\n', encoding='utf-16')
    np.testing.assert_allclose(read_motion(path).time, [0.0, 0.02])


@pytest.mark.parametrize(
    ('times', 'what', 'cure'),
    [
        (['5000', '6000', '7000'], 'a sample every 1000 s', r'time \[ms\]'),
        (['3', '2', '1'], 'time goes back in 2 of 3 rows', 'order of time'),
        (['12:00:01'] * 50 + ['12:00:02'] * 50, '98 of 100 rows have the time', 'fractions'),
        (['now', 'then'], "the first is 'now'", 'seconds or dates'),
    ],
)
def test_times_that_are_not_those_of_samples_are_refused(
    tmp_path: Path, times: list[str], what: str, cure: str
) -> None:
    with pytest.raises(FormatError, match=what) as caught:
        read_motion(written(tmp_path, 'time,ax,ay,az\n' + rows(times)))
    assert re.search(cure, caught.value.cure)


def test_rows_that_are_written_twice_are_read(tmp_path: Path) -> None:
    text = 'time,ax,ay,az\n0,0,0,9.8\n0,0,0,9.8\n0.1,1,0,9.8\n0.1,1,0,9.8\n'
    assert len(read_motion(written(tmp_path, text)).time) == 4


def test_rows_of_two_sensors_are_refused(tmp_path: Path) -> None:
    text = 'time,DeviceName,ax,ay,az\n0,WT1,0,0,1\n0,WT2,1,0,0\ntime,DeviceName,ax,ay,az\n'
    with pytest.raises(FormatError, match='rows of 2 instruments: WT1, WT2'):
        read_motion(written(tmp_path, text))


def imu_message(second: int, *, turned: bool = False, frame: bytes = b'imu\0') -> bytes:
    """Serialise a sensor_msgs/Imu in CDR, as the standard lays it out."""
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


def bag_of(path: Path, topics: list[str], frames: list[bytes]) -> Path:
    """Write a bag with a message of each frame on each topic."""
    writer = pytest.importorskip('rosbags.rosbag2')
    stores = pytest.importorskip('rosbags.typesys')
    store = stores.get_typestore(stores.Stores.ROS2_JAZZY)
    with writer.Writer(path, version=9) as bag:
        for name in topics:
            topic = bag.add_connection(name, 'sensor_msgs/msg/Imu', typestore=store)
            for k, frame in enumerate(frames):
                bag.write(topic, 10**9 * k + 7, imu_message(1_700_000_000 + k, frame=frame))
    return path


def test_one_of_several_topics_of_a_bag_is_named_behind_it(tmp_path: Path) -> None:
    path = bag_of(tmp_path / 'bag', ['/limb/imu', '/tree/imu'], [b'imu\0'] * 2)
    with pytest.raises(FormatError, match='on 2 topics') as caught:
        read_motion(str(path))
    assert 'as bag?topic=/limb/imu' in caught.value.cure
    assert read_motion(f'{path}?topic=/tree/imu').notes[0].startswith('topic /tree/imu')


def test_a_topic_of_two_sensors_is_refused(tmp_path: Path) -> None:
    path = bag_of(tmp_path / 'bag', ['/imu'], [b'top\0', b'low\0'])
    with pytest.raises(FormatError, match='messages of 2 frames: low, top'):
        read_motion(path)


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
