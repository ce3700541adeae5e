# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Memory of the hot path: one record and one record of work per branch, one per sixteen segments.

A step visits every branch once and needs all that is known of it, so what belongs to a branch lies
together; a kernel takes a record array as one argument, where each plain array costs a call about
0.2 us. `fill_records` is the one that writes what stays.

Segments follow their branch and not each other, so those at the same place in sixteen branches are
computed at once: a record holds sixteen lanes, one per branch, and distances within it are
constants that let the compiler use vectors. The records of sixteen branches, from base to tip,
make a block; parents are in earlier blocks than their children. The wind load is found for sixteen
branches at once too, in the order of the branches.

Frames: ``rest`` is the tree's frame at rest, its origin the root node. Positions in [m], rotations
in [rad].
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from tree_sway.core.arrays import Records
from tree_sway.core.branch.shapes import MAX_COORDINATES


@cache
def branch_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """
    All that a step needs to know of a branch, with room for a number of coordinates.

    Where no branch has more than its key rotation, records have no room for more: a forest is
    solved no faster than its records come from memory.
    """
    return np.dtype(
        [
            ('parent', 'i8'),  # branch it sits on, -1 for the stem
            ('base_segment', 'i8'),  # segment it sits on, -1 for the stem
            ('first', 'i8'),  # its first segment
            ('end', 'i8'),  # one past its last segment
            ('coordinate', 'i8'),  # its first coordinate
            ('n_coordinates', 'i8'),  # key rotation x, y, then further ones
            ('source', 'i8'),  # branch whose motion it copies, itself if solved
            ('frame', 'f8', (3, 3)),  # b, e1, e2 as rows; x turns the chord about e2, y about -e1
            (
                'twist',
                'f8',
                (n_coordinates, 6),
            ),  # motion of its base per unit of parent's coordinates
            ('load_mode', 'f8', (n_coordinates, 3)),  # displacement under the wind's mean push
            ('damping_mode', 'f8', (n_coordinates, 3)),  # displacement at which its drag damps
            ('spread', 'f8'),  # mean square of what pieces move beside that displacement
            ('tip_mode', 'f8', (n_coordinates, 3)),  # displacement of its tip
            ('tip', 'f8', (3,)),  # tip at rest
            ('load_rotation', 'f8', (n_coordinates, 3)),  # rotation of what the wind sees
            ('lever', 'f8'),  # of its own load about its base [m]
            ('area', 'f8'),  # drag area [m^2]
            ('speed', 'f8'),  # wind here over wind at the anemometer
            ('centre', 'f8', (3,)),  # centre of the wind load
            ('coupling', 'f8', (3, 3)),  # its moment about the root of the tree per force [m]
            ('projector', 'f8', (6,)),  # mean of 1 - t t^T: xx, yy, zz, xy, xz, yz
            ('block', 'i8'),  # record of its first segment
            ('lane', 'i8'),  # of all its segments
            ('steepest', 'f8', (n_coordinates,)),  # square of the most a unit of each turns it by
            ('skew', 'f8'),  # third cumulant of its slope shape, over 6
            ('tip_skew', 'f8'),  # the same of the tip-load shape
            ('offset', 'f8', (3,)),  # base, from its base segment's start, in that one's frame
            ('base', 'f8', (3,)),  # base at rest
            ('arm', 'f8', (3,)),  # the same from its parent's base
            ('per_arm', 'f8'),  # 0.5 over the square of its length [1/m^2]
        ]
    )


BRANCH = branch_layout()
"""With room for every coordinate."""

LANES = 16

_LINE = 64
"""Bytes of a cache line, and of the widest vector."""


def _whole_lines(fields: list[tuple[Any, ...]]) -> np.dtype[np.void]:
    """Fields of whole vectors first, the others behind, filled up to whole cache lines."""
    packed: Any = np.dtype(sorted(fields, key=lambda field: len(field) < 3))
    by_name: dict[str, Any] = dict(packed.fields or {})
    return np.dtype(
        {
            'names': list(by_name),
            'formats': [kind[0] for kind in by_name.values()],
            'offsets': [kind[1] for kind in by_name.values()],
            'itemsize': -(-packed.itemsize // _LINE) * _LINE,
        }
    )


def zeros_in_lines(count: int, layout: np.dtype[np.void]) -> Records:
    """Return a number of records of zeros that begin where a cache line does."""
    memory = np.zeros(count * layout.itemsize + _LINE, dtype=np.uint8)
    first = -memory.ctypes.data % _LINE
    return memory[first : first + count * layout.itemsize].view(layout)


def in_lines(records: Records) -> Records:
    """Copy records to where a cache line begins."""
    copy = zeros_in_lines(len(records), records.dtype)
    copy[:] = records
    return copy


@cache
def segment_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """
    All that placing needs to know of one segment of each of sixteen branches.

    Where no branch has more than its key rotation, there is no room for what further coordinates
    turn it by.
    """
    rows = (n_coordinates, 3) if n_coordinates > 2 else (1, 1)
    return _whole_lines(
        [
            ('slope', 'f8', (LANES,)),  # by which a plain branch is drawn
            ('tip_slope', 'f8', (LANES,)),  # of the shape under a load at the tip
            ('chord', 'f8', (3, LANES)),  # from its start to the next one's start, at rest
            ('reach', 'f8', (3, LANES)),  # the same in its own frame
            ('rest', 'f8', (4, LANES)),  # orientation at rest, w x y z
            ('turn', 'f8', (*rows, LANES)),  # rotation vector per unit of each coordinate
            ('n_lanes', 'i8'),  # how many of the sixteen have a segment here, the first ones
        ]
    )


@cache
def head_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """
    Lay out what placing needs to know of the sixteen branches of a block, and finds.

    All work in the last record, behind the last block's, so that it stays in the fastest cache.
    """
    return _whole_lines(
        [
            ('block', 'i8'),  # first record of their segments
            ('n_records', 'i8'),
            ('n_lanes', 'i8'),
            ('n_bearing', 'i8'),  # lanes up to the last that others sit on
            ('n_rows', 'i8'),  # most coordinates that one of them has; 2 where all are plain
            ('n_parent_rows', 'i8'),  # the same of their parents
            ('is_joined', 'i8'),  # whether each segment starts where the one before ends
            ('is_at_axes', 'i8'),  # whether they sit on the axes of their base segments
            # As in `BRANCH`:
            ('branch', 'i8', (LANES,)),
            ('parent', 'i8', (LANES,)),
            ('coordinate', 'i8', (LANES,)),
            ('base_segment', 'i8', (LANES,)),
            ('first', 'i8', (LANES,)),
            ('frame', 'f8', (3, 3, LANES)),
            ('skew', 'f8', (LANES,)),
            ('tip_skew', 'f8', (LANES,)),
            ('steepest', 'f8', (LANES,)),
            # Rotation of its base per unit of each of its parent's coordinates:
            ('base_turn', 'f8', (n_coordinates, 3, LANES)),
            ('offset', 'f8', (3, LANES)),
            # Scratch:
            ('key', 'f8', (2, LANES)),  # key rotation
            ('parent_key', 'f8', (n_coordinates, LANES)),  # half of each parent's, stretched
            ('parent_base', 'f8', (8, LANES)),  # bases of `place`
            ('carrier', 'f8', (7, LANES)),  # pose of the base segment
            ('carrier_turn', 'f8', (3, LANES)),  # half the rotation vector from the parent's base
            ('base', 'f8', (8, LANES)),  # the same of its own
            ('blend', 'f8', (LANES,)),  # how far it has gone over to the tip's slope
            ('half_turn', 'f8', (3, LANES)),  # half the rotation vector per unit of slope
            ('half_key', 'f8', (n_coordinates, LANES)),  # half of each coordinate, stretched
            ('square', 'f8', (LANES,)),  # of the length of half_turn
            ('swing', 'f8', (4, LANES)),  # half_turn, then the base: what a sine is multiplied by
            ('half_angle', 'f8', (LANES,)),  # bound on the squared half turn of any segment
            ('next', 'f8', (3, LANES)),  # where the segment after this one starts
            ('pose', 'f8', (7, LANES)),  # of the segment, in message order
        ]
    )


SEGMENT = segment_layout()
"""With room for every coordinate."""

WORK = np.dtype(
    [
        # Of the base, in its own frame as it is turned:
        ('velocity', 'f8', (6,)),  # of its place, then its spin
        ('attitude', 'f8', (4,)),  # how it is turned from rest, w x y z
        ('force', 'f8', (3,)),  # of the wind on the branch in the last step [N]
        ('turn', 'f8', (3,)),  # rotation of the base, from its parent's base
        ('shift', 'f8', (3,)),  # displacement of the base in its parent's base's frame
        ('arm', 'f8', (3,)),  # where it now is from there
        ('wrench', 'f8', (6,)),  # force and moment of itself and all it carries (`tree_passes`)
    ]
)
"""What a step computes in between, kept from one step to the next."""


def load_fields(n_coordinates: int = MAX_COORDINATES) -> list[tuple[Any, ...]]:
    """
    Lay out what the wind load knows of sixteen branches that follow each other, and finds.

    Rows are coordinates, those that a branch does not have zeros.
    """
    return [
        ('n_rows', 'i8'),  # the most coordinates that one of them has
        ('is_solved', 'i8', (LANES,)),  # whether it copies no other
        ('delay', 'i8', (LANES,)),  # which delay of `crown_wind` it has
        # As in `BRANCH`:
        ('speed', 'f8', (LANES,)),
        ('area', 'f8', (LANES,)),
        ('spread', 'f8', (LANES,)),
        ('projector', 'f8', (6, LANES)),
        ('damping_mode', 'f8', (n_coordinates, 3, LANES)),
        ('load_rotation', 'f8', (n_coordinates, 3, LANES)),
        ('load_mode', 'f8', (n_coordinates, 3, LANES)),
        ('along', 'f8', (3, LANES)),  # its chord times its lever
        ('coupling', 'f8', (3, 3, LANES)),  # its moment about its base per force [m]
        # Set with the time step:
        ('compliance', 'f8', (LANES,)),  # velocity half a step after a unit of force [s/kg]
        # Set with the wind:
        ('gust', 'f8', (3, LANES)),  # by which its own wind differs from the tree's [m/s]
        # State half a step on, and what follows from it:
        ('x', 'f8', (n_coordinates, LANES)),
        ('v', 'f8', (n_coordinates, LANES)),
        ('velocity', 'f8', (6, LANES)),  # of the base, in its own frame as it is turned
        ('air', 'f8', (3, LANES)),  # its wind in that frame [m/s]
        ('turned', 'f8', (3, LANES)),  # rotation of what the wind sees from there
        # What the last force took off the relative wind, over the compliance [N]:
        ('drag_impulse', 'f8', (3, LANES)),
        ('own_force', 'f8', (3, LANES)),  # in the frame of the branch as it is turned
        ('force', 'f8', (3, LANES)),  # the same in that of its base
        ('moment', 'f8', (3, LANES)),  # about the base, in its frame [N m]
        ('load', 'f8', (1 + n_coordinates, LANES)),  # along b, then on each coordinate [N m]
    ]


@cache
def load_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """Return the layout of records of `load_fields`."""
    return _whole_lines(load_fields(n_coordinates))


OSCILLATORS = _whole_lines(
    [
        *load_fields(2),
        ('now_x', 'f8', (2, LANES)),
        ('now_v', 'f8', (2, LANES)),
        ('whole', 'f8', (8, LANES)),  # rows of the propagator of a step
        ('half', 'f8', (6, LANES)),  # of half a step under a constant load
        ('guard', 'f8', (3, LANES)),  # rows of `two_axis.guards`
    ]
)
"""Oscillators of sixteen branches that follow each other, and the wind load on them."""
