# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cut branches that rotate far in the wind, are curved or have many children into key segments.

One key segment bends as one shape and meets the wind as one body. A branch that rotates by more
than some 15 degrees has other shapes in strong wind than in a breeze, and the two ends of a curved
branch meet the wind at different angles. Each such branch is a chain of key segments, as in the
paper (Kanda & Ohya 2003, 3.2): each piece is a branch on the one before.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import Tree

_TURN = np.deg2rad(15.0)
"""Largest rotation of one key segment in [rad]."""

_BOW = np.deg2rad(15.0)
"""Largest angle between the ends of one key segment at rest in [rad]."""

_MOST_PIECES, _MOST_LIMP_PIECES = 3, 4
"""
Largest number of pieces of a branch that rotates far; more add little. That of a limp tree, whose
twigs move in short waves in storms: with 6, its energy grows without damping.
"""

CARRIED, _MOST_CARRYING = 6, 6
"""
Largest number of children of one key segment, and of pieces for them: limbs that swing against
each other bend a stem between their bases, by more shapes than one key segment has.

"""


@dataclass(frozen=True)
class CutTree:
    """
    A tree whose branches are pieces of those of a whole tree.

    Parameters
    ----------
    tree
        The pieces as branches.
    branch
        Branch of which each piece is a part, (p,).
    row
        Row of each segment in the other tree, (n,).
    share
        Length of each piece over that of its branch, (p,).

    """

    tree: Tree
    branch: Ints
    row: Ints
    share: Floats


def whole_tree(tree: Tree) -> CutTree:
    """Return a tree that is not cut."""
    b = tree.n_branches
    return CutTree(tree, np.arange(b), np.arange(tree.n_segments), np.ones(b))


def pieces_by_turn(tree: Tree, turn: Floats, *, is_limp: bool = False) -> Ints:
    """
    Count key segments of branches, (b,), by rotation [rad], (b,), curvature and children.

    A piece has two segments or more.
    """
    base = tree.direction[tree.branch_first[:-1]]
    tip = tree.direction[tree.branch_first[1:] - 1]
    cosine = np.einsum('bk,bk->b', base, tip)
    bow = np.arccos(np.clip(cosine, -1.0, 1.0))
    for_turn = np.nan_to_num(np.maximum(turn / _TURN, bow / _BOW), nan=1.0)
    for_turn = np.minimum(for_turn, _MOST_LIMP_PIECES if is_limp else _MOST_PIECES)
    n_children = np.bincount(tree.branch_parent[1:], minlength=tree.n_branches)
    for_children = np.minimum(n_children / CARRIED, _MOST_CARRYING)
    wanted = np.ceil(np.maximum(for_turn, for_children)).astype(np.int64)
    most = np.maximum(np.diff(tree.branch_first) // 2, 1)
    return np.asarray(np.clip(wanted, 1, most))


def cut_tree(tree: Tree, pieces: Ints) -> CutTree:
    """Cut each branch at nodes into a number of pieces, (b,), of about as many segments."""
    if (pieces == 1).all():
        return whole_tree(tree)
    from tree_sway.core.tree import tree_from_segments

    # By segment: its place in its branch, and the size, pieces and first piece of that.
    own = tree.branch_of_segment
    size = np.diff(tree.branch_first)[own]
    within = np.arange(tree.n_segments) - tree.branch_first[own]
    first_piece = np.cumsum(pieces) - pieces
    piece = first_piece[own] + within * pieces[own] // size
    names = np.repeat(np.array(tree.branch_names, dtype=object), pieces)
    cut = tree_from_segments(
        tree.start,
        tree.end,
        np.stack([tree.base_diameter, tree.tip_diameter], axis=1),
        parent=tree.segment_parent,
        branch=piece,
        branch_names=names.tolist(),
        name=tree.name,
        species=tree.species,
    )
    branch = own[cut.source_index[cut.branch_first[:-1]]]
    share = cut.branch_length / tree.branch_length[branch]
    return CutTree(cut, branch, cut.source_index, share)
