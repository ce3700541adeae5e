# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Memory of the hot path: one record and one record of work per branch, one per sixteen segments.

A step visits every branch once and reads all its data, so the data of a branch is contiguous. A
kernel takes a record array as one argument, where each plain array costs a call about 0.2 us.
`fill_records` writes the constant fields.

Segments at the same place in sixteen branches are computed at once: a record has sixteen slots,
one per branch, and distances within it are constants, so that the compiler uses vectors. The
records of sixteen branches, from base to tip, make a block; parents are in earlier blocks than
their children. The wind load is computed for sixteen branches at once too, in the order of the
branches.

A tree on a table of winds has three records: its table, a time step, and its state.

Frames: ``rest`` is the tree's frame at rest, its origin the root node. Positions in [m], rotations
in [rad].
"""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, Ints, Records, RecordsOf, Singles
from tree_sway.core.beams.field_counts import ROOMS
from tree_sway.core.model.spherical_harmonics import N_HARMONICS

WIDTH = 16

N_AZIMUTHS, N_LEVELS = 24, 7
"""Azimuths of the wind and levels of the lean in the table."""

_MODES_TOGETHER = 8
_LEAST_MODES = 24


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
    first_record: int  # record of the first segment
    slot: int  # slot of all segments
    steepest: Annotated[Floats, 'rows']  # largest squared rotation of a segment per unit of each
    skew: float  # third cumulant of the slope shape, over 6
    tip_skew: float  # third cumulant of the tip-load shape, over 6
    offset: Annotated[Floats, 3]  # base from the base segment's start, in that frame
    base: Annotated[Floats, 3]  # base at rest
    arm: Annotated[Floats, 3]  # base at rest from the parent's base
    per_arm: float  # 0.5 over the squared length of the arm [1/m^2]


class Segment:
    """Data for placing one segment of each of sixteen branches."""

    slope: Annotated[Floats, WIDTH]  # slope shape of a plain branch
    tip_slope: Annotated[Floats, WIDTH]  # slope shape under a load at the tip
    chord: Annotated[Floats, 3, WIDTH]  # from the start of a segment to that of the next, at rest
    own_chord: Annotated[Floats, 3, WIDTH]  # chord in the frame of the segment
    rest: Annotated[Floats, 4, WIDTH]  # orientation at rest, w x y z
    segment_turn: Annotated[Floats, 'rows', 'axes', WIDTH]  # rotation per unit of coordinate
    n_slots: int  # number of branches that have this segment, in the first slots


class Block:
    """Data for placing the sixteen branches of a block, and scratch memory."""

    first_record: int  # first record of their segments
    n_records: int
    n_slots: int
    n_eights: int  # groups of eight slots, the last one filled up with empty slots
    n_parents: int  # slots up to the last branch that has children
    n_rows: int  # largest number of coordinates of a branch; 2 where all are plain
    n_parent_rows: int  # largest number of coordinates of a parent
    is_joined: int  # 1 where each segment starts at the end of the one before
    is_at_axes: int  # 1 where all bases are on the axes of their base segments
    # As in `Branch`:
    branch: Annotated[Ints, WIDTH]
    parent: Annotated[Ints, WIDTH]
    coordinate: Annotated[Ints, WIDTH]
    base_segment: Annotated[Ints, WIDTH]
    first: Annotated[Ints, WIDTH]
    frame: Annotated[Floats, 3, 3, WIDTH]
    skew: Annotated[Floats, WIDTH]
    tip_skew: Annotated[Floats, WIDTH]
    steepest: Annotated[Floats, 'rows', WIDTH]
    bound_factor: Annotated[Floats, WIDTH]  # number of its coordinates less one
    parent_coordinate: Annotated[Ints, WIDTH]
    # Rotation of the base per unit of each coordinate of its parent:
    base_rotation: Annotated[Floats, 'rows', 3, WIDTH]
    offset: Annotated[Floats, 3, WIDTH]
    # Scratch:
    key: Annotated[Floats, 2, WIDTH]  # key rotation
    parent_key: Annotated[Floats, 'rows', WIDTH]  # half of each parent's further coordinates
    parent_base: Annotated[Floats, 8, WIDTH]  # bases of `place`
    support: Annotated[Floats, 7, WIDTH]  # pose of the base segment
    # Half the rotation vector from the parent's base to its base:
    base_half: Annotated[Floats, 3, WIDTH]
    base: Annotated[Floats, 8, WIDTH]  # bases of the branches themselves
    blend: Annotated[Floats, WIDTH]  # share of the tip-load slope
    half_rotation: Annotated[Floats, 3, WIDTH]  # half the rotation vector per unit of slope
    half_key: Annotated[Floats, 'rows', WIDTH]  # half of each coordinate, stretched
    rotation_square: Annotated[Floats, WIDTH]  # squared length of half_rotation
    sine_part: Annotated[Floats, 4, WIDTH]  # quaternion of the base times half_rotation
    bound: Annotated[Floats, WIDTH]  # bound on the squared half angle of any segment
    half: Annotated[Floats, 3, WIDTH]  # half the rotation vector of the segment
    square: Annotated[Floats, WIDTH]  # squared half angle
    cosine: Annotated[Floats, WIDTH]  # cosine of the half angle
    sinc: Annotated[Floats, WIDTH]  # its sine over the half angle
    next: Annotated[Floats, 3, WIDTH]  # start of the next segment
    pose: Annotated[Floats, 7, WIDTH]  # pose of the segment, in message order


class Table:
    """
    Table of one tree, by azimuth, level of the lean, and coordinate.

    Fields that a step reads as a whole are in single precision.
    """

    n_modes: int
    levels: Annotated[Floats, N_AZIMUTHS, N_LEVELS]  # lean of the tree in steady winds, ascending
    most_pressure: float  # largest dynamic pressure of the table [kg/m/s^2]
    most_energy: float  # twice the largest strain and kinetic energy by wind [J]
    stiffness: Annotated[Floats, 'modes']
    limit: Annotated[Floats, 'modes']  # largest load of a steady wind, per dynamic pressure
    motion: Annotated[Floats, 'modes']  # mean square motion of the loaded pieces
    harmonics: Annotated[Floats, N_HARMONICS, 'modes']
    equilibrium: Annotated[Floats, N_AZIMUTHS, N_LEVELS, 'modes']  # coordinates in steady winds
    amount: Annotated[Floats, N_AZIMUTHS, 'modes']  # weights of the coordinates in the lean
    load: Annotated[Floats, N_AZIMUTHS, N_LEVELS, 'modes']
    # Sums of the absolute damping of each coordinate by the rates of all others:
    cross_damping: Annotated[Floats, N_AZIMUTHS, N_LEVELS, 'modes']
    # Slopes by the coordinate that moves, then the one that is loaded:
    lean: Annotated[Singles, N_AZIMUTHS, 'modes', 'modes']
    turning: Annotated[Singles, N_AZIMUTHS, N_LEVELS, 'modes', 'modes']
    damping: Annotated[Singles, N_AZIMUTHS, N_LEVELS, 'modes', 'modes']
    steep_turning: Annotated[Singles, 2, 'modes', 'modes']  # in winds straight down and up
    steep_damping: Annotated[Singles, 2, 'modes', 'modes']


class TimeStep:
    """Propagator of the coordinates of a table over a time step."""

    whole: Annotated[Floats, 8, 'modes']  # columns of the propagator of a step
    # Columns of the propagator of half a step under a constant load:
    half: Annotated[Floats, 6, 'modes']


class Instance:
    """State of one tree on a table, and scratch."""

    outside: int  # 1 where the last wind was outside of the table
    eta: Annotated[Floats, 'modes']
    rate: Annotated[Floats, 'modes']
    force: Annotated[Floats, 'modes']
    wind: Annotated[Floats, 3]  # [m/s]
    drag_density: float  # drag per area and squared speed [kg/m^3]
    middle: Annotated[Floats, 'modes']
    middle_rate: Annotated[Floats, 'modes']
    wanted: Annotated[Floats, 'modes']
    diagonal: Annotated[Floats, 'modes']
    change: Annotated[Floats, 'modes']  # of the force in the last pass of a step
    # Load by the distance from poses of the table, damping by rates, and the rates themselves:
    turned: Annotated[Singles, 'modes']
    damped: Annotated[Singles, 'modes']
    single_rate: Annotated[Singles, 'modes']
    distance: Annotated[Singles, 4, 'modes']  # distance from each of four poses, times its weight
    shown: Annotated[Singles, 'modes']  # coordinates less their hidden part
    values: Annotated[Floats, N_HARMONICS]
    left_out: int  # number of last coordinates that are neither shown nor loaded
    hidden: Annotated[Floats, 'modes']  # part of each coordinate that is not shown


Branches = RecordsOf[Branch]
Segments = RecordsOf[Segment]
Blocks = RecordsOf[Block]
Tables = RecordsOf[Table]
TimeSteps = RecordsOf[TimeStep]
Instances = RecordsOf[Instance]


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


_LINE = 64
"""Bytes of a cache line, and of the widest vector."""


def whole_lines(fields: list[tuple[Any, ...]]) -> np.dtype[np.void]:
    """Lay fields of whole vectors out first, then the others, padded to whole cache lines."""
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
    """Return a number of records of zeros, the first at the beginning of a cache line."""
    memory = np.zeros(count * layout.itemsize + _LINE, dtype=np.uint8)
    first = -memory.ctypes.data % _LINE
    return memory[first : first + count * layout.itemsize].view(layout)


@cache
def segment_layout(n_coordinates: int) -> np.dtype[np.void]:
    """Lay out `Segment`, without ``segment_turn`` where all branches are plain."""
    rows, axes = (n_coordinates, 3) if n_coordinates > 2 else (1, 1)
    return whole_lines(fields_of(Segment, rows=rows, axes=axes))


@cache
def block_layout(n_coordinates: int) -> np.dtype[np.void]:
    """
    Lay out `Block`.

    The last record, after that of the last block, is the scratch memory of all blocks, so that it
    stays in the fastest cache.
    """
    return whole_lines(fields_of(Block, rows=n_coordinates))


@cache
def table_layout(n_modes: int) -> np.dtype[np.void]:
    """
    Lay out `Table`; coordinates are filled up to a multiple of eight, at least 24.

    One layout serves most trees, so that the kernel is compiled once.
    """
    m = max(_LEAST_MODES, -(-n_modes // _MODES_TOGETHER) * _MODES_TOGETHER)
    return whole_lines(fields_of(Table, modes=m))


@cache
def time_step_layout(n_modes: int) -> np.dtype[np.void]:
    """Lay out `TimeStep`."""
    return np.dtype(fields_of(TimeStep, modes=table_layout(n_modes)['stiffness'].shape[0]))


@cache
def instance_layout(n_modes: int) -> np.dtype[np.void]:
    """Lay out `Instance`."""
    m = table_layout(n_modes)['stiffness'].shape[0]
    return np.dtype(fields_of(Instance, modes=m))
