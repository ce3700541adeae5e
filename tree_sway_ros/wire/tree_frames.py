# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Frames of a tree for tf: ``tree`` at its place, and ``tree/stem/4`` at the segment ``stem/4``.

The frame of the tree is static. A segment has a frame on /tf once a parameter or a wrench names
it: tf and RViz are too slow for a frame of each segment, which `segment_poses` has. In a namespace
the names begin with it, as ``oak/tree``, because all trees share /tf.
"""

from __future__ import annotations

import math
from typing import Any

from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.errors import nearest, ParameterError
from tree_sway_ros.process.topics import TF, TF_STATIC
from tree_sway_ros.timing.divider import Divider
from tree_sway_ros.wire.cdr import block_mark, CdrTemplate, mark_stamp

MOST = 100
"""Largest number of segments that have frames."""

_RATE = 30.0
"""Largest rate of /tf [Hz]."""


class TreeFrames:
    """
    Publisher of the frames of one tree, or of a forest as one.

    Without tf2_msgs the names are the same, but nothing is published.
    """

    def __init__(self, node: Any, tree: Tree) -> None:
        self.root = '/'.join(filter(None, (node.get_namespace().strip('/'), 'tree')))
        self._base = node.values['frame_id']
        self._rows = {name: row for row, name in enumerate(tree.segment_names)}
        self._shown: list[int] = []
        self._divider = Divider()
        self._every = max(1, math.ceil(node.values['rate'] / _RATE))
        self._template: CdrTemplate | None = None
        self._publisher: Any = None
        if node.values['publish_tf']:
            self._begin(node)
        for name in node.values['segment_frames'].split():
            if name not in self._rows:
                raise ParameterError(
                    f"no segment '{name}'",
                    where="parameter 'segment_frames'",
                    cure=nearest(name, self._rows) or 'tree_description names all',
                )
            self.show(self._rows[name])

    @property
    def example(self) -> str:
        """The frame of the first segment."""
        return f'{self.root}/{next(iter(self._rows))}'

    def row(self, frame_id: str) -> int | None:
        """Row in `segment_poses` of the segment with a frame; None if no segment has it."""
        if not frame_id.startswith(f'{self.root}/'):
            return None
        return self._rows.get(frame_id.removeprefix(f'{self.root}/'))

    def show(self, row: int) -> None:
        """Publish the frame of a segment from now on; beyond `MOST` frames it is left out."""
        if row not in self._shown and len(self._shown) < MOST:
            self._shown.append(row)

    def is_due(self, index: int) -> bool:
        """Whether frames of segments are to be published at that tick."""
        is_due = self._divider.is_due(index, self._every)
        return bool(is_due and self._shown and self._publisher is not None)

    def publish(self, poses: Floats, stamp: int) -> None:
        """Publish the frames of addressed segments: poses (n_segments, 7) at a time [ns]."""
        rows = self._shown[:]  # another thread may add to it
        if self._template is None or len(self._template.blocks) != len(rows):
            names = [*self._rows]
            frame_ids = [f'{self.root}/{names[row]}' for row in rows]
            self._template = transforms_template(self._base, frame_ids)
        for block, row in zip(self._template.blocks, rows, strict=True):
            block[:] = poses[row]
        self._publisher.publish(self._template.to_bytes(stamp))

    def _begin(self, node: Any) -> None:
        """Publish where the tree is; a line of the log where this is impossible."""
        try:
            self._publisher = node.publisher(TF)
            static = node.publisher(TF_STATIC)
        except ImportError:
            node.get_logger().info(
                f"frame '{self.root}' is not on /tf_static: tf2_msgs, of ROS, is not installed"
            )
            return
        self._static = static  # a latched message is there as long as its publisher
        x, y, z, yaw = node.values['pose']
        template = transforms_template(self._base, [self.root])
        template.blocks[0][:3] = x, y, z
        template.blocks[0][3:] = Rotation.from_euler('z', yaw).as_quat()
        static.publish(template.to_bytes(node.get_clock().now().nanoseconds))


def transforms_template(base: str, frame_ids: list[str]) -> CdrTemplate:
    """Bytes of a ``tf2_msgs/TFMessage``; the block (7,) of each frame has x y z qx qy qz qw."""
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    message = TFMessage()
    for number, frame_id in enumerate(frame_ids):
        transform = TransformStamped(child_frame_id=frame_id)
        transform.header.frame_id = base
        mark_stamp(transform.header.stamp, number)
        transform.transform.translation.x = block_mark(number)
        message.transforms.append(transform)
    return CdrTemplate(message, len(frame_ids), [(7,)] * len(frame_ids))
