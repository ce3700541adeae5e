# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From arrays to the records for placing: `segment_records` and `block_records`.

`Places` has how a tree is joined and drawn, which suffices to place it, as for a receiver of the
stream. Segments and branches are laid out in slots.
"""

from __future__ import annotations

from heapq import heappop, heappush
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.model.records import (
    block_layout,
    segment_layout,
    WIDTH,
    zeros_in_lines,
)
from tree_sway.core.rotation import rotated


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


_OF_PLACES = (
    'parent', 'base_segment', 'coordinate', 'n_coordinates', 'frame', 'offset', 'skew',
    'tip_skew',
)  # fmt: skip
"""Fields of a branch's record that are those of `Places`."""


def segment_records(places: Places) -> Records:
    """Fill the segments for placing: records of `segment_layout`, in blocks."""
    block, slot, n_records = assign_slots(places.first, places.parent, places.n_coordinates)
    n_modes = places.segment_turn.shape[1]
    records = zeros_in_lines(n_records, segment_layout(n_modes))
    records['rest'][:, 0] = 1.0
    size = np.diff(places.first)
    rows = np.arange(len(places.slope)) + np.repeat(block - places.first[:-1], size)
    own = np.repeat(slot, size)
    for name in ('chord', 'rest', 'slope', 'tip_slope'):
        records[name][rows, ..., own] = getattr(places, name)
    np.maximum.at(records['n_slots'], rows, own + 1)
    if n_modes > 2:
        records['segment_turn'][rows, :n_modes, :, own] = places.segment_turn
    return records


def fill_places(places: Places, records: Records) -> None:
    """Fill the fields for placing in records of `branch_layout`, (b,)."""
    block, slot, _ = assign_slots(places.first, places.parent, places.n_coordinates)
    records['first_record'] = block
    records['slot'] = slot
    records['first'] = places.first[:-1]
    records['end'] = places.first[1:]
    for name in _OF_PLACES:
        records[name] = getattr(places, name)
    k = min(places.base_rotation.shape[1], records['twist'].shape[1])
    records['twist'][:, :k, 3:] = places.base_rotation[:, :k]
    begin = places.first[:-1]
    per_segment = np.square(places.segment_turn).sum(axis=2)
    steepest = np.maximum.reduceat(per_segment, begin)
    steepest[:, 0] = np.maximum(
        steepest[:, 0], np.maximum.reduceat(np.square(places.tip_slope), begin)
    )
    records['steepest'][:, : steepest.shape[1]] = steepest


def block_records(branches: Records, segments: Records) -> Records:
    """
    Lay the fields for placing out in blocks, from `Branch` records whose coordinates are set.

    Records are of `block_layout`, one per block of `assign_slots` and one of scratch memory.
    """
    first, block = np.unique(branches['first_record'], return_inverse=True)
    slot = branches['slot']
    parent = branches['parent']
    count = branches['n_coordinates']
    blocks = zeros_in_lines(len(first) + 1, block_layout(branches.dtype['load_mode'].shape[0]))
    blocks['first_record'] = [*first, len(segments)]
    blocks['n_records'][:-1] = np.diff(blocks['first_record'])
    blocks['n_slots'][:-1] = segments['n_slots'][first]
    blocks['n_eights'] = -(-blocks['n_slots'] // 8)
    blocks['is_joined'][:-1] = np.logical_and.reduceat(_joined(segments), first)
    np.maximum.at(blocks['n_parents'], block[parent[1:]], slot[parent[1:]] + 1)
    np.maximum.at(blocks['n_rows'], block, count)
    np.maximum.at(blocks['n_parent_rows'], block, count[parent])
    blocks['branch'][block, slot] = np.arange(len(branches))
    for name in _OF_BRANCHES:
        blocks[name][block, ..., slot] = branches[name]
    blocks['base_rotation'][block, ..., slot] = branches['twist'][..., 3:]
    blocks['bound_factor'][block, slot] = count - 1
    blocks['parent_coordinate'][block, slot] = branches['coordinate'][parent]
    ahead = blocks['offset'][:, :1]
    beside = np.abs(blocks['offset'][:, 1:])
    blocks['is_at_axes'] = (beside <= _AS_ONE * ahead).all(axis=(1, 2))
    return blocks


_OF_BRANCHES = (
    'parent', 'coordinate', 'base_segment', 'first', 'frame', 'skew', 'tip_skew', 'offset',
    'steepest',
)  # fmt: skip
"""Fields of a block that are those of its branches."""


_rotated = rotated.py_func  # type: ignore[attr-defined]  # whole arrays at once
_AS_ONE = 1e-12
"""
Largest deviation of a segment from a chord that it is taken to span, as a share of the chord.
"""


def _joined(segments: Records) -> NDArray[np.bool_]:
    """Fill chords in the frames of their segments; return where the chord is the x axis."""
    w, x, y, z = np.moveaxis(segments['rest'], 1, 0)
    own_chord = _rotated(w, -x, -y, -z, *np.moveaxis(segments['chord'], 1, 0))
    segments['own_chord'] = np.stack(own_chord, axis=1)
    return (np.hypot(own_chord[1], own_chord[2]) <= _AS_ONE * own_chord[0]).all(axis=1)


def assign_slots(
    first: Ints, branch_parent: Ints, fields: Ints | None = None
) -> tuple[Ints, Ints, int]:
    """
    Assign a slot of a block to each branch: parents first, similar lengths together.

    Branches of similar numbers of ``fields`` (b,), if given, are together as well.

    Returns
    -------
    tuple
        First record (b,) and slot (b,) of each branch; number of records.

    """
    size = np.diff(first).tolist()
    count = len(size)
    children: list[list[int]] = [[] for _ in size]
    carried = [1] * count
    parents = branch_parent.tolist()
    for branch in range(count - 1, 0, -1):
        children[parents[branch]].insert(0, branch)
        carried[parents[branch]] += carried[branch]
    # The time to place sixteen branches is that of the one with most fields.
    n_fields = [0] * count if fields is None else fields.tolist()

    def rank(branch: int, below: int) -> tuple[int, ...]:
        """Sort the richest and longest first, then children of the richest."""
        return -n_fields[branch], -size[branch], -n_fields[below], -carried[branch], branch

    block = np.zeros(count, dtype=np.int64)
    slot = np.zeros(count, dtype=np.int64)
    begin = 0
    ready = [rank(0, 0)]
    while ready:
        together = [heappop(ready)[-1] for _ in range(min(WIDTH, len(ready)))]
        # Records have segments of the first slots only.
        together.sort(key=lambda branch: -size[branch])
        block[together] = begin
        slot[together] = np.arange(len(together))
        begin += size[together[0]]
        for branch in together:
            for child in children[branch]:
                heappush(ready, rank(child, branch))
    return block, slot, begin
