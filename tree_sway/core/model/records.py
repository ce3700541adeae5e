# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Data of the branches of a tree for its loads: a record of each, all of it together.

Frames: ``rest`` is the tree's frame at rest, its origin the root node. Positions in [m], rotations
in [rad].
"""

from __future__ import annotations

from functools import cache
from typing import Annotated

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Ints, Records
from tree_sway.core.tree import Tree

WIDTH = 16

MOST_IN_ALL = 12
"""Fields of a branch in all, up to which it may have more of subtrees against each other."""

MAX_COORDINATES = 20
"""Largest number of fields of a branch."""

ROOMS = 2, MOST_IN_ALL, MAX_COORDINATES
"""Numbers of fields that records have room for: of plain branches, of others, of small trees."""

N_AZIMUTHS, N_LEVELS = 24, 7
"""Azimuths of the wind and levels of the lean in the table."""

N_HARMONICS = 21
"""Spherical harmonics in which a load is expanded: all of odd degree up to 5."""


class Branch:
    """Data of one branch for stepping and placing it."""

    parent: int  # parent branch, -1 for the stem
    base_segment: int  # segment of the parent at its base, -1 for the stem
    first: int  # first segment
    end: int  # one past the last segment
    coordinate: int  # first coordinate
    n_coordinates: int  # key rotation x, y, then further ones
    frame: Annotated[Floats, 3, 3]  # b, e1, e2 as rows; x rotates the chord about e2, y about -e1
    twist: Annotated[Floats, 'rows', 6]  # motion of the base per unit of parent's coordinates
    load_mode: Annotated[Floats, 'rows', 3]  # displacement that the mean wind force does work on
    damping_mode: Annotated[Floats, 'rows', 3]  # displacement whose velocity the drag damps
    spread: float  # variance of the pieces' displacement about that mode
    tip_mode: Annotated[Floats, 'rows', 3]  # displacement of the tip
    tip: Annotated[Floats, 3]  # tip at rest
    load_rotation: Annotated[Floats, 'rows', 3]  # rotation of the loaded pieces
    lever: float  # lever of the branch's own load about its base [m]
    area: float  # drag area [m^2]
    speed: float  # wind speed at the branch over that at the anemometer
    centre: Annotated[Floats, 3]  # centre of the wind load
    coupling: Annotated[Floats, 3, 3]  # moment about the root of the tree per force [m]
    projector: Annotated[Floats, 6]  # mean of 1 - t t^T: xx, yy, zz, xy, xz, yz
    offset: Annotated[Floats, 3]  # base from the base segment's start, in that frame
    base: Annotated[Floats, 3]  # base at rest
    arm: Annotated[Floats, 3]  # base at rest from the parent's base
    per_arm: float  # 0.5 over the squared length of the arm [1/m^2]


def room_for_fields(most: int) -> int:
    """Return the room of records for a largest number of fields of a branch: one of `ROOMS`."""
    return next(room for room in ROOMS if most <= room)


@cache
def branch_layout(n_coordinates: int) -> np.dtype[np.void]:
    """
    Lay out `Branch`, with room for a number of coordinates.

    There is no room for more than any branch has (`room_for_fields`): the speed of a forest is
    limited by how fast its records are read from memory.
    """
    return np.dtype(fields_of(Branch, rows=n_coordinates))


PLACED = ('frame', 'offset', 'twist')
"""Fields of a branch that are arrays of a model, ``branch_`` before their names."""

LOADED = (
    'area', 'speed', 'spread', 'lever', 'projector', 'centre', 'coupling', 'load_mode',
    'damping_mode', 'load_rotation', 'tip_mode',
)  # fmt: skip
"""The same, of its wind load."""


def branches_at_rest(tree: Tree, parent: Ints, first: Ints, room: int) -> Records:
    """
    Begin the records of branches: parents, segments, bases, tips and arms, (b,).

    Parameters
    ----------
    tree
        The tree.
    parent
        Parent branch of each, -1 for the stem, (b,).
    first
        First segment of each, and the number of segments at the end, (b + 1,).
    room
        Room for fields, of `ROOMS`.

    """
    records = np.zeros(len(parent), dtype=branch_layout(room))
    root = tree.start[0]
    base = tree.start[first[:-1]] - root
    arm = base - base[np.maximum(parent, 0)]
    square = np.square(arm).sum(axis=1)
    records['parent'] = parent
    records['first'] = first[:-1]
    records['end'] = first[1:]
    records['base'] = base
    records['tip'] = tree.end[first[1:] - 1] - root
    records['arm'] = arm
    records['per_arm'] = np.divide(0.5, square, out=np.zeros_like(square), where=square > 0.0)
    return records
