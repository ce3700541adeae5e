# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import Point, Pose, PoseArray, Quaternion  # noqa: E402, I100
from hypothesis import given, settings  # noqa: E402
from hypothesis import strategies as st  # noqa: E402
from rclpy.serialization import deserialize_message, serialize_message  # noqa: E402
from sensor_msgs.msg import PointCloud2  # noqa: E402
from std_msgs.msg import String  # noqa: E402

from tree_sway.errors import TransportError  # noqa: E402
from tree_sway_ros.wire.cdr import (  # noqa: E402
    CdrTemplate,
    mark_stamp,
    pose_array_template,
    poses_of,
)

FRAMES = st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=12)


def built(poses, frame_id, stamp):
    """Make the same message of Python objects: what the bytes must say."""
    message = PoseArray()
    message.header.frame_id = frame_id
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    for x, y, z, qx, qy, qz, qw in poses.tolist():
        pose = Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))
        message.poses.append(pose)
    return message


@settings(deadline=None)
@given(st.integers(0, 5), FRAMES, st.integers(0, 2**31 * 10**9 - 1), st.integers(0, 2**32))
def test_bytes_say_what_objects_say(n_poses, frame_id, stamp, seed):
    poses = np.random.default_rng(seed).normal(size=(n_poses, 7))
    template = pose_array_template(n_poses, frame_id)
    template.blocks[0][:] = poses
    message = deserialize_message(template.to_bytes(stamp), PoseArray)
    assert message == built(poses, frame_id, stamp)


@settings(deadline=None)
@given(st.integers(0, 5), FRAMES, st.integers(0, 2**32))
def test_poses_are_read_as_the_middleware_writes_them(n_poses, frame_id, seed):
    poses = np.random.default_rng(seed).normal(size=(n_poses, 7))
    data = bytes(serialize_message(built(poses, frame_id, 5)))
    np.testing.assert_array_equal(poses_of(data), poses)
    for size in range(len(data) - 4 if n_poses else 16):  # the end may be padding
        cut = poses_of(data[:size])
        assert cut is None or len(cut) == 0 == n_poses


def test_a_name_that_is_longer_than_the_message_is_no_pose():
    assert poses_of(bytes(12) + b'\xff\xff\xff\xff' + bytes(40)) is None


@pytest.mark.parametrize('n_poses', [0, 1, 1000])
def test_a_template_is_used_again_and_again(n_poses):
    template = pose_array_template(n_poses, 'map')
    for stamp in (1, 5_000_000_007):
        poses = np.full((n_poses, 7), float(stamp))
        template.blocks[0][:] = poses
        data = template.to_bytes(stamp)
        assert type(data) is bytes
        assert deserialize_message(data, PoseArray) == built(poses, 'map', stamp)


@pytest.mark.parametrize('frame_id', ['', 'a', 'map', 'odom', 'abcdefg'])
def test_numbers_are_aligned_in_memory(frame_id):
    assert pose_array_template(3, frame_id).blocks[0].flags.aligned


def test_a_new_template_is_all_zero():
    message = deserialize_message(pose_array_template(2, 'map').to_bytes(0), PoseArray)
    assert message == built(np.zeros((2, 7)), 'map', 0)


def test_a_mark_that_is_not_there_is_an_error():
    with pytest.raises(TransportError, match='unexpected layout'):
        CdrTemplate(String(data='no stamp'), 1, [])


def test_what_an_earlier_message_left_between_fields_is_no_mark():
    message = PointCloud2()
    mark_stamp(message.header.stamp)
    message.height = message.header.stamp.sec
    found = deserialize_message(CdrTemplate(message, 1, []).to_bytes(7_000_000_005), PointCloud2)
    assert (found.header.stamp.sec, found.header.stamp.nanosec) == (7, 5)
    assert found.height == message.height


def test_a_mark_that_is_there_twice_is_an_error():
    from tree_sway_ros.wire.cdr import block_mark

    message = PoseArray(poses=[Pose(position=Point(x=block_mark(), y=block_mark()))])
    with pytest.raises(TransportError, match='unexpected layout'):
        CdrTemplate(message, 0, [(1, 7)])
