# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The frame of a segment: x along it, turned from the axes of the world as little as possible.

Every pose, file and picture that speaks of the frame of a segment means this one.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats


def quaternions_from_x(direction: Floats) -> Floats:
    """
    Orientations w x y z (n, 4), turned as little as possible, whose x axis has directions (n, 3).

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
