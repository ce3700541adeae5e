# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree on the wire: its description, and frame by frame its poses and markers."""

from __future__ import annotations

import json
import math
from typing import Any

from std_msgs.msg import String

from tree_sway.core.leaves import LeafClusters
from tree_sway.core.tree import Tree
from tree_sway_ros.process.topics import MARKERS, SEGMENT_POSES, TREE_DESCRIPTION
from tree_sway_ros.timing.divider import Divider
from tree_sway_ros.wire.cdr import pose_array_template
from tree_sway_ros.wire.markers import TreeMarkers
from tree_sway_ros.wire.tree_description import describe
from tree_sway_ros.wire.tree_frames import TreeFrames

_MARKER_RATE = 20.0
"""Pictures per second that RViz draws of a large tree [Hz]."""


class PoseStream:
    """Publisher of one tree, or a forest as one; topics without subscribers are not computed."""

    def __init__(self, node: Any, tree: Tree, leaves: LeafClusters | None = None) -> None:
        values = node.values
        frame_id = values['frame_id']
        self.frames = 0
        self._template = pose_array_template(tree.n_segments, frame_id)
        self.poses = self._template.blocks[0]
        self._pose_publisher = node.publisher(SEGMENT_POSES)
        self._pose_divider = Divider()
        self._marker_divider = Divider()
        self._marker_every = max(1, math.ceil(values['rate'] / _MARKER_RATE))
        self._markers = TreeMarkers(tree, frame_id)
        self._marker_publisher = node.publisher(MARKERS)
        self.tree_frames = TreeFrames(node, tree)
        self._description = String(data=describe(tree, frame_id, self.tree_frames.root, leaves))
        self._description_publisher = node.publisher(TREE_DESCRIPTION)
        self._description_publisher.publish(self._description)

    def add_to_description(self, content: dict[str, Any]) -> None:
        """Add to the description, from any thread, and publish it."""
        whole = {**json.loads(self._description.data), **content}
        self._description = String(data=json.dumps(whole, separators=(',', ':')))
        self._description_publisher.publish(self._description)

    def publish(self, simulator: Any, index: int, stamp: int, every: int) -> None:
        """Publish due messages at a tick; poses are computed if there are subscribers."""
        poses_due = self._pose_divider.is_due(index, every)
        markers_due = self._marker_divider.is_due(index, self._marker_every)
        poses_due = poses_due and self._pose_publisher.get_subscription_count() > 0
        markers_due = markers_due and self._marker_publisher.get_subscription_count() > 0
        frames_due = self.tree_frames.is_due(index)
        if not (poses_due or markers_due or frames_due):
            return
        simulator.place(self.poses)
        if poses_due:
            self._pose_publisher.publish(self._template.to_bytes(stamp))
            self.frames += 1
        if markers_due:
            self._marker_publisher.publish(self._markers.to_bytes(self.poses, stamp))
        if frames_due:
            self.tree_frames.publish(self.poses, stamp)
