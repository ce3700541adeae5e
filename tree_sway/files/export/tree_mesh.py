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

SIDES = 6
"""Number of sides of a cone, even; its volume is 0.827 of the round one's."""


@dataclass(frozen=True)
class TreeMesh:
    """
    Triangles whose vertices move with one segment each.

    Points [m] and normals, (v, 3), are in the frame of the segment: its start, x along it. Texture
    coordinates, (v, 2), are within 0 .. 1. Triangles, (t, 3), are counter-clockwise seen from
    outside.
    """

    points: Floats
    normals: Floats
    texture: Floats
    segment: Ints
    triangles: Ints

    def placed(self, poses: Floats) -> Floats:
        """Vertices [m], (v, 3), in the frame of poses (n, 7): x y z, and quaternion x y z w."""
        rotation = Rotation.from_quat(poses[self.segment, 3:])
        return poses[self.segment, :3] + rotation.apply(self.points)


def wood_mesh(tree: Tree) -> TreeMesh:
    """
    Return a closed cone per segment, round in its normals, of a ring of vertices at each end.

    Texture coordinates go around and back, without a seam, and along the whole branch.
    """
    n = tree.n_segments
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    around = np.stack([np.zeros(SIDES), np.cos(angle), np.sin(angle)], axis=1)
    base, tip = 0.5 * tree.base_diameter, 0.5 * tree.tip_diameter
    rings = np.stack([base[:, None, None] * around, tip[:, None, None] * around], axis=1)
    rings[:, 1, :, 0] = tree.length[:, None]
    slope = np.arctan2(base - tip, tree.length)[:, None, None]
    outward = np.cos(slope) * around + np.sin(slope) * np.array([1.0, 0.0, 0.0])
    texture = np.empty((n, 2, SIDES, 2))
    texture[..., 0] = 1.0 - np.abs(1.0 - 2.0 * np.arange(SIDES) / SIDES)
    end = np.cumsum(tree.length)
    before = (end - tree.length)[tree.branch_first[:-1]][tree.branch_of_segment]
    ends = np.stack([end - tree.length - before, end - before], axis=1)
    texture[..., 1] = (ends / tree.branch_length[tree.branch_of_segment, None])[:, :, None]
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    fan = np.arange(1, SIDES - 1)
    first, last = np.zeros_like(fan), np.full_like(fan, SIDES)
    triangles = np.vstack(
        [
            np.stack([i, j, j + SIDES], axis=1),
            np.stack([i, j + SIDES, i + SIDES], axis=1),
            np.stack([first, fan + 1, fan], axis=1),
            np.stack([last, last + fan, last + fan + 1], axis=1),
        ]
    )
    return TreeMesh(
        rings.reshape(-1, 3),
        np.stack([outward, outward], axis=1).reshape(-1, 3),
        np.clip(texture.reshape(-1, 2), 0.0, 1.0),
        np.repeat(np.arange(n), 2 * SIDES),
        (2 * SIDES * np.arange(n)[:, None, None] + triangles).reshape(-1, 3),
    )


def leaf_mesh(leaves: LeafClusters) -> TreeMesh:
    """Return a lozenge for each cluster of leaves, as long as the cluster is wide."""
    half = 0.5 * leaves.size[:, None, None]
    lozenge = np.array([[-1.0, 0.0, 0.0], [0.2, -0.6, 0.0], [1.0, 0.0, 0.0], [0.2, 0.6, 0.0]])
    corners = half * lozenge
    turns = Rotation.from_quat(leaves.orientation[:, [1, 2, 3, 0]])
    points = np.stack([turns.apply(corners[:, k]) + leaves.offset for k in range(4)], axis=1)
    normals = np.repeat(turns.apply([0.0, 0.0, 1.0])[:, None], 4, axis=1)
    two = np.array([[0, 1, 2], [0, 2, 3]])
    return TreeMesh(
        points.reshape(-1, 3),
        normals.reshape(-1, 3),
        np.tile(0.5 + 0.5 * lozenge[:, :2], (len(leaves.size), 1)),
        np.repeat(leaves.segment.astype(np.int64), 4),
        (4 * np.arange(len(leaves.size))[:, None, None] + two).reshape(-1, 3),
    )
