# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pose arrays of other programs on the topic of a tree."""

from __future__ import annotations

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')

from geometry_msgs.msg import Pose, PoseArray  # noqa: E402, I100

from tree_sway.growth.builtin import builtin_tree  # noqa: E402
from tree_sway_ros.commands.monitor import StreamMonitor  # noqa: E402
from tree_sway_ros.commands.text import status_line, summary  # noqa: E402
from tree_sway_ros.process.topics import qos_profile, SEGMENT_POSES  # noqa: E402

pytestmark = pytest.mark.ros


@pytest.mark.parametrize('count', [0, 7, 100_000])
def test_poses_of_another_program_are_counted_apart(context: object, count: int) -> None:
    tree = builtin_tree('goldcrest')
    with StreamMonitor(context, tree) as monitor, StreamMonitor(context, None, 'other') as other:
        topic = f'/{SEGMENT_POSES.name}'
        publisher = other.node.create_publisher(PoseArray, topic, qos_profile(SEGMENT_POSES))
        monitor._receive_poses(bytes(20))  # not whole
        for _ in range(1000):
            publisher.publish(PoseArray(poses=[Pose()] * count))
            monitor.spin(0.02)
            if monitor.totals.foreign > 1:
                break
        assert monitor.totals.foreign > 1
        assert monitor.totals.poses.count == 0
        monitor.totals.add_poses(1.0, 1.0, tree.end[0])
        told = f'{monitor.totals.foreign} pose arrays of another program'
        assert told in summary(monitor.totals, 60.0)
        assert told in status_line(monitor.totals, 1.0)
