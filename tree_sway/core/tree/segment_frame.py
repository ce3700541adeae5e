# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Frame of a segment: x along it, with the smallest rotation from the axes of the world.

All poses, files and pictures use this frame, and the ends of segments follow from their poses.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats


def quaternions_from_x(direction: Floats) -> Floats:
    """
    Orientations w x y z (n, 4) of smallest rotation whose x axes have directions (n, 3).

    It is half a turn about z where the direction is -x.
    """
    x, y, z = direction.T
    across = y * y + z * z
    w = np.where(
        x < 0.0, across / (1.0 - np.minimum(x, 0.0)), 1.0 + x
    )  # 1 + x without cancellation
    q = np.stack([w, np.zeros_like(x), -z, y], axis=1)
    q[(x < 0.0) & (across < 1e-30)] = [0.0, 0.0, 0.0, 1.0]
    q /= np.linalg.norm(q, axis=1)[:, None]
    return q


def ends_of_poses(poses: ArrayLike, length: ArrayLike) -> tuple[Floats, Floats]:
    """Root-side and tip-side nodes [m], (n, 3), of segments of lengths [m] at poses (n, 7)."""
    block = np.asarray(poses, dtype=np.float64)
    start = block[:, :3]
    x, y, z, w = block[:, 3:].T
    along = np.stack(
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1
    )
    return start, start + np.asarray(length, dtype=np.float64)[:, None] * along
