# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The mesh of a tree: a cone for each segment, a lozenge for each cluster of leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.tree import Tree

SIDES = 8
"""Sides of a cone; its volume is 0.900 of the round one's."""


@dataclass(frozen=True)
class TreeMesh:
    """
    Triangles, each vertex of which is carried by one segment.

    Points [m] and normals, (v, 3), are in the frame of the segment: its start, x along it.
    Triangles, (t, 3), are counter-clockwise seen from outside.
    """

    points: Floats
    normals: Floats
    segment: Ints
    triangles: Ints

    def placed(self, poses: Floats) -> Floats:
        """Vertices [m], (v, 3), in the frame of poses (n, 7): x y z, and quaternion x y z w."""
        rotation = Rotation.from_quat(poses[self.segment, 3:])
        return poses[self.segment, :3] + rotation.apply(self.points)


def wood_mesh(tree: Tree) -> TreeMesh:
    """
    Return a closed cone per segment, round in its normals, with flat ends.

    It has 4 `SIDES` vertices: two rings for its side and one for each end.
    """
    n = tree.n_segments
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    around = np.stack([np.zeros(SIDES), np.cos(angle), np.sin(angle)], axis=1)
    base, tip = 0.5 * tree.base_diameter, 0.5 * tree.tip_diameter
    rings = np.stack([base[:, None, None] * around, tip[:, None, None] * around], axis=1)
    rings[:, 1, :, 0] = tree.length[:, None]
    slope = np.arctan2(base - tip, tree.length)[:, None, None]
    outward = np.cos(slope) * around + np.sin(slope) * np.array([1.0, 0.0, 0.0])
    ends = np.broadcast_to(np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])[:, None], rings.shape)
    normals = np.concatenate([np.stack([outward, outward], axis=1), ends], axis=1)
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    fan = np.arange(1, SIDES - 1)
    first, last = 2 * SIDES, 3 * SIDES
    triangles = np.vstack(
        [
            np.stack([i, j, j + SIDES], axis=1),
            np.stack([i, j + SIDES, i + SIDES], axis=1),
            np.stack([np.full_like(fan, first), first + fan + 1, first + fan], axis=1),
            np.stack([np.full_like(fan, last), last + fan, last + fan + 1], axis=1),
        ]
    )
    return TreeMesh(
        np.concatenate([rings, rings], axis=1).reshape(-1, 3),
        normals.reshape(-1, 3),
        np.repeat(np.arange(n), 4 * SIDES),
        (4 * SIDES * np.arange(n)[:, None, None] + triangles).reshape(-1, 3),
    )


def leaf_mesh(leaves: LeafClusters) -> TreeMesh:
    """Return a lozenge for each cluster of leaves, as long as the cluster is wide."""
    half = 0.5 * leaves.size[:, None, None]
    corners = half * np.array([[-1.0, 0, 0], [0.2, -0.6, 0], [1.0, 0, 0], [0.2, 0.6, 0]])
    turns = Rotation.from_quat(leaves.orientation[:, [1, 2, 3, 0]])
    points = np.stack([turns.apply(corners[:, k]) + leaves.offset for k in range(4)], axis=1)
    normals = np.repeat(turns.apply([0.0, 0.0, 1.0])[:, None], 4, axis=1)
    two = np.array([[0, 1, 2], [0, 2, 3]])
    return TreeMesh(
        points.reshape(-1, 3),
        normals.reshape(-1, 3),
        np.repeat(leaves.segment.astype(np.int64), 4),
        (4 * np.arange(len(leaves.size))[:, None, None] + two).reshape(-1, 3),
    )
