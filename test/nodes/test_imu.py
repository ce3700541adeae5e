# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors over ROS: topics by a parameter, covariances, and a report of each."""

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from sensor_msgs.msg import Imu  # noqa: E402, I100

from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway_ros.nodes.imu_intake import places_of  # noqa: E402
from tree_sway_ros.process.topics import IMU, SEGMENT_POSES  # noqa: E402
from tree_sway_ros.reports.diagnostics import OK, WARN  # noqa: E402
from tree_sway_ros.wire.imu_messages import motion_from_message  # noqa: E402


def imu(stamp=0.0, up=9.81, rate=0.0):
    message = Imu()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(stamp * 1e9), 10**9)
    message.linear_acceleration.z = up
    message.angular_velocity.x = rate
    message.orientation_covariance[0] = -1.0
    return message


def test_topics_have_places_of_their_own():
    found = places_of(' tree/imu@3.2, limb/imu@b12:0.5 ')
    assert found == {'tree/imu': '3.2', 'limb/imu': 'b12:0.5'}
    assert places_of('') == {}


@pytest.mark.parametrize('text', ['imu', 'imu@', '@3.2', 'imu@1, imu@2'])
def test_another_text_is_refused_with_an_example(text):
    with pytest.raises(ParameterError, match='no topic with a place') as caught:
        places_of(text)
    assert 'tree/imu@3.2' in caught.value.cure


def test_covariances_say_what_is_measured_and_how_well():
    message = imu(12.5)
    message.linear_acceleration_covariance[:] = np.diag([0.04, 0.09, 0.01]).ravel()
    found = motion_from_message(message)
    assert found.stamp == 12_500_000_000
    assert found.orientation is None
    assert found.acceleration == (0.0, 0.0, 9.81)
    assert found.noise == pytest.approx((0.3, 0.0, 0.0))
    message.angular_velocity_covariance[0] = -1.0
    assert motion_from_message(message).rate is None


def test_a_sensor_is_heard_and_reported(compose, observer, tree_file):
    solver = compose(solver={'tree': tree_file, 'imu': 'tree/imu@segment:2'})['solver']
    frames, publisher = observer.listen(SEGMENT_POSES), observer.publisher(IMU, name='tree/imu')
    observer.until(lambda: frames, 'a frame')

    def accepted():
        now = observer.get_clock().now().nanoseconds * 1e-9
        publisher.publish(imu(now))
        bad = imu(now, up=float('nan'))
        publisher.publish(bad)
        counts = solver.simulator.sensors['tree/imu'].counts
        return counts.accepted > 20 and counts.not_finite > 20

    observer.until(accepted, 'samples')
    status = next(each for each in solver._statuses() if each.name.startswith('imu '))
    assert status.level == WARN
    assert 'mounting' in status.message
    assert solver.simulator.counts.restarted == 0
    assert OK != WARN


def test_sensors_on_a_forest_are_refused(compose, tmp_path):
    path = tmp_path / 'scene.yaml'
    path.write_text(
        'trees:\n  - {tree: goldcrest, at: [0, 0]}\n  - {tree: goldcrest, at: [3, 0]}\n'
    )
    with pytest.raises(ParameterError, match='motion sensors on a scene of 2 trees'):
        compose(solver={'tree': str(path), 'imu': 'tree/imu@0.5'})
