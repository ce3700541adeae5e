# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Planar followers: the other segments of a branch by geometry, joined from the root (2.2.2, fig. 2).

The slope grows evenly along the branch, so that it bends to an arc whose chord turns by the key
angle; every segment keeps its length. A branch moves with the segment that bears it.

"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway_lab.paper.key_segments import KeySegments


def followed(
    tree: Tree, keys: KeySegments, angle: Floats, branches: Iterable[int] | None = None
) -> tuple[Floats, Floats]:
    """
    Place every segment of a plant.

    Parameters
    ----------
    tree, keys
        The plant and its key segments.
    angle
        Key angle of each branch in [rad], (b,).
    branches
        Which branches, those that carry them included, parents first; all if None.

    Returns
    -------
    start, end
        Nodes of the segments in [m], (n, 3) each; of other branches at rest.

    """
    start, end = tree.start.copy(), tree.end.copy()
    turned = np.tile(np.eye(3), (tree.n_segments, 1, 1))
    for branch in range(tree.n_branches) if branches is None else branches:
        part = tree.segments_of(branch)
        rows = tree.end[part] - tree.start[part]
        lengths = tree.length[part]
        middle = (np.cumsum(lengths) - 0.5 * lengths) / lengths.sum()
        axis = np.cross(keys.along[branch], keys.across[branch])
        bent = np.stack([_rotation(axis, 2.0 * angle[branch] * s) for s in middle])
        base = int(tree.segment_parent[part.start])
        foot = tree.start[part.start]
        if base >= 0:
            bent = turned[base] @ bent
            foot = start[base] + turned[base] @ (foot - tree.start[base])
        turned[part] = bent
        ends = foot + np.cumsum(np.einsum('sij,sj->si', bent, rows), axis=0)
        end[part] = ends
        start[part] = np.vstack([foot, ends[:-1]])
    return start, end


def _rotation(axis: Floats, angle: float) -> Floats:
    """Rotation matrix about a unit axis by an angle in [rad] (Rodrigues 1840)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)
