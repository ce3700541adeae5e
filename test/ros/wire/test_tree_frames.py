# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames of a tree: their names, with and without tf2_msgs, and their transforms on the wire."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from rclpy.serialization import deserialize_message  # noqa: E402, I100

from tree_sway.core.tree.building import tree_from_segments  # noqa: E402
from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway_ros.process.topics import TF_STATIC  # noqa: E402
from tree_sway_ros.wire import tree_frames  # noqa: E402
from tree_sway_ros.wire.tree_frames import transforms_template, TreeFrames  # noqa: E402

TREE = tree_from_segments([[0, 0, 0], [0, 0, 1]], [[0, 0, 1], [0, 0, 2]], [0.1, 0.08])
FIRST, SECOND = TREE.segment_names


class Publisher:
    """Record of published bytes."""

    def __init__(self):
        self.sent = []

    def publish(self, data):
        self.sent.append(data)


def node_of(namespace='/', **values):
    """Stand in for the solver, as far as frames need it."""
    publishers, log = {}, []

    def publisher(topic):
        from tf2_msgs.msg import TFMessage  # noqa: F401

        return publishers.setdefault(topic.name, Publisher())

    usual = {'frame_id': 'map', 'rate': 60.0, 'publish_tf': True, 'segment_frames': ''}
    return SimpleNamespace(
        values={**usual, 'pose': (3.0, -1.0, 0.5, np.pi / 2), **values},
        get_namespace=lambda: namespace,
        get_logger=lambda: SimpleNamespace(info=log.append),
        get_clock=lambda: SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=7)),
        publisher=publisher,
        publishers=publishers,
        log=log,
    )


@pytest.fixture
def without_tf2(monkeypatch):
    for name in ('tf2_msgs', 'tf2_msgs.msg'):
        monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.parametrize(('namespace', 'root'), [('/', 'tree'), ('/north/oak', 'north/oak/tree')])
def test_a_segment_has_its_frame_below_that_of_the_tree(without_tf2, namespace, root):
    frames = TreeFrames(node_of(namespace), TREE)
    assert frames.root == root
    assert frames.row(f'{root}/{SECOND}') == 1
    assert frames.example == f'{root}/{FIRST}'
    for other in (SECOND, root, f'/{root}/{SECOND}', f'{root}/{SECOND}/', 'map', ''):
        assert frames.row(other) is None


def test_without_tf2_one_line_of_the_log_says_so(without_tf2):
    node = node_of(segment_frames=SECOND)
    frames = TreeFrames(node, TREE)
    assert len(node.log) == 1
    assert 'tf2_msgs, of ROS, is not installed' in node.log[0]
    assert not frames.is_due(0)


def test_an_unknown_segment_is_refused_with_the_nearest():
    with pytest.raises(ParameterError, match=f"segment_frames.*did you mean '{SECOND}'"):
        TreeFrames(node_of(segment_frames=f'{SECOND}0', publish_tf=False), TREE)


def test_nothing_is_published_where_it_is_off():
    node = node_of(publish_tf=False, segment_frames=SECOND)
    assert not TreeFrames(node, TREE).is_due(0)
    assert (node.publishers, node.log) == ({}, [])


def transforms_of(data):
    from tf2_msgs.msg import TFMessage

    return deserialize_message(data, TFMessage).transforms


def numbers_of(transform):
    at, turn = transform.transform.translation, transform.transform.rotation
    return [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]


def test_the_tree_stands_where_its_pose_says():
    pytest.importorskip('tf2_msgs', reason='tf2_msgs is not installed')
    node = node_of('/oak')
    TreeFrames(node, TREE)
    (data,) = node.publishers[TF_STATIC.name].sent
    (transform,) = transforms_of(data)
    assert (transform.header.frame_id, transform.child_frame_id) == ('map', 'oak/tree')
    half = np.sqrt(0.5)
    np.testing.assert_allclose(numbers_of(transform), [3.0, -1.0, 0.5, 0.0, 0.0, half, half])


def test_addressed_segments_have_their_poses_as_frames(monkeypatch):
    pytest.importorskip('tf2_msgs', reason='tf2_msgs is not installed')
    node = node_of()
    frames = TreeFrames(node, TREE)
    poses = np.random.default_rng(0).normal(size=(2, 7))
    assert not frames.is_due(0)  # nobody has asked for a frame
    for row in (1, 0, 1):
        frames.show(row)
    assert frames.is_due(2)
    assert not frames.is_due(3)  # 30 Hz of 60
    frames.publish(poses, stamp=5_000_000_009)
    (data,) = node.publishers['/tf'].sent
    transforms = transforms_of(data)
    assert [each.child_frame_id for each in transforms] == [f'tree/{SECOND}', f'tree/{FIRST}']
    for transform, pose in zip(transforms, poses[::-1], strict=True):
        stamp = transform.header.stamp
        assert (stamp.sec, stamp.nanosec, transform.header.frame_id) == (5, 9, 'map')
        np.testing.assert_array_equal(numbers_of(transform), pose)


def test_frames_beyond_the_limit_are_left_out(monkeypatch, without_tf2):
    monkeypatch.setattr(tree_frames, 'MOST', 1)
    frames = TreeFrames(node_of(), TREE)
    for row in (0, 1):
        frames.show(row)
    assert frames._shown == [0]


def test_a_template_of_no_frames_is_an_empty_message():
    pytest.importorskip('tf2_msgs', reason='tf2_msgs is not installed')
    assert transforms_of(transforms_template('map', []).to_bytes(1)) == []
