# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How branches are joined and drawn: the data for placing a tree."""

from __future__ import annotations

from typing import NamedTuple

from tree_sway.core.arrays import Floats, Ints, Records


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
    'parent', 'base_segment', 'coordinate', 'n_coordinates', 'frame', 'offset',
)  # fmt: skip
"""Fields of a branch's record that are those of `Places`."""


def fill_places(places: Places, records: Records) -> None:
    """Fill the fields for placing in records of `branch_layout`, (b,)."""
    records['first'] = places.first[:-1]
    records['end'] = places.first[1:]
    for name in _OF_PLACES:
        records[name] = getattr(places, name)
    k = min(places.base_rotation.shape[1], records['twist'].shape[1])
    records['twist'][:, :k, 3:] = places.base_rotation[:, :k]
