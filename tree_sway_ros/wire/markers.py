# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree for RViz: one LINE_LIST per radius class, with fixed ids, as bytes.

One marker per segment is too slow for RViz, and DELETEALL makes it flicker. A few line lists whose
points are overwritten in place cost less than the poses.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway_ros.wire.cdr import block_mark, CdrTemplate, mark_stamp

_BARK = (0.36, 0.25, 0.17, 1.0)
_TWIG = (0.30, 0.45, 0.20, 1.0)


class TreeMarkers:
    """The markers of one tree; classes of radii without segments are left out."""

    def __init__(self, tree: Tree, frame_id: str, n_classes: int = 6) -> None:
        from geometry_msgs.msg import Point
        from visualization_msgs.msg import Marker, MarkerArray

        radius = (tree.base_diameter + tree.tip_diameter) / 4.0
        self._members = radius_classes(radius, n_classes)
        self._length = tree.length
        message = MarkerArray()
        for number, members in enumerate(self._members):
            marker = Marker(ns=tree.name, id=number, type=Marker.LINE_LIST, action=Marker.ADD)
            marker.header.frame_id = frame_id
            mark_stamp(marker.header.stamp, number)
            marker.scale.x = float(2.0 * np.median(radius[members]))
            marker.pose.orientation.w = 1.0
            share = number / max(1, len(self._members) - 1)
            color = [b + share * (t - b) for b, t in zip(_BARK, _TWIG, strict=True)]
            marker.color.r, marker.color.g, marker.color.b, marker.color.a = map(float, color)
            first = Point(x=block_mark(number))
            other = Point()
            marker.points = [first] + [other] * (2 * len(members) - 1)
            message.markers.append(marker)
        shapes = [(len(members), 2, 3) for members in self._members]
        self._template = CdrTemplate(message, len(shapes), shapes)

    def to_bytes(self, poses: NDArray[np.float64], stamp: int) -> bytes:
        """Draw poses (n_segments, 7) at a stamp [ns] as a ``visualization_msgs/MarkerArray``."""
        ends = np.stack(ends_of_poses(poses, self._length), axis=1)
        for block, members in zip(self._template.blocks, self._members, strict=True):
            block[...] = ends[members]
        return self._template.to_bytes(stamp)


def radius_classes(radius: NDArray[np.float64], n_classes: int) -> list[NDArray[np.intp]]:
    """Members of each class, thickest first: equal steps of the logarithm of the radius."""
    log = np.log(radius)
    span = log.max() - log.min()
    if span <= 0.0:
        return [np.arange(len(radius))]
    place = ((log.max() - log) / span * n_classes).astype(int).clip(0, n_classes - 1)
    return [np.flatnonzero(place == k) for k in range(n_classes) if (place == k).any()]
