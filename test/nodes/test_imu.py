# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors over ROS: topics by a parameter, covariances, and a report of each."""

import time

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from sensor_msgs.msg import Imu  # noqa: E402, I100

from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway_ros.nodes.imu_intake import places_of  # noqa: E402
from tree_sway_ros.process.topics import IMU  # noqa: E402
from tree_sway_ros.reports.diagnostics import WARN  # noqa: E402
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


PARAMETERS = {'imu': 'tree/imu@segment:2'}
REPORT = 'solver: imu tree/imu'


def test_a_sensor_is_heard_and_reported(compose, observer, tree_file, statuses):
    solver = compose(solver={'tree': tree_file, **PARAMETERS})['solver']
    publisher = observer.publisher(IMU, name='tree/imu')

    def is_counted():
        now = time.time()
        for message in (imu(now), imu(now, up=float('nan')), imu(now - 3600.0)):
            publisher.publish(message)
        if (report := statuses(REPORT)) is None:
            return False
        values = {each.key: each.value for each in report.values}
        names = ('accepted', 'refused', 'refused for their stamps')
        return all(int(values[name]) > 5 for name in names)

    observer.until(is_counted, 'counts of each kind')
    assert statuses(REPORT).level[0] == WARN
    assert 'mounting' in statuses(REPORT).message
    assert solver.guard.count == 0


def test_a_clock_of_its_own_is_told_with_the_cure(compose, observer, tree_file, statuses):
    compose(solver={'tree': tree_file, **PARAMETERS})
    publisher = observer.publisher(IMU, name='tree/imu')

    def is_told():
        publisher.publish(imu(12.0))
        report = statuses(REPORT)
        return report is not None and 'synchronise the clocks' in report.message

    observer.until(is_told, 'the cure')


def test_sensors_on_a_forest_are_refused(compose, tmp_path, tree_file):
    path = tmp_path / 'glade.yaml'
    path.write_text(
        f'trees:\n- {{name: oak, tree: {tree_file}}}\n- {{name: elm, tree: {tree_file}, x: 3}}\n'
    )
    with pytest.raises(ParameterError, match='motion sensors on a scene of 2 trees'):
        compose(solver={'tree': str(path), 'imu': 'tree/imu@0.5'})
