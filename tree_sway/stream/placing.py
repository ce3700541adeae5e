# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A receiver in Python: poses from a frame and its description, by the solver's placing."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
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
        poses = np.empty((self.n_segments, 7))
        pulled_key, pull = coordinates[len(self.description.scale) :].reshape(-1, 2).T
        # Between frames with pulls on different keys the number of a key is interpolated to one
        # that is not whole: then there is no pull.
        nearest_key = np.rint(pulled_key)
        pulled_key = np.where(np.abs(pulled_key - nearest_key) < 1e-6, nearest_key, -1.0)
        coordinate = 0
        key = 0
        row = 0
        for (x, y, z, yaw, scale), kind in self._trees:
            n_keys, n_coordinates = kind.basis.shape
            rotations = kind.basis @ coordinates[coordinate : coordinate + n_coordinates]
            is_own = (pulled_key >= key) & (pulled_key < key + n_keys)
            rotations[pulled_key[is_own].astype(np.int64) - key] += pull[is_own]
            origin = np.array([x, y, z])
            out = poses[row : row + kind.n_segments]
            cosine = math.cos(0.5 * yaw)
            sine = math.sin(0.5 * yaw)
            kind.placing.place(rotations, origin, out, cosine, sine, scale)
            coordinate += n_coordinates
            key += n_keys
            row += kind.n_segments
        return poses


class _Kind(NamedTuple):
    """A kind laid out for the placing kernel."""

    basis: Floats
    """Key rotations per unit of each coordinate, (keys, coordinates)."""
    n_segments: int
    placing: PlacingByKeys


def _kind(arrays: dict[str, Array]) -> _Kind:
    """Lay a described kind out for the placing kernel."""
    first = arrays['branch_first'].astype(np.int64)
    parent = arrays['branch_parent'].astype(np.int64)
    n_keys = arrays['branch_keys'].astype(np.int64)
    room = room_for_fields(n_keys.max())
    _refuse_too_large(first, parent, n_keys, room)
    skew, tip_skew = arrays['branch_skew'].T
    places = Places(
        first=first,
        parent=parent,
        base_segment=arrays['branch_base_segment'],
        coordinate=arrays['branch_coordinate'],
        n_coordinates=n_keys,
        frame=arrays['branch_frame'].astype(np.float64),
        skew=skew,
        tip_skew=tip_skew,
        offset=arrays['branch_offset'],
        base_rotation=_base_rotations(arrays, parent, n_keys, room),
        chord=arrays['segment_chord'],
        rest=arrays['segment_rest'],
        slope=arrays['segment_slope'],
        tip_slope=arrays['segment_tip_slope'],
        segment_turn=_segment_turns(arrays, first, n_keys, room),
    )
    branches = np.zeros(len(parent), branch_layout(room))
    fill_places(places, branches)
    segments = segment_records(places)
    placing = placing_by_keys(branches, segments, block_records(branches, segments))
    return _Kind(arrays['basis_matrix'].astype(np.float64), int(first[-1]), placing)


def _refuse_too_large(first: Ints, parent: Ints, n_keys: Ints, room: int) -> None:
    """Refuse a kind whose records need more than `MOST_MEMORY`, before they are made."""
    block, _, n_segment_records = assign_slots(first, parent, n_keys)  # as `segment_records` does
    memory = (
        len(parent) * branch_layout(room).itemsize
        + n_segment_records * segment_layout(room).itemsize
        + (len(np.unique(block)) + 1) * block_layout(room).itemsize
    )
    if memory > MOST_MEMORY:
        raise FormatError(
            f'a kind of {memory // 2**20} MiB when laid out',
            where='tree description',
            cure=f'describe a tree of fewer branches: up to {MOST_MEMORY // 2**20} MiB',
        )


def _base_rotations(arrays: dict[str, Array], parent: Ints, n_keys: Ints, room: int) -> Floats:
    """Rotation of the base of each branch per unit of its parent's keys, (b, room, 3)."""
    base_turn = arrays['branch_base_turn'].astype(np.int64)
    rotation = np.zeros((len(parent), room, 3))
    for key in range(room):
        has_row = (base_turn >= 0) & (key < n_keys[parent])
        rotation[has_row, key] = arrays['turn'][base_turn[has_row] + key]
    return rotation


def _segment_turns(arrays: dict[str, Array], first: Ints, n_keys: Ints, room: int) -> Floats:
    """
    Rotation of each segment per unit of its branch's keys, (n, room, 3).

    A branch has a row of its own for each segment and key, or turns about the two axes across its
    chord by its slope.
    """
    own_turn = arrays['branch_turn'].astype(np.int64)
    frame = arrays['branch_frame'].astype(np.float64)
    branch = np.repeat(np.arange(len(own_turn)), np.diff(first))
    rank = np.arange(len(branch)) - first[branch]
    slope = arrays['segment_slope'][:, None]
    has_rows = own_turn[branch] >= 0
    rotation = np.zeros((len(branch), room, 3))
    rotation[:, 0] = slope * frame[branch, 2]
    rotation[:, 1] = -slope * frame[branch, 1]
    rotation[has_rows] = 0.0
    for key in range(room):
        segments = has_rows & (key < n_keys[branch])
        owner = branch[segments]
        rows = own_turn[owner] + rank[segments] * n_keys[owner] + key
        rotation[segments, key] = arrays['turn'][rows]
    return rotation
