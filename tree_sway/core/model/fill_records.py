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


def segment_records(places: Places) -> Records:
    """Fill the segments for placing: records of `segment_layout`, in blocks."""
    block, slot, n_records = assign_slots(places.first, places.parent, places.n_coordinates)
    is_plain = places.segment_turn.shape[1] == 2
    records = zeros_in_lines(n_records, segment_layout(places.segment_turn.shape[1]))
    records['rest'][:, 0] = 1.0
    size = np.diff(places.first)
    rows = np.arange(len(places.slope)) + np.repeat(block - places.first[:-1], size)
    own = np.repeat(slot, size)
    records['chord'][rows, :, own] = places.chord
    records['rest'][rows, :, own] = places.rest
    records['slope'][rows, own], records['tip_slope'][rows, own] = places.slope, places.tip_slope
    np.maximum.at(records['n_slots'], rows, own + 1)
    if not is_plain:
        n_modes = places.segment_turn.shape[1]
        records['segment_turn'][rows, :n_modes, :, own] = places.segment_turn
    return records


def fill_places(places: Places, records: Records) -> None:
    """Fill the fields for placing in records of `branch_layout`, (b,)."""
    records['first_record'], records['slot'], _ = assign_slots(
        places.first, places.parent, places.n_coordinates
    )
    records['parent'], records['base_segment'] = places.parent, places.base_segment
    records['first'], records['end'] = places.first[:-1], places.first[1:]
    records['coordinate'], records['n_coordinates'] = places.coordinate, places.n_coordinates
    records['frame'], records['offset'] = places.frame, places.offset
    records['skew'], records['tip_skew'] = places.skew, places.tip_skew
    k = min(places.base_rotation.shape[1], records['twist'].shape[1])
    records['twist'][:, :k, 3:] = places.base_rotation[:, :k]
    begin = places.first[:-1]
    steepest = np.maximum.reduceat(np.square(places.segment_turn).sum(axis=2), begin)
    tips = np.maximum.reduceat(np.square(places.tip_slope), begin)
    records['steepest'][:, : steepest.shape[1]] = steepest
    records['steepest'][:, 0] = np.maximum(records['steepest'][:, 0], tips)


def block_records(branches: Records, segments: Records) -> Records:
    """
    Lay the fields for placing out in blocks, from `Branch` records whose coordinates are set.

    Records are of `block_layout`, one per block of `assign_slots` and one of scratch memory.
    """
    first, block = np.unique(branches['first_record'], return_inverse=True)
    slot, parent = branches['slot'], branches['parent']
    blocks = zeros_in_lines(len(first) + 1, block_layout(branches.dtype['load_mode'].shape[0]))
    blocks['first_record'] = [*first, len(segments)]
    blocks['n_records'][:-1] = np.diff(blocks['first_record'])
    blocks['n_slots'][:-1] = segments['n_slots'][first]
    blocks['n_eights'] = -(-blocks['n_slots'] // 8)
    np.maximum.at(blocks['n_parents'], block[parent[1:]], slot[parent[1:]] + 1)
    np.maximum.at(blocks['n_rows'], block, branches['n_coordinates'])
    blocks['branch'][block, slot] = np.arange(len(branches))
    blocks['is_joined'][:-1] = np.logical_and.reduceat(_joined(segments), first)
    np.maximum.at(blocks['n_parent_rows'], block, branches['n_coordinates'][parent])
    for name in ('parent', 'coordinate', 'base_segment', 'first'):
        blocks[name][block, slot] = branches[name]
    for name in ('frame', 'skew', 'tip_skew', 'offset', 'steepest'):
        blocks[name][block, ..., slot] = branches[name]
    blocks['bound_factor'][block, slot] = branches['n_coordinates'] - 1
    blocks['parent_coordinate'][block, slot] = branches['coordinate'][parent]
    ahead, beside = blocks['offset'][:, :1], np.abs(blocks['offset'][:, 1:])
    blocks['is_at_axes'] = (beside <= _AS_ONE * ahead).all(axis=(1, 2))
    blocks['base_rotation'][block, ..., slot] = branches['twist'][..., 3:]
    return blocks


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
    size = np.diff(first)
    children: list[list[int]] = [[] for _ in size]
    carried = np.ones(len(size), dtype=np.int64)
    for branch in range(len(size) - 1, 0, -1):
        children[branch_parent[branch]].insert(0, branch)
        carried[branch_parent[branch]] += carried[branch]
    block, slot = np.zeros((2, len(size)), dtype=np.int64)
    # The time to place sixteen branches is that of the one with most fields.
    rich = (-fields if fields is not None else 0 * size).tolist()
    begin, ready = 0, [(rich[0], -int(size[0]), 0, -int(carried[0]), 0)]
    while ready:
        together = [heappop(ready)[-1] for _ in range(min(WIDTH, len(ready)))]
        # Records have segments of the first slots only.
        together.sort(key=lambda branch: -int(size[branch]))
        block[together], slot[together] = begin, np.arange(len(together))
        begin += int(size[together[0]])
        for branch in together:
            for child in children[branch]:
                last = rich[branch], -int(carried[child]), child
                heappush(ready, (rich[child], -int(size[child]), *last))
    return block, slot, begin
