# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.ros

from rclpy.serialization import deserialize_message  # noqa: E402
from visualization_msgs.msg import Marker, MarkerArray  # noqa: E402

from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.tree.building import tree_from_segments  # noqa: E402
from tree_sway.growth.builtin import builtin_tree  # noqa: E402, I100
from tree_sway_ros.wire.markers import radius_classes, TreeMarkers  # noqa: E402

TREE = builtin_tree('goldcrest')


@pytest.fixture(scope='module')
def message():
    poses = make_simulator(TREE, model=0).place()
    return deserialize_message(TreeMarkers(TREE, 'map', 5).to_bytes(poses, 3 * 10**9), MarkerArray)


def test_one_line_list_a_class_with_fixed_ids(message):
    markers = message.markers
    assert 1 < len(markers) <= 5
    assert [marker.id for marker in markers] == list(range(len(markers)))
    assert {(m.type, m.action, m.header.frame_id) for m in markers} == {
        (Marker.LINE_LIST, Marker.ADD, 'map')
    }
    assert {m.header.stamp.sec for m in markers} == {3}


def test_every_segment_is_drawn_once_from_its_start_to_its_end(message):
    points = [(p.x, p.y, p.z) for marker in message.markers for p in marker.points]
    drawn = np.array(points).reshape(-1, 6)
    expected = np.hstack([TREE.start, TREE.end])
    order = np.lexsort(drawn.round(6).T), np.lexsort(expected.round(6).T)
    np.testing.assert_allclose(drawn[order[0]], expected[order[1]], atol=1e-9)


def test_widths_fall_from_class_to_class(message):
    widths = [marker.scale.x for marker in message.markers]
    assert widths == sorted(widths, reverse=True)
    assert widths[-1] > 0.0


def test_one_radius_is_one_class():
    tree = tree_from_segments([[0, 0, 0]], [[0, 0, 1]], [0.1])
    pose = np.array([[0.0, 0.0, 0.0, 0.0, -np.sqrt(0.5), 0.0, np.sqrt(0.5)]])
    data = TreeMarkers(tree, 'map', 6).to_bytes(pose, 0)
    (marker,) = deserialize_message(data, MarkerArray).markers
    assert marker.points[1].z == pytest.approx(1.0)


def test_classes_hold_every_segment_once():
    radius = np.random.default_rng(0).lognormal(size=200)
    members = radius_classes(radius, 8)
    assert sorted(np.concatenate(members)) == list(range(200))
    assert all(radius[a].min() >= radius[b].max() for a, b in pairwise(members))
