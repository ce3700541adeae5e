# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The example of a laser scanner: each pulse beside all cylinders, and a cloud on the wire."""

import importlib.util
import json
import os
from pathlib import Path
import subprocess
import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from sensor_msgs.msg import PointCloud2  # noqa: E402, I100

from tree_sway.core.leaves.foliage import leaf_clusters  # noqa: E402
from tree_sway.files.trees.source import open_tree  # noqa: E402
from tree_sway_ros.process.topics import SEGMENT_POSES  # noqa: E402
from tree_sway_ros.wire.tree_description import describe  # noqa: E402

EXAMPLE = Path(__file__).parents[2] / 'examples' / 'python' / 'lidar.py'


@pytest.fixture(scope='module')
def lidar():
    spec = importlib.util.spec_from_file_location('lidar', EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def nearest_of_all(scanner, start, axis, length, radius):
    """Distance to the nearest cylinder of each pulse, beside every one of them."""
    pulses = scanner.pulses.reshape(-1, 3)
    nearest = np.full(len(pulses), np.inf)
    for s, t, long, r in zip(start - scanner.at, axis, length, radius, strict=True):
        u, w = pulses - np.outer(pulses @ t, t), s - (s @ t) * t
        a, b, c = (u**2).sum(axis=1), u @ w, w @ w - r * r
        with np.errstate(invalid='ignore', divide='ignore'):
            far = (b - np.sqrt(b * b - a * c)) / a
            place = far * (pulses @ t) - s @ t
            hit = (far > 0.0) & (place >= 0.0) & (place <= long) & (far < nearest)
        nearest[hit] = far[hit]
    return nearest


def test_each_pulse_meets_what_is_nearest_of_all(lidar):
    rng = np.random.default_rng(4)
    start = rng.uniform(-6.0, 6.0, (60, 3))
    start[np.linalg.norm(start, axis=1) < 2.0] += 4.0
    axis = rng.standard_normal((60, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    length, radius = rng.uniform(0.2, 1.0, 60), rng.uniform(0.01, 0.2, 60)
    scanner = lidar.Lidar(np.zeros(3), rings=40, columns=600)
    points = scanner.points(start, axis, length, radius)
    expected = nearest_of_all(scanner, start, axis, length, radius)
    expected = expected[expected < 120.0]
    assert len(expected) > 300
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), expected, atol=1e-9)


def test_leaves_hang_where_their_segments_are(lidar):
    tree = open_tree('benjamina').tree
    clusters = leaf_clusters(tree, np.random.default_rng(0), count=200)
    cylinders = lidar.Cylinders(json.loads(describe(tree, 'map', 'tree', clusters)))
    turn = Rotation.from_quat(tree.rest_poses[:, 3:])
    start, axis = cylinders.placed(tree.rest_poses[:, :3], tree.rest_poses[:, 3:])
    n = tree.n_segments
    centre = start[n:] + 0.5 * cylinders.length[n:, None] * axis[n:]
    expected = tree.start[clusters.segment] + turn[clusters.segment].apply(clusters.offset)
    np.testing.assert_allclose(centre, expected, atol=2e-4)
    away = Rotation.from_quat(clusters.orientation[:, [1, 2, 3, 0]]).apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(axis[n:], turn[clusters.segment].apply(away), atol=1e-3)
    # The mean shadow of a cylinder is a quarter of its surface, that of a disc half of its area.
    area = 0.25 * np.pi * clusters.size**2
    mantle = 2.0 * np.pi * cylinders.radius[n:] * cylinders.length[n:]
    np.testing.assert_allclose(mantle / 4.0, 0.5 * area, rtol=2e-3, atol=1e-6)


def test_a_cloud_lies_on_the_wood(compose, observer, domain, tree_file):
    compose(solver={'tree': tree_file, 'model': '4'})
    frames = observer.listen(SEGMENT_POSES)
    clouds = observer.listen(SEGMENT_POSES, kind=PointCloud2, name='points')
    command = [sys.executable, EXAMPLE, '--at', '1', '0', '0.8']
    environment = os.environ | {'ROS_DOMAIN_ID': str(domain)}
    with subprocess.Popen(command, env=environment) as process:
        try:
            observer.until(lambda: len(clouds) > 2 and frames, 'three clouds')
        finally:
            process.terminate()
    cloud = clouds[-1]
    assert cloud.header.frame_id == frames[-1].header.frame_id
    points = np.frombuffer(bytes(cloud.data), dtype='<f4').reshape(-1, 3)
    assert cloud.width == len(points) > 20
    tree = open_tree(tree_file).tree  # at rest, as there is no wind
    along = (tree.end - tree.start) / tree.length[:, None]
    away = points[:, None] - tree.start
    place = np.clip((away * along).sum(axis=2), 0.0, tree.length)
    gap = np.linalg.norm(away - place[..., None] * along, axis=2).min(axis=1)
    assert gap.max() < tree.base_diameter.max()
