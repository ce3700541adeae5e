# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A receiver in Python: poses from a frame and its description, by the solver's placing."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.model.fill_records import (
    assign_slots,
    block_records,
    fill_places,
    Places,
    segment_records,
)
from tree_sway.core.model.records import (
    block_layout,
    branch_layout,
    room_for_fields,
    segment_layout,
)
from tree_sway.core.run.placing_by_keys import placing_by_keys, PlacingByKeys
from tree_sway.errors import FormatError
from tree_sway.stream.check_description import Array
from tree_sway.stream.protocol import Description

MOST_MEMORY = 512 * 2**20
"""Largest memory for the records of a kind in [bytes]."""

_TURNS = 'base_turn', 'turn'


class Placer:
    """
    Placing of a described tree or scene.

    Parameters
    ----------
    description
        Description from the sender.

    Raises
    ------
    FormatError
        A tree whose records need more than `MOST_MEMORY`.

    """

    def __init__(self, description: Description) -> None:
        """Lay the tree out for the placing kernel."""
        self.description = description
        kinds = [_kind(arrays) for arrays in description.kinds]
        places = description.arrays['tree_place'].astype(np.float64).tolist()
        kind_of = [kinds[tree['kind']] for tree in description.header['trees']]
        self._trees = list(zip(places, kind_of, strict=True))
        self.n_segments = sum(kind.n_segments for kind in kind_of)

    def place(self, coordinates: Floats) -> Floats:
        """
        Poses (n, 7) of coordinates in their own unit, followed by ``beyond``, as in a frame.

        They are x y z in [m] and the quaternion's x y z w.
        """
        poses, row, first, key = np.empty((self.n_segments, 7)), 0, 0, 0
        number, turn = coordinates[len(self.description.scale) :].reshape(-1, 2).T
        # Between frames of different keys there is no pull.
        number = np.where(np.abs(number - np.rint(number)) < 1e-6, np.rint(number), -1.0)
        for (x, y, z, yaw, scale), kind in self._trees:
            last, end = first + kind.matrix.shape[1], row + kind.n_segments
            c, s = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
            keys = kind.matrix @ coordinates[first:last]
            own = (number >= key) & (number < key + len(keys))
            keys[number[own].astype(np.int64) - key] += turn[own]
            origin = np.array([x, y, z])
            kind.placing.place(keys, origin, poses[row:end], c, s, scale)
            row, first, key = end, last, key + len(keys)
        return poses


class _Kind(NamedTuple):
    """A kind laid out for the placing kernel."""

    matrix: Floats
    n_segments: int
    placing: PlacingByKeys


def _kind(arrays: dict[str, Array]) -> _Kind:
    first = arrays['branch_first'].astype(np.int64)
    parent, keys = arrays['branch_parent'].astype(np.int64), arrays['branch_keys'].astype(np.int64)
    base_turn, own_turn = (arrays[f'branch_{name}'].astype(np.int64) for name in _TURNS)
    matrix, turns = arrays['basis_matrix'].astype(np.float64), arrays['turn']
    slope, tip_slope = arrays['segment_slope'], arrays['segment_tip_slope']
    block, _, n_records = assign_slots(first, parent, keys)  # as `segment_records` does
    sizes, room = (len(parent), n_records, len(np.unique(block)) + 1), room_for_fields(keys.max())
    layouts = branch_layout(room), segment_layout(room), block_layout(room)
    memory = sum(n * layout.itemsize for n, layout in zip(sizes, layouts, strict=True))
    if memory > MOST_MEMORY:
        what = f'a kind of {memory // 2**20} MiB when laid out'
        cure = f'describe a tree of fewer branches: up to {MOST_MEMORY // 2**20} MiB'
        raise FormatError(what, where='tree description', cure=cure)
    frame = arrays['branch_frame'].astype(np.float64)
    branch = np.repeat(np.arange(len(parent)), np.diff(first))
    rank = np.arange(len(branch)) - first[branch]
    # By its slope about the axes across its chord, or by its own rows.
    turn = np.zeros((len(branch), room, 3))
    turn[:, 0] = slope[:, None] * frame[branch, 2]
    turn[:, 1] = -slope[:, None] * frame[branch, 1]
    turn[own_turn[branch] >= 0] = 0.0
    on_parent = np.zeros((len(parent), room, 3))
    for key in range(room):
        here = (base_turn >= 0) & (key < keys[parent])
        on_parent[here, key] = turns[base_turn[here] + key]
        here = (own_turn >= 0)[branch] & (key < keys[branch])
        own = branch[here]
        turn[here, key] = turns[own_turn[own] + rank[here] * keys[own] + key]
    skew, tip_skew = arrays['branch_skew'].T
    places = Places(
        first, parent, arrays['branch_base_segment'], arrays['branch_coordinate'], keys, frame,
        skew, tip_skew, arrays['branch_offset'], on_parent,
        arrays['segment_chord'], arrays['segment_rest'], slope, tip_slope, turn,
    )  # fmt: skip
    branches, segments = np.zeros(len(parent), layouts[0]), segment_records(places)
    fill_places(places, branches)
    placing = placing_by_keys(branches, segments, block_records(branches, segments))
    return _Kind(matrix, int(first[-1]), placing)
