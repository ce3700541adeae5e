# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A laser scanner among moving trees: wood and leaves as a `PointCloud2` on `points`, at 10 Hz.

    ros2 launch tree_sway_ros sway.launch.py tree:=$PWD/config/forest.yaml
    python examples/python/lidar.py --at 20 0 1.5

Each pulse meets the nearest cylinder where it is in the newest frame of `segment_poses`; a whole
turn is of that frame. A segment is a cylinder of its mean radius, and so is each cluster of leaves
in `tree_description`. The ground and the width of the beam are left out.
"""

from __future__ import annotations

import argparse
import json

from geometry_msgs.msg import PoseArray
import numpy as np
from numpy.typing import NDArray
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import String

Floats = NDArray[np.float64]

_ALONG = np.linspace(0.0, 1.0, 5)
"""Places on a segment, whose directions bound the pulses that may meet it."""


class Lidar:
    """
    Pulses on a grid of elevations and bearings from one place.

    Parameters
    ----------
    at
        Its place [m], (3,).
    rings, columns
        Number of elevations and of bearings.
    low, high
        Lowest and highest elevation [rad].
    reach
        Longest range [m].

    """

    def __init__(
        self, at: Floats, rings: int = 32, columns: int = 1800,
        low: float = -0.27, high: float = 0.8, reach: float = 120.0,
    ) -> None:  # fmt: skip
        self.at, self._columns, self._reach = at, columns, reach
        self._low, self._step = low, (high - low) / (rings - 1)
        self._turn = 2.0 * np.pi / columns
        elevation = low + self._step * np.arange(rings)[:, None]
        bearing = self._turn * np.arange(columns)
        level = np.cos(elevation)
        grid = [
            level * np.cos(bearing),
            level * np.sin(bearing),
            np.sin(elevation) + 0.0 * bearing,
        ]
        self.pulses = np.stack(grid, axis=-1)

    def points(self, start: Floats, axis: Floats, length: Floats, radius: Floats) -> Floats:
        """Return where pulses meet cylinders [m], (k, 3), of starts and axes (n, 3)."""
        segment, ring, column = self._pairs(start, axis, length, radius)
        pulse, along = self.pulses[ring, column], axis[segment]
        begin = start[segment] - self.at
        # Across the axis the pulse meets a circle.
        cosine = (pulse * along).sum(axis=1)
        across = pulse - cosine[:, None] * along
        middle = begin - (begin * along).sum(axis=1)[:, None] * along
        size = np.maximum((across**2).sum(axis=1), 1e-12)
        half = (across * middle).sum(axis=1)
        root = half**2 - size * ((middle**2).sum(axis=1) - radius[segment] ** 2)
        far = (half - np.sqrt(np.maximum(root, 0.0))) / size
        place = far * cosine - (begin * along).sum(axis=1)
        meets = (root >= 0.0) & (far > 0.0) & (far < self._reach)
        meets &= (place >= 0.0) & (place <= length[segment])
        nearest = np.full(self.pulses.shape[:2], np.inf)
        np.minimum.at(nearest, (ring[meets], column[meets]), far[meets])
        hit = np.isfinite(nearest)
        return np.asarray(self.at + nearest[hit][:, None] * self.pulses[hit])

    def _pairs(self, start: Floats, axis: Floats, length: Floats, radius: Floats) -> NDArray:
        """Segments, rings and columns of pulses that may meet, (3, m)."""
        places = start[:, None] + (length[:, None] * _ALONG)[..., None] * axis[:, None] - self.at
        away = np.linalg.norm(places, axis=2)
        elevation = np.arcsin(places[..., 2] / away)
        spread = np.arcsin(np.minimum(radius / np.maximum(away.min(axis=1), 1e-9), 1.0))
        spread += np.ptp(elevation, axis=1) / 8.0  # between the places it may be higher
        rows = self._span(elevation - self._low, spread, self._step)
        bearing = np.unwrap(np.arctan2(places[..., 1], places[..., 0]), axis=1)
        steepest = np.cos(np.minimum(np.abs(elevation).max(axis=1) + spread, 1.5))
        columns = self._span(bearing, np.minimum(spread / steepest, np.pi), self._turn)
        rows = np.clip(rows, [0, -1], len(self.pulses) - 1)
        high, wide = np.maximum(rows[:, 1] - rows[:, 0] + 1, 0), columns[:, 1] - columns[:, 0] + 1
        wide = np.clip(wide, 0, self._columns)
        segment = np.repeat(np.arange(len(start)), high * wide)
        number = np.arange(len(segment)) - np.repeat(
            np.cumsum(high * wide) - high * wide, high * wide
        )
        ring = rows[segment, 0] + number // wide[segment]
        column = (columns[segment, 0] + number % wide[segment]) % self._columns
        return np.stack([segment, ring, column])

    @staticmethod
    def _span(angles: Floats, margin: Floats, step: float) -> NDArray:
        """First and last pulse between angles, (n, 2)."""
        low, high = angles.min(axis=1) - margin, angles.max(axis=1) + margin
        return np.stack([np.ceil(low / step), np.floor(high / step)], axis=1).astype(np.int64)


class Cylinders:
    """
    Wood and leaves of a `tree_description`, carried by the segments.

    A cluster of leaves of diameter d has the area of a disc, whose shadow is half of it in the
    mean of all directions. That of a cylinder as long, of radius d / 4, is as large.
    """

    def __init__(self, description: dict) -> None:
        segments, leaves = description['segments'], description.get('leaves', {})
        radii = np.array([segments['base_radii'], segments['tip_radii']])
        size = np.array(leaves.get('size', []))
        self.n_segments = len(segments['lengths'])
        self.length = np.concatenate([segments['lengths'], size])
        self.radius = np.concatenate([radii.mean(axis=0), size / 4.0])
        self._segment = np.array(leaves.get('segment', []), dtype=np.int64)
        self._centre = np.array(leaves.get('offset', [])).reshape(-1, 3)
        turns = np.array(leaves.get('orientation', [])).reshape(-1, 4)  # w x y z
        x, y, z = turns[:, 1], turns[:, 2], turns[:, 3]
        w = turns[:, 0]
        self._axis = np.stack(
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1
        )

    def placed(self, places: Floats, turns: Floats) -> tuple[Floats, Floats]:
        """Return starts and axes, (n, 3) each, of segments at places and turns of x y z w."""
        turn = Rotation.from_quat(turns)
        wood = turn.apply([1.0, 0.0, 0.0])
        if len(self._segment) == 0:
            return places, wood
        carrier = turn[self._segment]
        leaf = carrier.apply(self._axis)
        centre = places[self._segment] + carrier.apply(self._centre)
        start = centre - 0.5 * self.length[self.n_segments :, None] * leaf
        return np.concatenate([places, start]), np.concatenate([wood, leaf])


def cloud_of(points: Floats, poses: PoseArray) -> PointCloud2:
    """Return points in the frame and at the time of poses, as x y z float32."""
    fields = [
        PointField(name=name, offset=4 * i, datatype=PointField.FLOAT32, count=1)
        for i, name in enumerate('xyz')
    ]
    data = points.astype('<f4').tobytes()
    return PointCloud2(
        header=poses.header, height=1, width=len(points), fields=fields, is_bigendian=False,
        point_step=12, row_step=12 * len(points), data=data, is_dense=True,
    )  # fmt: skip


class Scanner:
    """Scans the newest frame of the trees at a rate [Hz]."""

    def __init__(self, node: rclpy.node.Node, lidar: Lidar, rate: float) -> None:
        self._lidar = lidar
        self._cylinders: Cylinders | None = None
        self._poses: PoseArray | None = None
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(String, 'tree_description', self._describe, latched)
        node.create_subscription(PoseArray, 'segment_poses', self._see, 2)
        self._points = node.create_publisher(PointCloud2, 'points', 2)
        node.create_timer(1.0 / rate, self._scan)

    def _describe(self, message: String) -> None:
        self._cylinders = Cylinders(json.loads(message.data))

    def _see(self, message: PoseArray) -> None:
        self._poses = message

    def _scan(self) -> None:
        poses, cylinders = self._poses, self._cylinders
        if poses is None or cylinders is None or len(poses.poses) != cylinders.n_segments:
            return
        places = [(p.position.x, p.position.y, p.position.z) for p in poses.poses]
        turns = [
            (p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w)
            for p in poses.poses
        ]
        start, axis = cylinders.placed(np.array(places), np.array(turns))
        points = self._lidar.points(start, axis, cylinders.length, cylinders.radius)
        self._points.publish(cloud_of(points, poses))


def main() -> None:
    """Scan until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--at', type=float, nargs=3, default=[10.0, 0.0, 1.5], metavar='M')
    parser.add_argument('--rate', type=float, default=10.0, help='turns per second')
    given = parser.parse_args()
    rclpy.init()
    node = rclpy.create_node('lidar')
    scanner = Scanner(node, Lidar(np.array(given.at)), given.rate)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    del scanner
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
