# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ends of segments, and tips of branches, from a block of poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree.tree import Tree


def ends_of_poses(poses: ArrayLike, length: ArrayLike) -> tuple[Floats, Floats]:
    """Root-side and tip-side nodes [m], (n, 3), of segments of lengths [m] at poses (n, 7)."""
    block = np.asarray(poses, dtype=np.float64)
    start = block[:, :3]
    x, y, z, w = block[:, 3:].T
    along = np.stack(
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1
    )
    return start, start + np.asarray(length, dtype=np.float64)[:, None] * along


def tips_of_poses(tree: Tree, poses: Floats, branches: Ints | slice = slice(None)) -> Floats:
    """Tips of some branches, or of all, in [m], (k, 3), from a pose block (n, 7)."""
    last = tree.branch_first[1:][branches] - 1
    return ends_of_poses(poses[last], tree.length[last])[1]
