# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as arrays: segments in depth-first order, grouped in branches.

`Tree` has nodes, diameters and parents as read-only arrays. Segments are sorted such that every
subtree is one slice, so that sums over what a branch carries are differences of running sums.
`tree_from_segments` makes one from segments in any order: it checks them, infers parents from
places where they are missing (`parents_first`), follows the thickest child for a branch, and names
what is wrong with the first bad segment.

`oddities` and `refuse_implausible` compare a tree with what is known of trees (`plausibility`);
`ends_of_poses` and `tips_of_poses` read poses of segments, whose frames `segment_frame` defines.
`GrownTree` is anything with a tree and its species.

Here is no wind and no motion; wood is in `species`, leaves are in `leaves`.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.tree.building import check_numbers as check_numbers
    from tree_sway.core.tree.building import tree_from_segments as tree_from_segments
    from tree_sway.core.tree.grown_tree import GrownTree as GrownTree
    from tree_sway.core.tree.grown_tree import rooted as rooted
    from tree_sway.core.tree.grown_tree import tree_and_species as tree_and_species
    from tree_sway.core.tree.parents_first import chain_starts as chain_starts
    from tree_sway.core.tree.parents_first import checked_order as checked_order
    from tree_sway.core.tree.parents_first import first_of_each as first_of_each
    from tree_sway.core.tree.plausibility import oddities as oddities
    from tree_sway.core.tree.plausibility import refuse_implausible as refuse_implausible
    from tree_sway.core.tree.segment_frame import ends_of_poses as ends_of_poses
    from tree_sway.core.tree.tree import tips_of_poses as tips_of_poses
    from tree_sway.core.tree.tree import Tree as Tree
    from tree_sway.core.tree.tree import tree_in_order as tree_in_order
else:
    __getattr__, __dir__, __all__ = face(__name__)
