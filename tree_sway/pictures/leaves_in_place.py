# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Leaves that ride on their segments, each turned about its stalk."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import LeafClusters


def leaf_poses(clusters: LeafClusters, poses: Floats, angle: ArrayLike = 0.0) -> Floats:
    """Pose block (m, 7) of the clusters, from the segments' (n, 7) and angles [rad], (m,)."""
    start = poses[clusters.segment, :3]
    rotation_of_segment = Rotation.from_quat(poses[clusters.segment, 3:])
    orientation_xyzw = clusters.orientation[:, [1, 2, 3, 0]]
    rotation_at_rest = Rotation.from_quat(orientation_xyzw)
    about_stalk = np.zeros_like(start)
    about_stalk[:, 0] = angle
    rotation = rotation_of_segment * rotation_at_rest * Rotation.from_rotvec(about_stalk)
    position = start + rotation_of_segment.apply(clusters.offset)
    return np.hstack([position, rotation.as_quat()])
