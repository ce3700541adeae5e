# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Points of a picture matched to segments of the tree, and how each coordinate moves them."""

from __future__ import annotations

from typing import NamedTuple, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.twin.camera.pinhole import Camera
from tree_sway.twin.sensor_place import slopes_at_rest

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

_APART = 0.03
"""Distance of two places along a ray, over the height of the tree, from which they are two."""

_BEHIND = 20.0
"""Gap in pixels from which a point is not of the tree."""


class LimbPoints(NamedTuple):
    """
    Points on segments.

    Parameters
    ----------
    segment
        Segment of each, (p,).
    away
        Distance of each from the root side of its segment in [m], (p,).
    row
        Number of each among the points of the picture, (p,).

    """

    segment: Ints
    away: Floats
    row: Ints

    def at(self, poses: Floats) -> Floats:
        """Places in [m] in a pose block (n, 7), (p, 3)."""
        return ends_of_poses(poses[self.segment], self.away)[1]

    def slopes(self, simulator: SwaySimulator) -> Floats:
        """Differentiate the places by each coordinate of a simulator, at rest, (p, 3, m)."""
        return slopes_at_rest(simulator, self.at)


class DrawnWood(NamedTuple):
    """Segments in a picture: ends (s, 2), width and, ahead of the camera in [m], depth, (s,)."""

    first: Floats
    last: Floats
    width: Floats
    depth: Floats


def drawn_wood(camera: Camera, start: Floats, end: Floats, diameter: Floats) -> DrawnWood:
    """Find where a camera sees segments from their ends (s, 3) and diameters (s,) in [m]."""
    depth = camera.depth(0.5 * (start + end))
    width = camera.focal * diameter / np.maximum(depth, 0.1)
    return DrawnWood(camera.project(start), camera.project(end), width, depth)


def matched_points(
    tree: Tree, poses: Floats, camera: Camera, image: Floats, within: float = 2.0
) -> LimbPoints:
    """
    Find the segment on which each point of a picture is.

    Of segments at a point the foremost one is seen. A point that other wood is near, farther back
    or farther in front, may be a crossing of edges, which moves as neither does: it is left out.

    Parameters
    ----------
    tree
        The tree.
    poses
        Poses of its segments in that picture, (n, 7).
    camera
        The camera.
    image
        Points in pixels, (k, 2).
    within
        How far beside the wood a point may be in pixels.

    """
    start, end = ends_of_poses(poses, tree.length)
    wood = drawn_wood(camera, start, end, tree.base_diameter)
    depth = wood.depth
    apart = _APART * np.ptp(end[:, 2])
    found = []
    for row, (share, gap) in enumerate(zip(*_nearest(wood, image), strict=True)):
        near = np.flatnonzero(gap < within)
        if not len(near):
            continue
        places = start[near] + share[near, None] * (end[near] - start[near])
        covers = gap[near] < 0.5
        best = np.argmin(np.where(covers, depth[near], gap[near] + 1e6))
        if np.linalg.norm(places - places[best], axis=1).max() < apart + 2.0 * float(
            tree.base_diameter[near[best]]
        ):
            segment = near[best]
            found.append((segment, share[segment] * tree.length[segment], row))
    segments, away, rows = np.array(found).reshape(-1, 3).T.copy()
    return LimbPoints(segments.astype(np.int64), away, rows.astype(np.int64))


def points_behind(tree: Tree, poses: Floats, camera: Camera, image: Floats) -> Ints:
    """Find points (k, 2) of a picture that are far from all wood: their numbers."""
    wood = drawn_wood(camera, *ends_of_poses(poses, tree.length), tree.base_diameter)
    return np.flatnonzero(_nearest(wood, image)[1].min(axis=1) > _BEHIND)


def _nearest(wood: DrawnWood, image: Floats) -> tuple[Floats, Floats]:
    """Share of each segment that is nearest to each point, and the gap in pixels, (k, s)."""
    along = wood.last - wood.first
    square = np.maximum(np.square(along).sum(axis=1), 1e-12)
    apart = image[:, None] - wood.first
    share = np.clip((apart * along).sum(axis=2) / square, 0.0, 1.0)
    gap = np.linalg.norm(apart - share[..., None] * along, axis=2) - 0.5 * wood.width
    return share, gap
