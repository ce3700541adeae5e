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
from tree_sway_ros.wire.wind_messages import fill_stamp  # noqa: E402

SECOND = 10**9


def transform(frame, parent, turn, stamp=0):
    made = TransformStamped(child_frame_id=frame)
    made.header.frame_id = parent
    fill_stamp(made.header.stamp, stamp)
    to = made.transform.rotation
    to.x, to.y, to.z, to.w = turn.as_quat().tolist()
    return made


def yaw(angle):
    return Rotation.from_euler('z', angle)


def test_up_to_a_common_frame_and_down_again():
    known = Frames()
    a, b, c = Rotation.random(3, random_state=4)
    known.take([transform('mast', 'boat', a), transform('boat', 'odom', b)], is_static=True)
    known.take([transform('trees', 'odom', c)], is_static=True)
    expected = (c.inv() * b * a).as_matrix()
    np.testing.assert_allclose(known.rotation('mast', 'trees', 0), expected, atol=1e-12)
    np.testing.assert_allclose(known.rotation('trees', '/mast', 0), expected.T, atol=1e-12)
    np.testing.assert_allclose(known.rotation('odom', 'odom', 0), np.eye(3))


@pytest.mark.parametrize(
    ('stamp', 'angle'),
    [(0, 0.6), (5 * SECOND // 2, 0.4), (2 * SECOND, 0.2), (9 * SECOND, 0.6), (1, 0.1)],
)
def test_at_its_time_between_two_and_the_nearest_beyond(stamp, angle):
    known = Frames()
    for second, at in ((1, 0.1), (2, 0.2), (3, 0.6)):
        known.take([transform('mast', 'map', yaw(at), second * SECOND)])
    np.testing.assert_allclose(
        known.rotation('mast', 'map', stamp), yaw(angle).as_matrix(), atol=1e-9
    )


def test_a_clock_that_goes_back_or_another_parent_begins_anew():
    known = Frames()
    known.take([transform('mast', 'map', yaw(0.1), 9 * SECOND)])
    known.take([transform('mast', 'map', yaw(0.2), 1 * SECOND)])
    np.testing.assert_allclose(known.rotation('mast', 'map', 9 * SECOND), yaw(0.2).as_matrix())
    known.take([transform('mast', 'odom', yaw(0.3), 2 * SECOND)])
    assert known.rotation('mast', 'map', 0) is None


def test_what_is_no_rotation_or_leads_nowhere_is_none():
    known = Frames()
    for bad in (0.0, np.nan, 1e300):
        made = transform('mast', 'map', yaw(0.1))
        made.transform.rotation.w = made.transform.rotation.z = bad
        known.take([made])
    assert known.rotation('mast', 'map', 0) is None
    known.take([transform('a', 'b', yaw(0.1)), transform('b', 'a', yaw(0.1))])
    assert known.rotation('a', 'map', 0) is None  # a ring of frames ends, too


def test_frames_that_are_made_up_are_not_kept_without_end(monkeypatch):
    monkeypatch.setattr(frames, '_MOST', 3)
    known = Frames()
    known.take([transform(f'frame{number}', 'map', yaw(0.1)) for number in range(9)])
    known.take([transform('frame1', 'map', yaw(0.2))])
    np.testing.assert_allclose(known.rotation('frame1', 'map', 0), yaw(0.2).as_matrix())
    assert known.rotation('frame2', 'map', 0) is not None
    assert known.rotation('frame3', 'map', 0) is None
