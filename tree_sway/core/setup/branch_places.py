# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How the branches of a tree are joined and drawn: the data for placing it, before it is laid out.

A plain branch, which has key rotations alone, bends as one smooth curve: each segment rotates by
its slope times the rotation of the branch. The chord then rotates by less than the key, by a third
cumulant of the slopes along the branch, the *skew*.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model import room_for_fields
from tree_sway.core.rotation import quaternion_rotated
from tree_sway.core.setup.beams.branch_model import BranchModel
from tree_sway.core.setup.beams.shape_fields import across
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.tree import Tree


class Places(NamedTuple):
    """
    How branches are joined and drawn: the data for placing a tree, before it is laid out.

    Branches (b,) and segments (n,) are in the order of the tree; k is the largest number of
    coordinates of a branch.
    """

    first: Ints
    """First segment of each branch, and one past the last of all, (b + 1,)."""
    parent: Ints
    base_segment: Ints
    coordinate: Ints
    n_coordinates: Ints
    frame: Floats
    """Chord and the two axes across it, (b, 3, 3)."""
    skew: Floats
    tip_skew: Floats
    offset: Floats
    """Base from the start of the base segment, in the frame of that segment, (b, 3)."""
    base_rotation: Floats
    """Rotation of the base per unit of the parent's coordinates, (b, k, 3)."""
    chord: Floats
    rest: Floats
    slope: Floats
    tip_slope: Floats
    segment_turn: Floats
    """Rotation vector of each segment per unit of its branch's coordinates, (n, k, 3)."""


def places_of(tree: Tree, models: list[BranchModel], reduction: Reduction) -> Places:
    """Find how the modelled branches of a tree are joined and drawn."""
    base_segment = tree.segment_parent[tree.branch_first[:-1]]
    chord = np.array([model.beam.chord for model in models])
    e1, e2 = across(chord)
    slope = np.concatenate([model.shape.segment_slope for model in models])
    tip_slope = _slopes_by_tip_load(tree, slope)
    return Places(
        first=tree.branch_first,
        parent=tree.branch_parent,
        base_segment=base_segment,
        coordinate=reduction.first[:-1],
        n_coordinates=np.array([len(model.fields) for model in models]),
        frame=np.stack([chord, e1, e2], axis=1),
        skew=_skew(tree, slope),
        tip_skew=_skew(tree, tip_slope),
        offset=_offsets(tree, base_segment),
        base_rotation=reduction.twist[:, :, 3:],
        chord=_next_nodes(tree) - tree.start,
        rest=tree.rest_frame,
        slope=slope,
        tip_slope=tip_slope,
        # A plain branch rotates by one slope about the axes across its chord.
        segment_turn=_segment_turns(tree, models, slope, np.stack([e2, -e1], axis=1)),
    )


def _next_nodes(tree: Tree) -> Floats:
    """Return where the next segment of the branch begins, or the last one ends, (n, 3)."""
    following = tree.end.copy()
    has_next = np.ones(tree.n_segments, dtype=bool)
    has_next[tree.branch_first[1:] - 1] = False
    following[has_next] = tree.start[1:][has_next[:-1]]
    return following


def _offsets(tree: Tree, base_segment: Ints) -> Floats:
    """Return each base from the start of its base segment, in that segment's frame, (b, 3)."""
    base = tree.start[tree.branch_first[:-1]]
    back = tree.rest_frame[base_segment] * [1.0, -1.0, -1.0, -1.0]
    in_frame = quaternion_rotated(back, base - tree.start[base_segment])
    is_joined = base_segment[:, None] >= 0
    return np.where(is_joined, in_frame, 0.0)


def _segment_turns(
    tree: Tree, models: list[BranchModel], slope: Floats, key_axes: Floats
) -> Floats:
    """
    Return the rotation of each segment per unit of its branch's coordinates, (n, k, 3).

    ``key_axes`` are those about which the key rotations of each branch are, (b, 2, 3).
    """
    most = max(len(model.fields) for model in models)
    modes = np.zeros((tree.n_segments, room_for_fields(most), 3))
    modes[:, :2] = slope[:, None, None] * key_axes[tree.branch_of_segment]
    for branch, model in enumerate(models):
        if len(model.fields) > 2:
            own = [model.beam.over_segments(field.slope) for field in model.fields]
            modes[tree.segments_of(branch), : len(own)] = np.stack(own, axis=1)
    return modes


def _skew(tree: Tree, slope: Floats) -> Floats:
    """
    Return the lag of the chord's angle per cube of the key rotation, (b,).

    It is a sixth of the third cumulant of the slopes (n,) along each branch.
    """
    share = tree.length / _length_of_branch(tree)
    deviation = slope - _over_branch(tree, share * slope)
    return _sums(tree, share * deviation**3) / 6.0


def _slopes_by_tip_load(tree: Tree, slope: Floats) -> Floats:
    """
    Return the slope of each segment under a load at the tip, (n,), of the same mean as a slope.

    It is the mean over the segment of 1.5 (2 u - u^2), u the arc length over the length.
    """
    whole = _length_of_branch(tree)
    mean = _over_branch(tree, slope * tree.length) / whole
    passed = np.cumsum(tree.length)
    first = tree.branch_first[:-1]
    before_branch = passed[first] - tree.length[first]
    end = (passed - before_branch[tree.branch_of_segment]) / whole
    start = end - tree.length / whole
    # The integral of 2 u - u^2 from start to end, over their difference.
    steepness = end + start - (end * end + end * start + start * start) / 3.0
    return np.asarray(1.5 * mean * steepness)


def _length_of_branch(tree: Tree) -> Floats:
    """Return the length of the branch of each segment in [m], (n,)."""
    return _over_branch(tree, tree.length)


def _over_branch(tree: Tree, values: Floats) -> Floats:
    """Return for each segment the sum of values (n,) over its branch, (n,)."""
    return np.asarray(_sums(tree, values)[tree.branch_of_segment])


def _sums(tree: Tree, values: Floats) -> Floats:
    """Sum values of segments (n,) over each branch, (b,)."""
    return np.add.reduceat(values, tree.branch_first[:-1])
