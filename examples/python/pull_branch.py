# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A robot's gripper that draws a branch aside and lets it go: wrenches to the solver's `~/push`.

    ros2 run tree_sway_ros solver
    python examples/python/pull_branch.py stem/4 --force 2 0 0

The gripper pulls harder and harder along a direction that stays, as an arm does that draws to
itself, and then opens: what follows is a free decay, as in a pull test.
"""

from __future__ import annotations

import argparse
import json

from geometry_msgs.msg import PoseArray, WrenchStamped
import numpy as np
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from scipy.spatial.transform import Rotation
from std_msgs.msg import String

_RATE = 20.0


class Gripper:
    """Pulls one segment, by its name, with a force [N] in the tree's frame."""

    def __init__(self, node: rclpy.node.Node, segment: str, force: list[float], seconds: float):
        self._segment, self._force, self._seconds = segment, np.array(force), seconds
        self._row: int | None = None
        self._frame_id = ''
        self._is_there = False
        self._share = 0.0
        self.is_open = False
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(String, 'tree_description', self._describe, latched)
        node.create_subscription(PoseArray, 'segment_poses', self._see, 2)
        self._push = node.create_publisher(WrenchStamped, 'solver/push', 10)
        self._axes = Rotation.identity()
        node.create_timer(1.0 / _RATE, self._pull)

    def _describe(self, message: String) -> None:
        description = json.loads(message.data)
        names = description['segments']['names']
        if self._segment not in names:
            raise SystemExit(f"no segment '{self._segment}'; name one such as {names[-1]}")
        self._row = names.index(self._segment)
        self._frame_id = f'{description["tree_frame"]}/{self._segment}'

    def _see(self, message: PoseArray) -> None:
        if self._row is not None:
            turn = message.poses[self._row].orientation
            self._axes = Rotation.from_quat([turn.x, turn.y, turn.z, turn.w])
            self._is_there = True

    def _pull(self) -> None:
        """Send the force in the segment's axes, as the frame of a wrench asks."""
        if not self._is_there:
            return
        self._share += 1.0 / (_RATE * self._seconds)
        self.is_open = self._share > 1.0
        wrench = WrenchStamped()
        wrench.header.frame_id = self._frame_id
        force = wrench.wrench.force
        now = self._axes.inv().apply(self._force * (0.0 if self.is_open else self._share))
        force.x, force.y, force.z = now.tolist()
        self._push.publish(wrench)


def main() -> None:
    """Pull, and let go."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('segment', help='name in tree_description, such as stem/4')
    parser.add_argument('--force', type=float, nargs=3, default=[2.0, 0.0, 0.0], metavar='N')
    parser.add_argument('--seconds', type=float, default=5.0, help='time to the full force')
    given = parser.parse_args()
    rclpy.init()
    node = rclpy.create_node('gripper')
    gripper = Gripper(node, given.segment, given.force, given.seconds)
    while not gripper.is_open:
        rclpy.spin_once(node)
    print(f'let go of {given.segment}', flush=True)
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
