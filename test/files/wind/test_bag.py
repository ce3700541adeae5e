# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.wind.bag import read_bag_wind, WIND_TYPES
from tree_sway.files.wind.wind_file import read_wind

rosbag2 = pytest.importorskip('rosbags.rosbag2', reason='rosbags is not installed')
typesys = pytest.importorskip('rosbags.typesys')

pytestmark = pytest.mark.usefixtures('readers_in_this_process')

STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
BEGIN = 1_700_000_000


def message_of(msgtype, number, vector, stamped=True):
    types = STORE.types
    vector3 = types['geometry_msgs/msg/Vector3']
    second, nanosecond = divmod(number * 50_000_000, 1_000_000_000) if stamped else (-BEGIN, 0)
    time = types['builtin_interfaces/msg/Time'](BEGIN + second, nanosecond)
    header = types['std_msgs/msg/Header'](time, 'map')
    twist = types['geometry_msgs/msg/Twist'](vector3(*vector), vector3(0.0, 0.0, 9.0))
    kind = msgtype.rsplit('/', 1)[1]
    if kind == 'Vector3':
        return vector3(*vector)
    if kind == 'Vector3Stamped':
        return types[msgtype](header, vector3(*vector))
    if kind == 'TwistStamped':
        return types[msgtype](header, twist)
    covariance = types['geometry_msgs/msg/TwistWithCovariance'](twist, np.zeros(36))
    return types[msgtype](header, covariance)


def write_bag(path, topics, plugin='SQLITE3', n=10, stamped=True):
    storage = rosbag2.StoragePlugin[plugin]
    with rosbag2.Writer(path, version=9, storage_plugin=storage) as writer:
        for topic, msgtype in topics.items():
            connection = writer.add_connection(topic, msgtype, typestore=STORE)
            for number in range(n):
                message = message_of(msgtype, number, (number % 30.0, 2.0, 0.5), stamped)
                stamp = BEGIN * 1_000_000_000 + number * 50_000_000 + 7_000_000 * (number % 2)
                writer.write(connection, stamp, STORE.serialize_cdr(message, msgtype))
    return path


@pytest.mark.parametrize('plugin', ['SQLITE3', 'MCAP'])
@pytest.mark.parametrize('msgtype', WIND_TYPES)
def test_all_types_in_both_storages(tmp_path, plugin, msgtype):
    bag = write_bag(tmp_path / 'bag', {'/wind': msgtype}, plugin)
    (file,) = (f for f in bag.iterdir() if f.suffix in ('.db3', '.mcap'))
    for path in (bag, file):
        record = read_wind(path)
        jitter = 0.007 if msgtype.endswith('Vector3') else 0.0
        expected = 0.05 * np.arange(10) + jitter * (np.arange(10) % 2)
        np.testing.assert_allclose(record.time, expected, atol=1e-9)
        np.testing.assert_array_equal(record.velocity[:, 0], np.arange(10))
        np.testing.assert_array_equal(record.velocity[:, 1:], [[2.0, 0.5]] * 10)
        assert record.epoch == BEGIN


def test_a_lone_file_without_its_metadata(tmp_path):
    bag = write_bag(tmp_path / 'bag', {'/wind': WIND_TYPES[0]}, 'MCAP')
    (file,) = bag.glob('*.mcap')
    lone = file.rename(tmp_path / 'lone.mcap')
    assert len(read_wind(lone).time) == 10


def test_topic_is_chosen(tmp_path):
    bag = write_bag(tmp_path / 'bag', dict(zip(('/a', '/b'), WIND_TYPES, strict=False)))
    with pytest.raises(FormatError, match='choose a topic: /a, /b, as --wind-option topic=/a'):
        read_bag_wind(bag)
    with pytest.raises(FormatError, match="no wind on topic 'c'; choose a topic: /a, /b"):
        read_bag_wind(bag, topic='c')
    assert read_bag_wind(bag, topic='b').notes[0] == f'topic /b, {WIND_TYPES[1]}'


def test_zero_stamps_take_the_time_of_recording(tmp_path):
    bag = write_bag(tmp_path / 'bag', {'/wind': WIND_TYPES[0]}, stamped=False)
    record = read_bag_wind(bag)
    np.testing.assert_allclose(record.time[:2], [0, 0.057], atol=1e-9)
    assert record.notes[1].startswith('10 messages without a stamp')


def test_directions(tmp_path):
    bag = write_bag(tmp_path / 'bag', {'/wind': 'geometry_msgs/msg/Vector3'})
    record = read_bag_wind(bag, direction_convention='from', yaw=np.pi / 2)
    np.testing.assert_allclose(record.velocity[3], [2.0, -3.0, -0.5])


def test_damaged_bags(tmp_path):
    bag = write_bag(tmp_path / 'bag', {'/wind': WIND_TYPES[0]})
    (file,) = bag.glob('*.db3')
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FormatError, match='not a bag that can be read'):
        read_bag_wind(bag)
    (tmp_path / 'empty').mkdir()
    with pytest.raises(FormatError, match='not a bag that can be read'):
        read_wind(tmp_path / 'empty')
    with pytest.raises(FormatError, match='no such bag'):
        read_bag_wind(tmp_path / 'none')


def test_a_bag_that_begins_at_zero_and_has_a_short_message(tmp_path):
    """A message that cannot be taken apart is refused and counted; those after it are read."""
    kind = 'geometry_msgs/msg/Vector3'
    with rosbag2.Writer(tmp_path / 'bag', version=9) as writer:
        connection = writer.add_connection('/wind', kind, typestore=STORE)
        for second in range(5):
            message = STORE.types[kind](1.0 + second, 2.0, 0.0)
            data = STORE.serialize_cdr(message, kind)
            writer.write(connection, second * 10**9, data[: 10 if second == 3 else None])
    record = read_bag_wind(tmp_path / 'bag')
    np.testing.assert_allclose(record.time, [0, 1, 2, 4])
    assert (record.refused, record.first_refused) == (1, 'message 4: it is too short')


@pytest.mark.parametrize('plugin', ['SQLITE3', 'MCAP'])
def test_a_bag_that_was_cut_off_is_refused_with_a_cure(tmp_path, plugin):
    """As a recorder leaves it that was killed: no metadata, no footer, half a page."""
    bag = write_bag(tmp_path / 'bag', {'/wind': WIND_TYPES[0]}, plugin, n=5000)
    (bag / 'metadata.yaml').unlink()
    (file,) = bag.iterdir()
    file.write_bytes(file.read_bytes()[: int(0.7 * file.stat().st_size)])
    with pytest.raises(FormatError, match='mcap recover'):
        read_wind(bag)


@pytest.mark.parametrize('mode', ['FILE', 'MESSAGE', 'STORAGE'])
@pytest.mark.parametrize('plugin', ['SQLITE3', 'MCAP'])
def test_what_is_compressed_is_read_as_well(tmp_path, plugin, mode):
    if (plugin, mode) == ('SQLITE3', 'STORAGE'):
        pytest.skip('sqlite3 has no compression of its own')
    storage = rosbag2.StoragePlugin[plugin]
    path, kind = tmp_path / 'bag', WIND_TYPES[0]
    writer = rosbag2.Writer(path, version=9, storage_plugin=storage)
    writer.set_compression(rosbag2.CompressionMode[mode], rosbag2.CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection('/wind', kind, typestore=STORE)
        for number in range(10):
            data = STORE.serialize_cdr(message_of(kind, number, (float(number), 2.0, 0.5)), kind)
            writer.write(connection, BEGIN * 10**9, data)
    np.testing.assert_array_equal(read_wind(path).velocity[:, 0], np.arange(10))
