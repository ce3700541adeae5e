# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Memory of the hot path: one record and one record of work per branch, one per sixteen segments.

A step visits every branch once and needs all that is known of it, so what belongs to a branch lies
together; a kernel takes a record array as one argument, where each plain array costs a call about
0.2 us. `fill_records` is the one that writes what stays.

Segments follow their branch and not each other, so those at the same place in sixteen branches are
computed at once: a record holds sixteen slots, one per branch, and distances within it are
constants that let the compiler use vectors. The records of sixteen branches, from base to tip,
make a block; parents are in earlier blocks than their children. The wind load is found for sixteen
branches at once too, in the order of the branches.

A tree on a table of winds has three records: its table, a time step, and its own state.

Frames: ``rest`` is the tree's frame at rest, its origin the root node. Positions in [m], rotations
in [rad].
"""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Ints, Records, RecordsOf, Singles
from tree_sway.core.branch.shapes import MAX_COORDINATES

WIDTH = 16

N_AZIMUTHS, N_LEVELS = 24, 7
"""Azimuths of the wind and levels of the lean in the table."""

_MODES_TOGETHER = 8
_LEAST_MODES = 24


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
    slot: int  # of all its segments
    steepest: Annotated[Floats, 'rows']  # square of the most a unit of each turns it by
    skew: float  # third cumulant of its slope shape, over 6
    tip_skew: float  # the same of the tip-load shape
    offset: Annotated[Floats, 3]  # base, from its base segment's start, in that one's frame
    base: Annotated[Floats, 3]  # base at rest
    arm: Annotated[Floats, 3]  # the same from its parent's base
    per_arm: float  # 0.5 over the square of its length [1/m^2]


class Segment:
    """All that placing needs to know of one segment of each of sixteen branches."""

    slope: Annotated[Floats, WIDTH]  # by which a plain branch is drawn
    tip_slope: Annotated[Floats, WIDTH]  # of the shape under a load at the tip
    chord: Annotated[Floats, 3, WIDTH]  # from its start to the next one's start, at rest
    reach: Annotated[Floats, 3, WIDTH]  # the same in its own frame
    rest: Annotated[Floats, 4, WIDTH]  # orientation at rest, w x y z
    turn: Annotated[Floats, 'rows', 'axes', WIDTH]  # rotation vector per unit of each coordinate
    n_slots: int  # how many of the sixteen have a segment here, the first ones


class Head:
    """What placing needs to know of the sixteen branches of a block, and finds."""

    block: int  # first record of their segments
    n_records: int
    n_slots: int
    n_eights: int  # of slots, the last ones with empty ones
    n_bearing: int  # slots up to the last that others sit on
    n_rows: int  # most coordinates that one of them has; 2 where all are plain
    n_parent_rows: int  # the same of their parents
    is_joined: int  # whether each segment starts where the one before ends
    is_at_axes: int  # whether they sit on the axes of their base segments
    # As in `BRANCH`:
    branch: Annotated[Ints, WIDTH]
    parent: Annotated[Ints, WIDTH]
    coordinate: Annotated[Ints, WIDTH]
    base_segment: Annotated[Ints, WIDTH]
    first: Annotated[Ints, WIDTH]
    frame: Annotated[Floats, 3, 3, WIDTH]
    skew: Annotated[Floats, WIDTH]
    tip_skew: Annotated[Floats, WIDTH]
    steepest: Annotated[Floats, 'rows', WIDTH]
    last: Annotated[Floats, WIDTH]  # of its coordinates, from its first
    parent_coordinate: Annotated[Ints, WIDTH]
    # Rotation of its base per unit of each of its parent's coordinates:
    base_turn: Annotated[Floats, 'rows', 3, WIDTH]
    offset: Annotated[Floats, 3, WIDTH]
    # Scratch:
    key: Annotated[Floats, 2, WIDTH]  # key rotation
    parent_key: Annotated[Floats, 'rows', WIDTH]  # half of each parent's further ones
    parent_base: Annotated[Floats, 8, WIDTH]  # bases of `place`
    carrier: Annotated[Floats, 7, WIDTH]  # pose of the base segment
    carrier_turn: Annotated[Floats, 3, WIDTH]  # half the rotation vector from the parent's base
    base: Annotated[Floats, 8, WIDTH]  # the same of its own
    blend: Annotated[Floats, WIDTH]  # how far it has gone over to the tip's slope
    half_turn: Annotated[Floats, 3, WIDTH]  # half the rotation vector per unit of slope
    half_key: Annotated[Floats, 'rows', WIDTH]  # half of each coordinate, stretched
    square: Annotated[Floats, WIDTH]  # of the length of half_turn
    swing: Annotated[Floats, 4, WIDTH]  # half_turn, then the base: what a sine is multiplied by
    bound: Annotated[Floats, WIDTH]  # on the squared half turn of any segment
    half: Annotated[Floats, 3, WIDTH]  # half the rotation vector of the segment
    angle: Annotated[Floats, WIDTH]  # square of half an angle, its cosine, and its sine over it
    cosine: Annotated[Floats, WIDTH]
    sinc: Annotated[Floats, WIDTH]
    next: Annotated[Floats, 3, WIDTH]  # where the segment after this one starts
    pose: Annotated[Floats, 7, WIDTH]  # of the segment, in message order


class Work:
    """What a step computes of a branch in between, stored from one step to the next."""

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
    speed: Annotated[Floats, WIDTH]
    area: Annotated[Floats, WIDTH]
    spread: Annotated[Floats, WIDTH]
    projector: Annotated[Floats, 6, WIDTH]
    damping_mode: Annotated[Floats, 'rows', 3, WIDTH]
    load_rotation: Annotated[Floats, 'rows', 3, WIDTH]
    load_mode: Annotated[Floats, 'rows', 3, WIDTH]
    along: Annotated[Floats, 3, WIDTH]  # its chord times its lever
    coupling: Annotated[Floats, 3, 3, WIDTH]  # its moment about its base per force [m]
    # Set with the time step:
    compliance: Annotated[Floats, WIDTH]  # velocity half a step after a unit of force [s/kg]
    # Set with the wind:
    gust: Annotated[Floats, 3, WIDTH]  # by which its own wind differs from the tree's [m/s]
    # State half a step on, and what follows from it:
    x: Annotated[Floats, 'rows', WIDTH]
    v: Annotated[Floats, 'rows', WIDTH]
    velocity: Annotated[Floats, 6, WIDTH]  # of the base, in its own frame as it is turned
    air: Annotated[Floats, 3, WIDTH]  # its wind in that frame [m/s]
    turned: Annotated[Floats, 3, WIDTH]  # rotation of what the wind sees from there
    # What the last force took off the relative wind, over the compliance [N]:
    drag_impulse: Annotated[Floats, 3, WIDTH]
    own_force: Annotated[Floats, 3, WIDTH]  # in the frame of the branch as it is turned
    force: Annotated[Floats, 3, WIDTH]  # the same in that of its base
    moment: Annotated[Floats, 3, WIDTH]  # about the base, in its frame [N m]
    load: Annotated[Floats, 'loads', WIDTH]  # along b, then on each coordinate [N m]


class Oscillators(Load):
    """Oscillators of sixteen branches that follow each other, and the wind load on them."""

    now_x: Annotated[Floats, 2, WIDTH]
    now_v: Annotated[Floats, 2, WIDTH]
    whole: Annotated[Floats, 8, WIDTH]  # rows of the propagator of a step
    half: Annotated[Floats, 6, WIDTH]  # of half a step under a constant load
    guard: Annotated[Floats, 3, WIDTH]  # rows of `two_axis.guards`


class Table:
    """
    Table of one tree, by azimuth, level of the lean, and coordinate.

    What a step reads whole is in single precision.
    """

    n_modes: int
    degree: int
    levels: Annotated[Floats, N_AZIMUTHS, N_LEVELS]  # leans of a tree in steady winds, rising
    most_pressure: float  # up to which the table holds [kg/m/s^2]
    most_energy: float  # of strain and motion, twice, up to which a wind takes it [J]
    stiffness: Annotated[Floats, 'modes']
    limit: Annotated[Floats, 'modes']  # largest load of a steady wind, per dynamic pressure
    motion: Annotated[Floats, 'modes']  # mean square of what the wind meets moves at
    harmonics: Annotated[Floats, 'harmonics', 'modes']
    standing: Annotated[Floats, N_AZIMUTHS, N_LEVELS, 'modes']  # coordinates in steady winds
    amount: Annotated[Floats, N_AZIMUTHS, 'modes']  # weights of the coordinates in the lean
    load: Annotated[Floats, N_AZIMUTHS, N_LEVELS, 'modes']
    # Sums of the damping of each coordinate by the rates of all others, whatever the signs:
    cross_damping: Annotated[Floats, N_AZIMUTHS, N_LEVELS, 'modes']
    # By the coordinate that moves, then the one that is loaded:
    lean: Annotated[Singles, N_AZIMUTHS, 'modes', 'modes']
    turning: Annotated[Singles, N_AZIMUTHS, N_LEVELS, 'modes', 'modes']
    damping: Annotated[Singles, N_AZIMUTHS, N_LEVELS, 'modes', 'modes']
    steep_turning: Annotated[Singles, 2, 'modes', 'modes']  # in winds straight down and up
    steep_damping: Annotated[Singles, 2, 'modes', 'modes']


class TimeStep:
    """How the coordinates of a table go on in a time step."""

    whole: Annotated[Floats, 8, 'modes']  # columns of the propagator of a step
    half: Annotated[Floats, 6, 'modes']  # of half a step under a constant load


class Instance:
    """State of one tree on a table, and scratch."""

    outside: int  # whether the last wind was outside of the table
    eta: Annotated[Floats, 'modes']
    rate: Annotated[Floats, 'modes']
    force: Annotated[Floats, 'modes']
    wind: Annotated[Floats, 3]  # [m/s]
    pressure: float  # drag per area and speed squared [kg/m^3]
    middle: Annotated[Floats, 'modes']
    middle_rate: Annotated[Floats, 'modes']
    wanted: Annotated[Floats, 'modes']
    diagonal: Annotated[Floats, 'modes']
    scratch: Annotated[Singles, 4, 'modes']
    values: Annotated[Floats, 'harmonics']
    left_out: int  # coordinates, the last ones, that are not shown and not felt
    faded: Annotated[Floats, 'modes']  # share of each that is not shown


Branches = RecordsOf[Branch]
Segments = RecordsOf[Segment]
Heads = RecordsOf[Head]
Works = RecordsOf[Work]
Loads = RecordsOf[Load]
Banks = RecordsOf[Oscillators]
Tables = RecordsOf[Table]
TimeSteps = RecordsOf[TimeStep]
Instances = RecordsOf[Instance]


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


@cache
def table_layout(n_modes: int, n_harmonics: int) -> np.dtype[np.void]:
    """
    Lay out `Table`; coordinates are filled up to a multiple of eight, at least 24.

    One layout serves most trees, so that the kernel is compiled once.
    """
    m = max(_LEAST_MODES, -(-n_modes // _MODES_TOGETHER) * _MODES_TOGETHER)
    return np.dtype(fields_of(Table, modes=m, harmonics=n_harmonics))


@cache
def time_step_layout(n_modes: int) -> np.dtype[np.void]:
    """Lay out `TimeStep`."""
    return np.dtype(fields_of(TimeStep, modes=table_layout(n_modes, 0)['stiffness'].shape[0]))


@cache
def instance_layout(n_modes: int, n_harmonics: int) -> np.dtype[np.void]:
    """Lay out `Instance`."""
    m = table_layout(n_modes, n_harmonics)['stiffness'].shape[0]
    return np.dtype(fields_of(Instance, modes=m, harmonics=n_harmonics))
