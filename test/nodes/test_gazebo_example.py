# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The bridge to Gazebo, beside a stand-in of Gazebo's node: what it writes, sends and asks."""

import importlib.util
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import Pose, PoseArray, Vector3Stamped  # noqa: E402, I100
from std_msgs.msg import String  # noqa: E402

from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway_ros.wire.tree_description import describe  # noqa: E402

EXAMPLE = Path(__file__).parents[2] / 'examples' / 'python' / 'gazebo.py'


@pytest.fixture(scope='module')
def gazebo():
    spec = importlib.util.spec_from_file_location('gazebo', EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Poses(list):
    def add(self, name):
        self.append(
            SimpleNamespace(name=name, position=SimpleNamespace(), orientation=SimpleNamespace())
        )
        return self[-1]


MESSAGES = {
    'Wind': lambda enable_wind: SimpleNamespace(
        enable_wind=enable_wind, linear_velocity=SimpleNamespace()
    ),
    'Pose_V': lambda: SimpleNamespace(pose=Poses()),
    'Boolean': object,
}


def test_the_world_has_a_model_of_each_segment(gazebo):
    tree = open_tree('goldcrest').tree
    root = ElementTree.fromstring(gazebo.world_of(describe(tree, 'map'), 'a "b'))
    assert root.find('world').get('name') == 'a "b'
    models = root.findall('world/model')
    assert len({model.get('name') for model in models}) == tree.n_segments
    lengths = [float(each.text) for each in root.iter('length')]
    assert lengths == pytest.approx(tree.length.tolist(), rel=1e-5)
    wind = root.find("world/plugin[@filename='gz-sim-wind-effects-system']")
    assert float(wind.find('horizontal/magnitude/time_for_rise').text) > 0.0


def test_wind_and_poses_are_passed_on(gazebo):
    sent, asked = [], []
    node = SimpleNamespace(create_subscription=lambda *_: None)
    stand_in = SimpleNamespace(
        advertise=lambda topic, _kind: SimpleNamespace(
            publish=lambda message: sent.append((topic, message))
        ),
        request=lambda *given: asked.append(given),
    )
    bridge = gazebo.Bridge(node, stand_in, MESSAGES, 'trees')
    wind = Vector3Stamped()
    wind.vector.x, wind.vector.y, wind.vector.z = 5.0, -1.0, 0.5
    bridge.blow(wind)
    ((topic, message),) = sent
    assert topic == '/world/trees/wind'
    assert vars(message.linear_velocity) == {'x': 5.0, 'y': -1.0, 'z': 0.5}
    assert message.enable_wind
    bridge.place(PoseArray(poses=[Pose()]))
    assert asked == []  # the tree is not known yet
    tree = open_tree('goldcrest').tree
    bridge._describe(String(data=describe(tree, 'map')))
    bridge.place(PoseArray(poses=[Pose() for _ in range(tree.n_segments)]))
    ((service, poses, *_),) = asked
    assert service == '/world/trees/set_pose_vector'
    assert len(poses.pose) == tree.n_segments
    assert vars(poses.pose[0].orientation) == {'x': 0.0, 'y': 0.0, 'z': 0.0, 'w': 1.0}
    assert all('/' not in pose.name for pose in poses.pose)
