# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What is left of a tree's records when some subtrees move with what they sit on.

A frozen subtree is one rigid body with its parent. Its mass has been the parent's to carry all
along, so its coordinates are crossed out of the matrices and nothing else changes there. Its wind
load joins the parent's, summed as the loads of pieces of one branch are. Solving then knows the
moving branches alone.

Symbols: b branches, m moving ones, N and M their coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Ints
from tree_sway_ros.core.reduction.matrices import Reduction
from tree_sway_ros.core.tree.tree import Tree

Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Pruning:
    """
    Which branches move, and where they stand among their like.

    Parameters
    ----------
    whole
        The tree.
    frozen
        Branches that move with their parent, (b,); with each all that it carries, and never the
        stem.

    """

    whole: Tree
    frozen: Bools

    def __post_init__(self) -> None:
        """Freeze with a branch all that it carries."""
        frozen, parent = self.frozen.copy(), self.whole.branch_parent
        frozen[0] = False
        for branch in range(1, len(frozen)):
            frozen[branch] |= frozen[parent[branch]]
        frozen.setflags(write=False)
        object.__setattr__(self, 'frozen', frozen)

    @property
    def moving(self) -> Ints:
        """Branches that are solved, (m,)."""
        return np.flatnonzero(~self.frozen)

    @property
    def tops(self) -> Ints:
        """Frozen branches that sit on a moving one, (t,)."""
        return np.flatnonzero(self.frozen & ~self.frozen[self.whole.branch_parent])

    @property
    def place_among_moving(self) -> Ints:
        """Index of each branch among the moving, -1 for the frozen and for no branch, (b + 1,)."""
        place = np.full(len(self.frozen) + 1, -1, dtype=np.int64)
        place[self.moving] = np.arange(len(self.moving))
        return place

    def coordinates(self, reduction: Reduction) -> Ints:
        """Coordinates of the moving branches, (M,)."""
        counts = np.diff(reduction.first)
        return np.flatnonzero(np.repeat(~self.frozen, counts))

    def tree(self) -> Tree:
        """Return the moving branches as a tree of their own."""
        tree, moving, place = self.whole, self.moving, self.place_among_moving
        rows = np.flatnonzero(~self.frozen[tree.branch_of_segment])
        row_place = np.full(tree.n_segments + 1, -1, dtype=np.int64)
        row_place[rows] = np.arange(len(rows))
        before = np.concatenate([[0], np.cumsum(~self.frozen)])
        return Tree(
            start=tree.start[rows],
            end=tree.end[rows],
            base_diameter=tree.base_diameter[rows],
            tip_diameter=tree.tip_diameter[rows],
            segment_parent=row_place[tree.segment_parent[rows]],
            branch_first=np.append(row_place[tree.branch_first[moving]], len(rows)),
            branch_parent=place[tree.branch_parent[moving]],
            subtree_end=before[tree.subtree_end[moving]],
            source_index=tree.source_index[rows],
            branch_names=tuple(tree.branch_names[branch] for branch in moving),
            name=tree.name,
            species=tree.species,
        )

    def reduction(self, whole: Reduction) -> Reduction:
        """Cross the frozen coordinates out of the matrices."""
        keep, moving = self.coordinates(whole), self.moving
        counts = np.diff(whole.first)[moving]
        return replace(
            whole,
            first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            partner=np.searchsorted(keep, whole.partner[keep]),
            twist=whole.twist[moving],
            mass=whole.mass[keep][:, keep],
            gravity=whole.gravity[keep][:, keep],
            elastic=whole.elastic[keep][:, keep],
        )

    def carriers(self) -> Ints:
        """Return the moving branch that each moves with: its own, or the nearest below, (b,)."""
        carrier = np.arange(len(self.frozen))
        for branch in np.flatnonzero(self.frozen):
            carrier[branch] = carrier[self.whole.branch_parent[branch]]
        return carrier

    def top_of(self) -> Ints:
        """Frozen branch next to the moving ones that each frozen branch hangs on, (b,)."""
        top = np.arange(len(self.frozen))
        for branch in np.flatnonzero(self.frozen):
            parent = self.whole.branch_parent[branch]
            top[branch] = top[parent] if self.frozen[parent] else branch
        return top
