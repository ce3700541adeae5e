# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The mesh of a tree: a cone for each segment, crossed cards for each cluster of leaves."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.leaves import LeafClusters
from tree_sway.core.species import Spray
from tree_sway.core.tree import Tree

SIDES = 6
"""Number of sides of a cone, even; its volume is 0.827 of the round one's."""

BARK_HEIGHT = 1.2
"""Height of a picture of bark on a stem [m]."""

_CORNERS = np.array([[0.0, -0.5], [1.0, -0.5], [1.0, 0.5], [0.0, 0.5]])
_ROLL, _YAW, _BOW = 0.3, 0.35, 0.1
"""How far cards of clusters differ [rad], and how low a card ends over its length [-]."""

_SPREAD = 0.4
"""Distance of the outermost shoot from the middle of its cluster, over the size of that [-]."""

_FLAT, _SKYWARD, _UPRIGHT = 0.5, 0.55, 0.5
"""
Part of a card's own normal in that by which it is lit, of the sky, and of its height in the crown,
beside its distance from the axis of that, in standard deviations of the cards.
"""


class TreeMesh(NamedTuple):
    """
    Triangles whose vertices move with one segment each.

    Points [m] and normals, (v, 3), are in the frame of the segment: its start, x along it. Texture
    coordinates, (v, 2), go on beyond 1. Triangles, (t, 3), are counter-clockwise seen from
    outside.
    """

    points: Floats
    normals: Floats
    texture: Floats
    segment: Ints
    triangles: Ints

    def placed(self, poses: Floats) -> Floats:
        """Vertices [m], (v, 3), in the frame of poses (n, 7): x y z, and quaternion x y z w."""
        own = poses[self.segment]
        rotation = Rotation.from_quat(own[:, 3:])
        return own[:, :3] + rotation.apply(self.points)

    def turned(self, poses: Floats) -> Floats:
        """Return the normals of the vertices, (v, 3), in the frame of poses (n, 7)."""
        rotation = Rotation.from_quat(poses[self.segment, 3:])
        return rotation.apply(self.normals)


def matrices_of(poses: Floats) -> Floats:
    """Poses (n, 7) as matrices that rows of coordinates and 1 are multiplied by, (n, 4, 4)."""
    matrices = np.tile(np.eye(4), (len(poses), 1, 1))
    rotation = Rotation.from_quat(poses[:, 3:])
    matrices[:, :3, :3] = rotation.inv().as_matrix()
    matrices[:, 3, :3] = poses[:, :3]
    return matrices


def wood_mesh(tree: Tree) -> TreeMesh:
    """
    Return a closed cone per segment, round in its normals, of a ring of vertices at each end.

    Texture coordinates go around and back, without a seam, and on along the branch: the picture is
    as high as `BARK_HEIGHT`, less on small trees.
    """
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    around = np.column_stack([0.0 * angle, np.cos(angle), np.sin(angle)])
    radius = 0.5 * np.column_stack([tree.base_diameter, tree.tip_diameter])
    rings = radius[:, :, None, None] * around
    rings[:, 1, :, 0] = tree.length[:, None]
    taper = radius[:, 0] - radius[:, 1]
    slope = np.arctan2(taper, tree.length)[:, None, None]
    outward = np.cos(slope) * around + np.sin(slope) * [1.0, 0.0, 0.0]
    end = np.cumsum(tree.length)
    start = end - tree.length
    before = start[tree.branch_first[:-1]][tree.branch_of_segment]
    way = np.column_stack([start - before, end - before])
    picture_height = min(BARK_HEIGHT, 0.12 * tree.height)
    across = 1.0 - np.abs(1.0 - angle / np.pi)
    along = way[:, :, None] / picture_height
    texture = np.stack(np.broadcast_arrays(across, along), axis=-1)
    normals = np.tile(outward, (1, 2, 1))  # of both rings
    segment = np.arange(tree.n_segments)
    return _mesh_of_copies(rings, normals, texture, segment, _cone())


def _cone() -> Ints:
    """Triangles of a cone, (t, 3), between its near ring and its far one, and of its ends."""
    near = np.arange(SIDES)
    after = np.roll(near, -1)
    far = near + SIDES
    around = np.column_stack([near, after, after + SIDES, near, after + SIDES, far])
    far_end = np.column_stack([0 * near, near, after])[1:-1] + SIDES
    near_end = far_end[:, [0, 2, 1]] - SIDES
    return np.vstack([around.reshape(-1, 3), near_end, far_end])


def _mesh_of_copies(
    points: Floats, normals: Floats, texture: Floats, segment: Ints, triangles: Ints
) -> TreeMesh:
    """Mesh of copies of one shape, of a segment each, (n, ...), with the triangles of one."""
    corners = points[0].size // 3
    first = corners * np.arange(len(segment))[:, None, None]
    return TreeMesh(
        points.reshape(-1, 3),
        normals.reshape(-1, 3),
        texture.reshape(-1, 2),
        np.repeat(segment, corners),
        (first + triangles).reshape(-1, 3),
    )


def leaf_mesh(leaves: LeafClusters, spray: Spray, cards: int = 2) -> TreeMesh:
    """
    Return cards for each cluster of leaves, to be shown with a picture of its spray.

    They are those of the page (``static/drawing/foliage.js``), up to as many of each cluster as
    are given. Texture coordinates run along the shoot, and across from one side to the other.
    """
    parts = [_cards(leaves, spray, *card) for card in enumerate(spray.rolls[:cards])]
    points, normals = np.concatenate(parts, axis=1)
    return _card_mesh(points, normals, np.tile(leaves.segment, len(parts)))


def crown_mesh(tree: Tree, leaves: LeafClusters, spray: Spray, shoots: int) -> TreeMesh:
    """
    Return the cards of a whole crown, each cluster of leaves as several smaller shoots.

    They are lit as a crown is, by normals that point away from its middle, the more the farther
    they are from it, and to the sky. None reaches below the foot of the tree.
    """
    mesh = leaf_mesh(_parted(leaves, shoots), spray)
    poses = tree.rest_poses
    corners, points, own = (
        each.reshape(-1, 4, 3) for each in (mesh.placed(poses), mesh.points, mesh.normals)
    )
    segment = mesh.segment[::4]
    is_root = tree.segment_parent < 0
    number = np.cumsum(is_root)[segment] - 1  # of its tree in a forest
    centre = corners.mean(axis=1)
    # Not of length 1: that would turn at once in the middle, as light and shade meet at an edge.
    away = centre - _means(centre, number)[number]
    deviation = np.sqrt(_means(away**2, number))
    away /= np.maximum(deviation, 1e-9)[number]
    away[:, 2] = _UPRIGHT * away[:, 2] + _SKYWARD
    rotation = Rotation.from_quat(poses[segment, 3:])
    outward = rotation.inv().apply(away)[:, None]
    # Viewers turn the normals of a back: the front of each card is outside.
    is_back = (own * outward).sum(axis=(1, 2)) < 0.0
    points[is_back] = points[is_back, ::-1]
    own[is_back] = -own[is_back, ::-1]
    normals = _unit(_FLAT * own + outward)
    lowest = corners[..., 2].min(axis=1)
    is_above = lowest >= tree.start[is_root, 2][number]
    return _card_mesh(points[is_above], normals[is_above], segment[is_above])


def _parted(leaves: LeafClusters, shoots: int) -> LeafClusters:
    """Return clusters of the same area in parts that are spread about the shoot of each."""
    columns = vars(leaves).values()
    many = LeafClusters(*(np.repeat(each, shoots, axis=0) for each in columns))
    number = np.tile(np.arange(shoots), len(leaves.segment))
    around = 2.4 * number + many.phase
    # The first part stays in the middle, where the shoot is.
    far = _SPREAD * np.sqrt(number / max(1, shoots - 1))
    along = _SPREAD * (2.0 * (number + 0.5) / shoots - 1.0)
    aside = np.column_stack([along, far * np.cos(around), far * np.sin(around)])
    turns = _turns(many)
    lean = Rotation.from_rotvec(aside[:, [0, 2, 1]] * [0.0, -1.0, 1.0])
    return replace(
        many,
        offset=many.offset + turns.apply(many.size[:, None] * aside),
        orientation=(turns * lean).as_quat()[:, [3, 0, 1, 2]],
        size=many.size / np.sqrt(shoots),
        phase=around % (2.0 * np.pi),
    )


def _turns(leaves: LeafClusters) -> Rotation:
    return Rotation.from_quat(leaves.orientation[:, [1, 2, 3, 0]])


def _means(values: Floats, number: Ints) -> Floats:
    """Mean of the values (m, k) of each number, from 0."""
    sums = [np.bincount(number, column) for column in values.T]
    counts = np.maximum(np.bincount(number), 1)
    return np.stack(sums, axis=1) / counts[:, None]


def _unit(vectors: Floats) -> Floats:
    """Vectors of length 1, (..., 3)."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.maximum(length, 1e-9)


def _card_mesh(points: Floats, normals: Floats, segment: Ints) -> TreeMesh:
    """Mesh of cards from their corners and the normals there, (m, 4, 3)."""
    of_picture = np.tile(_CORNERS + np.array([0.0, 0.5]), (len(points), 1))
    both_halves = np.array([[0, 1, 2], [0, 2, 3]])
    return _mesh_of_copies(points, normals, of_picture, segment, both_halves)


def _cards(leaves: LeafClusters, spray: Spray, card: int, roll: float) -> Floats:
    """Corners and normals of one card of each cluster in the frames of segments, (2, m, 4, 3)."""
    u, v = _CORNERS.T
    rolls = roll + _ROLL * np.sin(leaves.phase)
    yaws = _YAW * np.sin(leaves.phase + 2.1 * card)
    around = Rotation.from_rotvec(np.outer(yaws, [0.0, 0.0, 1.0]))
    around *= Rotation.from_rotvec(np.outer(rolls, [1.0, 0.0, 0.0]))
    turns = _turns(leaves)
    long = spray.length * leaves.size[:, None]
    flat = np.column_stack([u, v * spray.width, 0.0 * u])
    corner = long[..., None] * _turned(around, flat)
    corner[..., 0] -= 0.5 * leaves.size[:, None]
    corner[..., 2] -= _BOW * long * u
    points = leaves.offset[:, None] + _turned(turns, corner)
    bent = np.column_stack([0.3 * u, 1.2 * v, np.ones(4)])
    normals = _turned(turns * around, _unit(bent))
    return np.stack([points, normals])


def _turned(rotations: Rotation, vectors: Floats) -> Floats:
    """Vectors, (4, 3) or (m, 4, 3), by each of rotations, (m, 4, 3)."""
    return vectors @ rotations.inv().as_matrix()
