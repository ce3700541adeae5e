# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import TransformStamped  # noqa: E402, I100
from scipy.spatial.transform import Rotation  # noqa: E402

from tree_sway_ros.wire import frames  # noqa: E402
from tree_sway_ros.wire.frames import Frames  # noqa: E402


def transform(frame, parent, turn):
    made = TransformStamped(child_frame_id=frame)
    made.header.frame_id = parent
    to = made.transform.rotation
    to.x, to.y, to.z, to.w = turn.as_quat().tolist()
    return made


def yaw(angle):
    return Rotation.from_euler('z', angle)


def test_up_to_a_common_frame_and_down_again():
    known = Frames()
    a, b, c = Rotation.random(3, random_state=4)
    known.take([transform('mast', 'boat', a), transform('boat', 'odom', b)])
    known.take([transform('trees', 'odom', c)])
    expected = (c.inv() * b * a).as_matrix()
    np.testing.assert_allclose(known.rotation('mast', 'trees'), expected, atol=1e-12)
    np.testing.assert_allclose(known.rotation('trees', '/mast'), expected.T, atol=1e-12)
    np.testing.assert_allclose(known.rotation('odom', 'odom'), np.eye(3))


def test_the_latest_counts_and_another_parent_takes_its_place():
    known = Frames()
    for angle in (0.1, 0.2):
        known.take([transform('mast', 'map', yaw(angle))])
        np.testing.assert_allclose(known.rotation('mast', 'map'), yaw(angle).as_matrix())
    known.take([transform('mast', 'odom', yaw(0.3))])
    assert known.rotation('mast', 'map') is None


def test_what_is_no_rotation_or_leads_nowhere_is_none():
    known = Frames()
    for bad in (0.0, np.nan, 1e300):
        made = transform('mast', 'map', yaw(0.1))
        made.transform.rotation.w = made.transform.rotation.z = bad
        known.take([made])
    assert known.rotation('mast', 'map') is None
    known.take([transform('a', 'b', yaw(0.1)), transform('b', 'a', yaw(0.1))])
    assert known.rotation('a', 'map') is None  # a ring of frames ends, too


def test_frames_that_are_made_up_are_not_kept_without_end(monkeypatch):
    monkeypatch.setattr(frames, '_MOST', 3)
    known = Frames()
    known.take([transform(f'frame{number}', 'map', yaw(0.1)) for number in range(9)])
    known.take([transform('frame1', 'map', yaw(0.2))])
    np.testing.assert_allclose(known.rotation('frame1', 'map'), yaw(0.2).as_matrix())
    assert known.rotation('frame2', 'map') is not None
    assert known.rotation('frame3', 'map') is None
