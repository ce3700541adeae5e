# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gazebo (Harmonic) in our wind: its world's wind, and a tree that follows `segment_poses`.

    ros2 launch tree_sway_ros sway.launch.py
    python examples/python/gazebo.py --write world.sdf && gz sim world.sdf
    python examples/python/gazebo.py

Each segment is a static model, a cylinder without physics, that `set_pose_vector` moves; links of
other models with <enable_wind> feel the wind. **It has not been run with Gazebo**: topics,
services and messages are named as in the sources of gz-sim 8.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
import re
from typing import Any
from xml.sax.saxutils import quoteattr

from geometry_msgs.msg import PoseArray, Vector3Stamped
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

WORLD = """\
<sdf version="1.9"><world name={name}>
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<plugin filename="gz-sim-user-commands-system" name="gz::sim::systems::UserCommands"/>
<plugin filename="gz-sim-scene-broadcaster-system" name="gz::sim::systems::SceneBroadcaster"/>
<plugin filename="gz-sim-wind-effects-system" name="gz::sim::systems::WindEffects">
<horizontal><magnitude><time_for_rise>0.01</time_for_rise></magnitude>
<direction><time_for_rise>0.01</time_for_rise></direction></horizontal>
<vertical><time_for_rise>0.01</time_for_rise></vertical></plugin>
<wind><linear_velocity>0 0 0</linear_velocity></wind>
<light type="directional" name="sun"><direction>-0.5 0.2 -1</direction></light>
{segments}
</world></sdf>
"""
SEGMENT = """\
<model name={name}><static>true</static><link name="wood"><visual name="wood">
<pose>{middle:.6g} 0 0 0 1.5707963 0</pose><geometry><cylinder><radius>{radius:.6g}</radius>
<length>{length:.6g}</length></cylinder></geometry></visual></link></model>"""


def plain(name: str) -> str:
    """Return the name of a segment as Gazebo allows it."""
    return re.sub(r'\W', '_', name, flags=re.ASCII)


def world_of(description: str, world: str) -> str:
    """Return a world with a model per segment of `tree_description`, at first at the origin."""
    segments = json.loads(description)['segments']
    columns = (segments[name] for name in ('names', 'lengths', 'base_radii', 'tip_radii'))
    models = [
        SEGMENT.format(
            name=quoteattr(plain(name)), middle=0.5 * length, length=length,
            radius=0.5 * (base + tip),
        )
        for name, length, base, tip in zip(*columns, strict=True)
    ]  # fmt: skip
    return WORLD.format(name=quoteattr(world), segments='\n'.join(models))


class Bridge:
    """
    Passes the wind and the poses on.

    Parameters
    ----------
    node
        ROS node that hears them.
    gazebo
        Node of `gz.transport13`.
    messages
        Classes of `gz.msgs10` by name: ``Wind``, ``Pose_V`` and ``Boolean``.
    world
        Name of the world.

    """

    def __init__(
        self, node: rclpy.node.Node, gazebo: Any, messages: dict[str, Any], world: str
    ) -> None:
        self._gazebo, self._messages, self._world = gazebo, messages, f'/world/{world}'
        self._names: list[str] = []
        self._wind = gazebo.advertise(f'{self._world}/wind', messages['Wind'])
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(String, 'tree_description', self._describe, latched)
        node.create_subscription(Vector3Stamped, 'wind/filtered', self.blow, 10)
        node.create_subscription(PoseArray, 'segment_poses', self.place, 1)

    def _describe(self, message: String) -> None:
        self._names = [plain(name) for name in json.loads(message.data)['segments']['names']]

    def blow(self, message: Vector3Stamped) -> None:
        """Set the wind of the world."""
        wind = self._messages['Wind'](enable_wind=True)
        for axis in 'xyz':
            setattr(wind.linear_velocity, axis, getattr(message.vector, axis))
        self._wind.publish(wind)

    def place(self, message: PoseArray) -> None:
        """Move the models of the segments."""
        if len(self._names) != len(message.poses):
            return
        poses = self._messages['Pose_V']()
        for name, pose in zip(self._names, message.poses, strict=True):
            one = poses.pose.add(name=name)
            for axis in 'xyz':
                setattr(one.position, axis, getattr(pose.position, axis))
            for axis in 'xyzw':
                setattr(one.orientation, axis, getattr(pose.orientation, axis))
        kinds = self._messages['Pose_V'], self._messages['Boolean']
        self._gazebo.request(f'{self._world}/set_pose_vector', poses, *kinds, 1000)


def main() -> None:
    """Write the world, or pass wind and poses on until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--world', default='trees', help='name of the world (%(default)s)')
    parser.add_argument('--write', metavar='FILE', help='write the world of the tree, and end')
    given = parser.parse_args()
    rclpy.init()
    node = rclpy.create_node('gazebo_bridge')
    if given.write:
        heard: list[str] = []
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(
            String, 'tree_description', lambda message: heard.append(message.data), latched
        )
        while not heard:
            rclpy.spin_once(node)
        Path(given.write).write_text(world_of(heard[-1], given.world), encoding='utf-8')
    else:
        from gz.msgs10.boolean_pb2 import Boolean
        from gz.msgs10.pose_v_pb2 import Pose_V
        from gz.msgs10.wind_pb2 import Wind
        from gz.transport13 import Node

        messages = {'Boolean': Boolean, 'Pose_V': Pose_V, 'Wind': Wind}
        bridge = Bridge(node, Node(), messages, given.world)
        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
            del bridge
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
