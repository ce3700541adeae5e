# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import json

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from geometry_msgs.msg import PoseStamped, Vector3Stamped  # noqa: E402, I100
from std_srvs.srv import Trigger  # noqa: E402

from tree_sway.core.settings import USUAL  # noqa: E402
from tree_sway.errors import TreeSwayError  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway_ros.process.topics import (  # noqa: E402
    CAMERA,
    MARKERS,
    SEGMENT_POSES,
    TREE_DESCRIPTION,
    WIND_FILTERED,
)
from tree_sway_ros.wire.wind_messages import wind_to_message, WindSample  # noqa: E402


@pytest.fixture
def forest_file(tmp_path, tree_file):
    """Two trees of the test tree, one of them in leaf, 3 m apart."""
    path = tmp_path / 'glade.yaml'
    path.write_text(
        'trees:\n'
        f'- {{name: oak, tree: {tree_file}, species: oak}}\n'
        f'- {{name: elm, tree: {tree_file}, x: 3, leaf_on: true}}\n'
    )
    return str(path)


def positions(message):
    return np.array(
        [(pose.position.x, pose.position.y, pose.position.z) for pose in message.poses]
    )


def blow(observer, publisher, vector):
    stamp = observer.node.get_clock().now().nanoseconds
    publisher.publish(wind_to_message(Vector3Stamped, WindSample(stamp, 'map', *vector)))


def test_a_forest_is_streamed_as_one(compose, observer, statuses, forest_file):
    compose(solver={'tree': forest_file})
    described = observer.listen(TREE_DESCRIPTION)
    frames, markers = observer.listen(SEGMENT_POSES), observer.listen(MARKERS)
    observer.until(lambda: described and frames and markers, 'a frame')
    description = json.loads(described[0].data)
    tree = open_scene(forest_file).tree
    assert description['name'] == 'glade'
    assert description['segments']['names'] == list(tree.segment_names)
    assert description['segments']['names'][0].startswith('oak/')
    assert description['segments']['names'][7].startswith('elm/')
    # Only the elm is in leaf, whatever the parameter.
    assert set(description['leaves']['segment']) <= set(range(7, 14))
    rest = positions(frames[0])
    assert rest == pytest.approx(tree.start, abs=1e-12)
    assert sum(len(marker.points) for marker in markers[0].markers) == 2 * 14
    wind = observer.publisher(WIND_FILTERED)

    def both_bend():
        blow(observer, wind, (8.0, 0.0, 0.0))
        return (positions(frames[-1])[[2, 9], 0] > rest[[2, 9], 0] + 1e-3).all()

    def values():
        status = statuses('solver: model')
        return {pair.key: pair.value for pair in status.values} if status else {}

    def gusts_travel():
        blow(observer, wind, (8.0, 0.0, 0.0))
        return float(values().get('longest delay of a gust [s]', 0.0)) > 0.0

    observer.until(both_bend, 'both to bend east')
    observer.until(gusts_travel, 'gusts to take their time')
    assert values()['model'] == str(USUAL)
    assert observer.call(Trigger, 'solver/reset', Trigger.Request()).success


def test_each_tree_is_as_exact_as_its_distance_from_the_camera_asks(
    compose, observer, forest_file
):
    nodes = compose(solver={'tree': forest_file, 'model': 'auto'})
    camera = observer.publisher(CAMERA)
    message = PoseStamped()
    message.pose.position.x = 13.0
    oak, elm = nodes['solver'].simulator.simulators

    def seen():
        camera.publish(message)
        return 0.005 not in (oak.tolerance, elm.tolerance)

    observer.until(seen, 'the camera to be seen')
    assert oak.tolerance / elm.tolerance == pytest.approx(13.0 / 10.0, abs=0.03)


def test_a_forest_that_cannot_be_says_where(compose, tmp_path):
    path = tmp_path / 'glade.yaml'
    path.write_text('trees:\n- {name: oak, tree: none.yaml}\n')
    with pytest.raises(TreeSwayError, match=r"glade\.yaml:2: tree 'oak': no tree 'none.yaml'"):
        compose(solver={'tree': str(path)})
