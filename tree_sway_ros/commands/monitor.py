# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Receiver of a swaying tree, as any other program: poses as bytes, over DDS."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.errors import TransportError
from tree_sway_ros.commands.totals import StreamTotals
from tree_sway_ros.process.listener import Listener
from tree_sway_ros.process.topics import (
    message_class,
    qos_profile,
    SEGMENT_POSES,
    WIND,
    WIND_FILTERED,
)
from tree_sway_ros.wire.cdr import poses_of, stamp_of
from tree_sway_ros.wire.wind_messages import wind_from_message

_QUEUE = 50
"""Length of the queue: messages that arrive while this program is busy are late, not missing."""
_LOOK_AROUND = 1.0  # [s]: time of discovery of running programs


class StreamMonitor(Listener):
    """
    A node that receives poses and wind; without a tree it only counts poses.

    With a tree, pose arrays of a different number of segments are those of another program: they
    are counted apart.
    """

    def __init__(self, context: Any, tree: Tree | None, namespace: str = '') -> None:
        super().__init__('monitor', namespace, context)
        self.totals = StreamTotals()
        self.recent = StreamTotals()
        self._tree = tree
        self._tip = 0 if tree is None else int(np.argmax(tree.end[:, 2]))
        for topic, callback, raw in (
            (SEGMENT_POSES, self._receive_poses, True),
            (WIND_FILTERED, self._receive_wind, False),
        ):
            qos = qos_profile(topic)
            qos.depth = _QUEUE
            self.node.create_subscription(message_class(topic), topic.name, callback, qos, raw=raw)

    def expect_silence(self) -> None:
        """Raise a `TransportError` if a program publishes: two winds or trees would mix."""
        self.spin(_LOOK_AROUND)
        for topic in (WIND, SEGMENT_POSES):
            if self.node.count_publishers(topic.name):
                raise TransportError(
                    f"a different program publishes '{topic.name}' in this ROS domain",
                    cure='end it, or set ROS_DOMAIN_ID to another number up to 101',
                )

    def restart(self) -> None:
        """Reset all counts."""
        self.totals = StreamTotals()
        self.recent = StreamTotals()

    def take_recent(self) -> StreamTotals:
        """Return statistics since the last call."""
        recent = self.recent
        self.recent = StreamTotals()
        return recent

    def _receive_poses(self, data: bytes) -> None:
        arrival = time.time()
        poses = poses_of(data)
        if poses is not None and self._tree is not None and len(poses) != self._tree.n_segments:
            poses = None
        for totals in (self.totals, self.recent):
            if poses is None:
                totals.foreign += 1
            else:
                totals.add_poses(arrival, 1e-9 * stamp_of(data), self._displacement(poses))

    def _displacement(self, poses: Floats) -> Floats:
        """Displacement of the highest tip from rest in [m], (3,)."""
        if self._tree is None:
            return np.zeros(3)
        pose = poses[self._tip, None]
        _, end = ends_of_poses(pose, self._tree.length[self._tip, None])
        return end[0] - self._tree.end[self._tip]

    def _receive_wind(self, message: Any) -> None:
        sample = wind_from_message(message)
        wind = np.array([sample.u, sample.v, sample.w])
        for totals in (self.totals, self.recent):
            totals.wind.add(1e-9 * sample.stamp, wind)
