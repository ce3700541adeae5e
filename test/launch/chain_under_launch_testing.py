# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole chain as ``launch_test`` runs it; `test_launch_testing` starts this file."""

from pathlib import Path
import time
import unittest

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
import launch_testing.actions
import launch_testing.asserts
import rclpy

from tree_sway_ros.process.topics import message_class, qos_profile, SEGMENT_POSES

SWAY = Path(__file__).parents[2] / 'launch' / 'sway.launch.py'
DEADLINE = 60.0


def generate_test_description():
    arguments = {'tree': LaunchConfiguration('tree')}
    sway = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(str(SWAY)), launch_arguments=arguments.items()
    )
    tree = DeclareLaunchArgument('tree')
    return LaunchDescription([tree, sway, launch_testing.actions.ReadyToTest()])


class TestWhileItSways(unittest.TestCase):
    """What is said and sent while all nodes run."""

    def test_it_says_when_it_is_ready_and_streams(self, proc_output):
        proc_output.assertWaitFor('ready after', timeout=DEADLINE, stream='stderr')
        said = 'reading wind by direction_convention to, speed_scale 1.0, '
        proc_output.assertWaitFor(said, timeout=DEADLINE, stream='stderr')
        rclpy.init()
        node, frames = rclpy.create_node('observer'), []
        quality = qos_profile(SEGMENT_POSES)
        kind = message_class(SEGMENT_POSES)
        node.create_subscription(kind, SEGMENT_POSES.name, frames.append, quality)
        end = time.monotonic() + DEADLINE
        while len(frames) < 60 and time.monotonic() < end:
            rclpy.spin_once(node, timeout_sec=0.2)
        node.destroy_node()
        rclpy.shutdown()
        assert len(frames) >= 60


@launch_testing.post_shutdown_test()
class TestAfterwards(unittest.TestCase):
    """How the nodes end."""

    def test_every_node_ended_well(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info)
