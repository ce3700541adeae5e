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
from typing import Annotated, Any

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Ints, Records, RecordsOf
from tree_sway.core.branch.shapes import MAX_COORDINATES

LANES = 16


class Branch:
    """All that a step needs to know of a branch."""

    parent: int  # branch it sits on, -1 for the stem
    base_segment: int  # segment it sits on, -1 for the stem
    first: int  # its first segment
    end: int  # one past its last segment
    coordinate: int  # its first coordinate
    n_coordinates: int  # key rotation x, y, then further ones
    frame: Annotated[Floats, 3, 3]  # b, e1, e2 as rows; x turns the chord about e2, y about -e1
    twist: Annotated[Floats, 'rows', 6]  # motion of its base per unit of parent's coordinates
    load_mode: Annotated[Floats, 'rows', 3]  # displacement under the wind's mean push
    damping_mode: Annotated[Floats, 'rows', 3]  # displacement at which its drag damps
    spread: float  # mean square of what pieces move beside that displacement
    tip_mode: Annotated[Floats, 'rows', 3]  # displacement of its tip
    tip: Annotated[Floats, 3]  # tip at rest
    load_rotation: Annotated[Floats, 'rows', 3]  # rotation of what the wind sees
    lever: float  # of its own load about its base [m]
    area: float  # drag area [m^2]
    speed: float  # wind here over wind at the anemometer
    centre: Annotated[Floats, 3]  # centre of the wind load
    coupling: Annotated[Floats, 3, 3]  # its moment about the root of the tree per force [m]
    projector: Annotated[Floats, 6]  # mean of 1 - t t^T: xx, yy, zz, xy, xz, yz
    block: int  # record of its first segment
    lane: int  # of all its segments
    steepest: Annotated[Floats, 'rows']  # square of the most a unit of each turns it by
    skew: float  # third cumulant of its slope shape, over 6
    tip_skew: float  # the same of the tip-load shape
    offset: Annotated[Floats, 3]  # base, from its base segment's start, in that one's frame
    base: Annotated[Floats, 3]  # base at rest
    arm: Annotated[Floats, 3]  # the same from its parent's base
    per_arm: float  # 0.5 over the square of its length [1/m^2]


class Segment:
    """All that placing needs to know of one segment of each of sixteen branches."""

    slope: Annotated[Floats, LANES]  # by which a plain branch is drawn
    tip_slope: Annotated[Floats, LANES]  # of the shape under a load at the tip
    chord: Annotated[Floats, 3, LANES]  # from its start to the next one's start, at rest
    reach: Annotated[Floats, 3, LANES]  # the same in its own frame
    rest: Annotated[Floats, 4, LANES]  # orientation at rest, w x y z
    turn: Annotated[Floats, 'rows', 'axes', LANES]  # rotation vector per unit of each coordinate
    n_lanes: int  # how many of the sixteen have a segment here, the first ones


class Head:
    """What placing needs to know of the sixteen branches of a block, and finds."""

    block: int  # first record of their segments
    n_records: int
    n_lanes: int
    n_bearing: int  # lanes up to the last that others sit on
    n_rows: int  # most coordinates that one of them has; 2 where all are plain
    n_parent_rows: int  # the same of their parents
    is_joined: int  # whether each segment starts where the one before ends
    is_at_axes: int  # whether they sit on the axes of their base segments
    # As in `BRANCH`:
    branch: Annotated[Ints, LANES]
    parent: Annotated[Ints, LANES]
    coordinate: Annotated[Ints, LANES]
    base_segment: Annotated[Ints, LANES]
    first: Annotated[Ints, LANES]
    frame: Annotated[Floats, 3, 3, LANES]
    skew: Annotated[Floats, LANES]
    tip_skew: Annotated[Floats, LANES]
    steepest: Annotated[Floats, LANES]
    # Rotation of its base per unit of each of its parent's coordinates:
    base_turn: Annotated[Floats, 'rows', 3, LANES]
    offset: Annotated[Floats, 3, LANES]
    # Scratch:
    key: Annotated[Floats, 2, LANES]  # key rotation
    parent_key: Annotated[Floats, 'rows', LANES]  # half of each parent's, stretched
    parent_base: Annotated[Floats, 8, LANES]  # bases of `place`
    carrier: Annotated[Floats, 7, LANES]  # pose of the base segment
    carrier_turn: Annotated[Floats, 3, LANES]  # half the rotation vector from the parent's base
    base: Annotated[Floats, 8, LANES]  # the same of its own
    blend: Annotated[Floats, LANES]  # how far it has gone over to the tip's slope
    half_turn: Annotated[Floats, 3, LANES]  # half the rotation vector per unit of slope
    half_key: Annotated[Floats, 'rows', LANES]  # half of each coordinate, stretched
    square: Annotated[Floats, LANES]  # of the length of half_turn
    swing: Annotated[Floats, 4, LANES]  # half_turn, then the base: what a sine is multiplied by
    half_angle: Annotated[Floats, LANES]  # bound on the squared half turn of any segment
    next: Annotated[Floats, 3, LANES]  # where the segment after this one starts
    pose: Annotated[Floats, 7, LANES]  # of the segment, in message order


class Work:
    """What a step computes of a branch in between, kept from one step to the next."""

    # Of the base, in its own frame as it is turned:
    velocity: Annotated[Floats, 6]  # of its place, then its spin
    attitude: Annotated[Floats, 4]  # how it is turned from rest, w x y z
    force: Annotated[Floats, 3]  # of the wind on the branch in the last step [N]
    turn: Annotated[Floats, 3]  # rotation of the base, from its parent's base
    shift: Annotated[Floats, 3]  # displacement of the base in its parent's base's frame
    arm: Annotated[Floats, 3]  # where it now is from there
    wrench: Annotated[Floats, 6]  # force and moment of itself and all it carries (`tree_passes`)


class Load:
    """
    What the wind load knows of sixteen branches that follow each other, and finds.

    Rows are coordinates, those that a branch does not have zeros.
    """

    n_rows: int  # the most coordinates that one of them has
    # As in `BRANCH`:
    speed: Annotated[Floats, LANES]
    area: Annotated[Floats, LANES]
    spread: Annotated[Floats, LANES]
    projector: Annotated[Floats, 6, LANES]
    damping_mode: Annotated[Floats, 'rows', 3, LANES]
    load_rotation: Annotated[Floats, 'rows', 3, LANES]
    load_mode: Annotated[Floats, 'rows', 3, LANES]
    along: Annotated[Floats, 3, LANES]  # its chord times its lever
    coupling: Annotated[Floats, 3, 3, LANES]  # its moment about its base per force [m]
    # Set with the time step:
    compliance: Annotated[Floats, LANES]  # velocity half a step after a unit of force [s/kg]
    # Set with the wind:
    gust: Annotated[Floats, 3, LANES]  # by which its own wind differs from the tree's [m/s]
    # State half a step on, and what follows from it:
    x: Annotated[Floats, 'rows', LANES]
    v: Annotated[Floats, 'rows', LANES]
    velocity: Annotated[Floats, 6, LANES]  # of the base, in its own frame as it is turned
    air: Annotated[Floats, 3, LANES]  # its wind in that frame [m/s]
    turned: Annotated[Floats, 3, LANES]  # rotation of what the wind sees from there
    # What the last force took off the relative wind, over the compliance [N]:
    drag_impulse: Annotated[Floats, 3, LANES]
    own_force: Annotated[Floats, 3, LANES]  # in the frame of the branch as it is turned
    force: Annotated[Floats, 3, LANES]  # the same in that of its base
    moment: Annotated[Floats, 3, LANES]  # about the base, in its frame [N m]
    load: Annotated[Floats, 'loads', LANES]  # along b, then on each coordinate [N m]


class Oscillators(Load):
    """Oscillators of sixteen branches that follow each other, and the wind load on them."""

    now_x: Annotated[Floats, 2, LANES]
    now_v: Annotated[Floats, 2, LANES]
    whole: Annotated[Floats, 8, LANES]  # rows of the propagator of a step
    half: Annotated[Floats, 6, LANES]  # of half a step under a constant load
    guard: Annotated[Floats, 3, LANES]  # rows of `two_axis.guards`


Branches = RecordsOf[Branch]
Segments = RecordsOf[Segment]
Heads = RecordsOf[Head]
Works = RecordsOf[Work]
Loads = RecordsOf[Load]
Banks = RecordsOf[Oscillators]


@cache
def branch_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """
    Lay out `Branch`, with room for a number of coordinates.

    Where no branch has more than its key rotation, records have no room for more: a forest is
    solved no faster than its records come from memory.
    """
    return np.dtype(fields_of(Branch, rows=n_coordinates))


BRANCH = branch_layout()
"""With room for every coordinate."""

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
    """Lay out `Segment`; without ``turn`` where no branch has more than its key rotation."""
    rows, axes = (n_coordinates, 3) if n_coordinates > 2 else (1, 1)
    return _whole_lines(fields_of(Segment, rows=rows, axes=axes))


SEGMENT = segment_layout()
"""With room for every coordinate."""


@cache
def head_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """
    Lay out `Head`.

    All work in the last record, behind the last block's, so that it stays in the fastest cache.
    """
    return _whole_lines(fields_of(Head, rows=n_coordinates))


WORK = np.dtype(fields_of(Work))


@cache
def load_layout(n_coordinates: int = MAX_COORDINATES) -> np.dtype[np.void]:
    """Lay out `Load`, with room for a number of coordinates."""
    return _whole_lines(fields_of(Load, rows=n_coordinates, loads=1 + n_coordinates))


OSCILLATORS = _whole_lines(fields_of(Oscillators, rows=2, loads=3))
