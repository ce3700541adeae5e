# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree that has lost a limb."""

from __future__ import annotations

import numpy as np

from tree_sway.core.tree import Tree, tree_from_segments


def without_limb(tree: Tree, name: str) -> Tree:
    """Return a tree without one of its branches and all that it bears."""
    limb = tree.branch_names.index(name)
    left = [b for b in range(tree.n_branches) if not limb <= b < tree.subtree_end[limb]]
    segments = np.flatnonzero(np.isin(tree.branch_of_segment, left))
    number = np.full(tree.n_segments, -1)
    number[segments] = np.arange(len(segments))
    parent = tree.segment_parent[segments]
    return tree_from_segments(
        tree.start[segments],
        tree.end[segments],
        np.stack([tree.base_diameter[segments], tree.tip_diameter[segments]], axis=1),
        parent=np.where(parent < 0, -1, number[parent]),
        branch=tree.branch_of_segment[segments],
        branch_names=[tree.branch_names[b] for b in left],
        name=tree.name,
        species=tree.species,
    )
