# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree cut again: its branches in more or fewer segments, its shape and its motion the same.

A branch moves as one body of few coordinates, so how finely it is cut decides how smoothly it is
drawn and not how it sways (Kanda & Ohya, 3.2). Finer cuts only split segments; every node remains.
Coarser cuts stand evenly along the branch and take the corners between them off. What a branch
carries stays where it is, at the same place along it.

"""

from __future__ import annotations

import heapq

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.tree import Tree, tree_from_segments
from tree_sway.errors import ParameterError

MOST_SEGMENTS = 10_000
"""Largest number of segments of one branch."""


def resegment(
    tree: Tree, segments_per_branch: int | None = None, *, max_segment_length: float | None = None
) -> Tree:
    """
    Cut every branch of a tree again.

    Parameters
    ----------
    tree
        The tree.
    segments_per_branch
        How many segments each branch gets. A twig of more than one segment copies no other.
    max_segment_length
        Or: the longest a segment may be in [m]; each branch gets as few as that allows.

    Returns
    -------
    Tree
        With the same branches under the same names, diameters linear between the cuts.

    Raises
    ------
    ParameterError
        If not just one of the two is given, or it asks for less than 1 or more than
        `MOST_SEGMENTS` a branch.

    """
    counts = _wished(tree, segments_per_branch, max_segment_length)
    cuts = [_cuts(tree, branch, int(count)) for branch, count in enumerate(counts)]
    first = np.concatenate([[0], np.cumsum(counts)])
    pieces = [_pieces(tree, branch, cut) for branch, cut in enumerate(cuts)]
    parent = np.arange(-1, first[-1] - 1)
    parent[0] = -1
    for branch in range(1, tree.n_branches):
        carrier = int(tree.branch_parent[branch])
        carrying = np.searchsorted(cuts[carrier], _place(tree, branch), side='left') - 1
        parent[first[branch]] = first[carrier] + np.clip(carrying, 0, counts[carrier] - 1)
    return tree_from_segments(
        *(np.concatenate(column) for column in zip(*pieces, strict=True)),
        parent=parent,
        branch=np.repeat(np.arange(tree.n_branches), counts),
        branch_names=tree.branch_names,
        name=tree.name,
        species=tree.species,
    )


def _wished(tree: Tree, number: int | None, longest: float | None) -> Ints:
    """Segments of each branch, (b,)."""
    if (number is None) == (longest is None):
        raise ParameterError(
            'a tree is cut by number or by length',
            where='resegment',
            cure='give either segments_per_branch or max_segment_length',
        )
    if longest is None:
        wished = np.full(tree.n_branches, float(number or 0))
    elif longest > 0.0:
        # What fits to rounding is not cut once more.
        wished = np.maximum(np.ceil(tree.branch_length / longest - 1e-9), 1.0)
        n_pieces = np.maximum(np.ceil(tree.length / longest - 1e-9), 1.0)
        sums = np.add.reduceat(n_pieces, tree.branch_first[:-1])
        wished = np.where(wished < np.diff(tree.branch_first), wished, sums)
    else:
        raise ParameterError(
            f'segments of {longest} m', where='max_segment_length', cure='give a length above 0'
        )
    most = float(wished.max())
    if not (1.0 <= float(wished.min()) and most <= MOST_SEGMENTS):
        raise ParameterError(
            f'{most:g} segments in a branch',
            where='resegment',
            cure=f'ask for 1 to {MOST_SEGMENTS}',
        )
    return wished.astype(np.int64)


def _cuts(tree: Tree, branch: int, count: int) -> Floats:
    """
    Where a branch is cut.

    Places are counted in its old segments: 2.25 is a quarter along the third. That is exact at the
    nodes, where arc lengths would not be.

    """
    length = tree.length[tree.segments_of(branch)]
    old = len(length)
    if count < old:
        node = np.concatenate([[0.0], np.cumsum(length)])
        even: Floats = np.interp(np.linspace(0.0, node[-1], count + 1), node, np.arange(old + 1.0))
        return even
    share = np.ones(old, dtype=np.int64)
    longest_first = [(-piece, segment) for segment, piece in enumerate(length.tolist())]
    heapq.heapify(longest_first)
    for _ in range(count - old):
        _, segment = longest_first[0]
        share[segment] += 1
        heapq.heapreplace(longest_first, (-float(length[segment]) / int(share[segment]), segment))
    inner = [segment + np.arange(pieces) / pieces for segment, pieces in enumerate(share)]
    return np.concatenate([*inner, [float(old)]])


def _pieces(tree: Tree, branch: int, cuts: Floats) -> tuple[Floats, Floats, Floats]:
    """Start (m, 3), end (m, 3) and the two diameters (m, 2) of the new segments."""
    here = tree.segments_of(branch)
    start, end = tree.start[here], tree.end[here]
    base, tip = tree.base_diameter[here], tree.tip_diameter[here]
    old = len(start)
    # A cut on a node is the end of one old segment and the start of the next: they need not agree.
    after = np.minimum(np.floor(cuts[:-1]).astype(np.int64), old - 1)
    before = np.maximum(np.ceil(cuts[1:]).astype(np.int64) - 1, 0)
    u, v = cuts[:-1] - after, cuts[1:] - before
    starts = start[after] + u[:, None] * (end - start)[after]
    ends = end[before] - (1.0 - v)[:, None] * (end - start)[before]
    diameters = np.stack(
        [base[after] + u * (tip - base)[after], tip[before] - (1.0 - v) * (tip - base)[before]],
        axis=1,
    )
    return starts, ends, diameters


def _place(tree: Tree, branch: int) -> float:
    """Where a branch sits on its parent, counted in the parent's segments."""
    first = int(tree.branch_first[branch])
    carrying = int(tree.segment_parent[first])
    within = carrying - int(tree.branch_first[tree.branch_parent[branch]])
    return within + float(tree.place_on_parent[first])
