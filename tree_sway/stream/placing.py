# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A receiver in Python: poses from a frame and its description, placed by the native core."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model import room_for_fields
from tree_sway.core.native import bytes_of, NativeModel, NativeStand
from tree_sway.errors import FormatError
from tree_sway.stream.check_description import Arrays
from tree_sway.stream.protocol import Description

_MOST_MEMORY = 512 * 2**20
"""Largest memory for the turns of the segments of a kind in [bytes]."""


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
        A tree whose arrays need more than `_MOST_MEMORY`, or have indices that do not exist.

    """

    def __init__(self, description: Description) -> None:
        """Hand the kinds to the native core."""
        self.description = description
        models = [NativeModel(bytes_of(_arrays(kind))) for kind in description.kinds]
        bases = [kind['basis_matrix'].astype(np.float64) for kind in description.kinds]
        places = description.arrays['tree_place'].astype(np.float64)
        kind_of = np.array([tree['kind'] for tree in description.header['trees']], dtype=np.int64)
        self._stand = NativeStand(models, kind_of, places, np.ones(len(places)))
        self._trees = [(bases[kind], models[kind].sizes.segments) for kind in kind_of.tolist()]
        self.n_segments = sum(count for _, count in self._trees)

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
        coordinate = key = row = 0
        for number, (basis, n_segments) in enumerate(self._trees):
            n_keys, n_coordinates = basis.shape
            rotations = basis @ coordinates[coordinate : coordinate + n_coordinates]
            is_own = (pulled_key >= key) & (pulled_key < key + n_keys)
            rotations[pulled_key[is_own].astype(np.int64) - key] += pull[is_own]
            self._stand.place_keys(number, rotations, poses[row : row + n_segments])
            coordinate += n_coordinates
            key += n_keys
            row += n_segments
        return poses


def _arrays(arrays: Arrays) -> Arrays:
    """Return the arrays by which the native core places a described kind."""
    first = arrays['branch_first'].astype(np.int64)
    parent = arrays['branch_parent'].astype(np.int64)
    n_keys = arrays['branch_keys'].astype(np.int64)
    room = room_for_fields(n_keys.max())
    n = int(first[-1])
    memory = 2 * 8 * 3 * room * n
    if memory > _MOST_MEMORY:
        raise FormatError(
            f'a kind of {memory // 2**20} MiB when laid out',
            where='tree description',
            cure=f'describe a tree of fewer segments: up to {_MOST_MEMORY // 2**20} MiB',
        )
    twist = np.zeros((len(parent), room, 6))
    twist[:, :, 3:] = _base_rotations(arrays, parent, n_keys, room)
    none = np.zeros(n)
    found = {
        'branch_first': first,
        'branch_parent': parent,
        'branch_keys': n_keys,
        'branch_twist': twist,
        'segment_turn': _segment_turns(arrays, first, n_keys, room),
        'tree_start': np.zeros((n, 3)),
        'tree_end': np.zeros((n, 3)),
        'tree_base_diameter': none,
        'tree_tip_diameter': none,
    }
    for name in ('branch_base_segment', 'branch_coordinate'):
        found[name] = arrays[name].astype(np.int64)
    for name in (
        'branch_frame', 'branch_skew', 'branch_offset', 'segment_chord', 'segment_rest',
        'segment_slope', 'segment_tip_slope',
    ):  # fmt: skip
        found[name] = arrays[name].astype(np.float64)
    return found


def _base_rotations(arrays: Arrays, parent: Ints, n_keys: Ints, room: int) -> Floats:
    """Rotation of the base of each branch per unit of its parent's keys, (b, room, 3)."""
    base_turn = arrays['branch_base_turn'].astype(np.int64)
    rotation = np.zeros((len(parent), room, 3))
    for key in range(room):
        has_row = (base_turn >= 0) & (key < n_keys[parent])
        rotation[has_row, key] = arrays['turn'][base_turn[has_row] + key]
    return rotation


def _segment_turns(arrays: Arrays, first: Ints, n_keys: Ints, room: int) -> Floats:
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
