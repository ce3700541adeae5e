"""
Key rotations to poses: the segments of each branch follow its key, the branches are joined from the
root.

A segment turns by its slope times the branch's rotation vector, so a branch bends as one smooth
curve and keeps its length. The chord of the bent chain turns by a little less than the coordinate
says (third cumulant of the slope along the branch); the coordinate is stretched by that much, so
that the chord angle is kept. Beyond 30 degrees a tapered branch goes over to the slope of a load at
the tip.

Sixteen branches at a time, parents before their children: how the bases are turned and where they
stand, then segment after segment up the sixteen branches at once.

The pose block is (n, 7) float64 in message order: x y z, then the quaternion as x y z w. A pose
stands at its segment's root-side node, its x axis runs along the segment (REP-103).

"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.branch.shapes import N_SHAPES
from tree_sway_ros.core.kernel import fused, inlined
from tree_sway_ros.core.motion.records import LANES
from tree_sway_ros.core.rotation import (
    SERIES_LIMIT,
    half_angle,
    half_angle_series,
    product,
    quaternion,
    rotated,
)

_BLEND_FROM = np.deg2rad(30.0) ** 2
_BLEND_TO = np.deg2rad(45.0) ** 2
_PER_BLEND = 1.0 / (_BLEND_TO - _BLEND_FROM)
_STRETCH_TO = np.deg2rad(90.0) ** 2


@fused
def place(
    branches: Any, segments: Any, heads: Any, work: Any, x: Floats, origin: Floats, out: Floats
) -> None:  # fmt: skip
    """
    Place every segment.

    Parameters
    ----------
    branches, segments, heads, work
        Records of `BRANCH` (b,), `SEGMENT`, `head_layout` and `WORK` (b,); bases of the last are
        written.
    x
        Key rotations, (N,), in the order of the coordinates.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    room = heads[len(heads) - 1]
    at, pose = room.at, room.pose
    for block in range(len(heads) - 1):
        head = heads[block]
        _meet_parents(branches, head, room, work, x, origin, out)
        _turn_bases(head, room)
        is_far = _leave_bases(head, room, work)
        if not head.is_plain:
            is_far = _set_further_ways(branches, head, room, x) or is_far
        for rank in range(head.n_records):
            segment = segments[head.block + rank]
            if is_far:
                _bend_far(segment, room)
            elif head.is_plain:
                _bend_in_plane(segment, room)
            else:
                _bend(segment, room)
            for j in range(segment.n_lanes):
                row = head.first[j] + rank
                out[row, 0], out[row, 1], out[row, 2] = at[0, j], at[1, j], at[2, j]
                out[row, 3], out[row, 4], out[row, 5] = pose[1, j], pose[2, j], pose[3, j]
                out[row, 6] = pose[0, j]


@fused
def seat_turn(parent: Any, slope: Floats, x: Floats) -> tuple[float, float, float, float]:
    """
    Rotation of a place on a branch.

    Parameters
    ----------
    parent
        Record of `BRANCH`.
    slope
        Of its shapes and twists at that place, (c,).
    x
        Key rotations, (N,).

    Returns
    -------
    tuple
        Quaternion w x y z, from rest.

    """
    hx, hy, hz = _half_seat_turn(parent, slope, x)
    return quaternion(2.0 * hx, 2.0 * hy, 2.0 * hz)


@inlined
def _half_seat_turn(parent: Any, slope: Floats, x: Floats) -> tuple[float, float, float]:
    """Half the rotation vector of a place on a branch, as `seat_turn`."""
    i, pairs, frame = parent.coordinate, parent.n_pairs, parent.frame
    first = slope[0] * (1.0 + min(x[i] * x[i] + x[i + 1] * x[i + 1], _STRETCH_TO) * parent.skew)
    ux, uy, spin = first * x[i], first * x[i + 1], 0.0
    for p in range(1, pairs):
        ux += slope[p] * x[i + 2 * p]
        uy += slope[p] * x[i + 2 * p + 1]
    for p in range(parent.n_coordinates - 2 * pairs):
        spin += slope[N_SHAPES + p] * x[i + 2 * pairs + p]
    ux, uy, spin = 0.5 * ux, 0.5 * uy, 0.5 * spin
    return (
        ux * frame[2, 0] - uy * frame[1, 0] + spin * frame[0, 0],
        ux * frame[2, 1] - uy * frame[1, 1] + spin * frame[0, 1],
        ux * frame[2, 2] - uy * frame[1, 2] + spin * frame[0, 2],
    )


@fused
def _meet_parents(
    branches: Any, head: Any, room: Any, work: Any, x: Floats, origin: Floats, out: Floats
) -> None:
    """Collect the keys of sixteen branches and how the parents of these are turned and stand."""
    for j in range(head.n_lanes):
        i = head.coordinate[j]
        room.key[0, j], room.key[1, j] = x[i], x[i + 1]
        if head.parent[j] < 0:
            hx, hy, hz = 0.0, 0.0, 0.0
            bw, bx, by, bz = 1.0, 0.0, 0.0, 0.0
            px, py, pz = origin[0], origin[1], origin[2]
            sx, sy, sz, sw = 0.0, 0.0, 0.0, 1.0
        else:
            below, seat = work[head.parent[j]], head.seat[j]
            if head.rides_plain[j]:
                slope = head.seat_slope[j]
                hx, hy, hz = slope * below.turn[0], slope * below.turn[1], slope * below.turn[2]
            else:
                slopes = branches[head.branch[j]].seat_slope
                hx, hy, hz = _half_seat_turn(branches[head.parent[j]], slopes, x)
            bw, bx, by, bz = below.base[0], below.base[1], below.base[2], below.base[3]
            if hx * hx + hy * hy + hz * hz > SERIES_LIMIT:
                qw, qx, qy, qz = quaternion(2.0 * hx, 2.0 * hy, 2.0 * hz)
                bw, bx, by, bz = product(bw, bx, by, bz, qw, qx, qy, qz)
                hx, hy, hz = 0.0, 0.0, 0.0
            px, py, pz = out[seat, 0], out[seat, 1], out[seat, 2]
            sx, sy, sz, sw = out[seat, 3], out[seat, 4], out[seat, 5], out[seat, 6]
        room.seat_turn[0, j], room.seat_turn[1, j], room.seat_turn[2, j] = hx, hy, hz
        room.below[0, j], room.below[1, j], room.below[2, j], room.below[3, j] = bw, bx, by, bz
        room.under[0, j], room.under[1, j], room.under[2, j] = px, py, pz
        room.under[3, j], room.under[4, j], room.under[5, j], room.under[6, j] = sx, sy, sz, sw


@fused
def _turn_bases(head: Any, room: Any) -> None:
    """
    Turn the bases of sixteen branches, put them where they stand, and set how their first shape
    bends.

    """
    key, below, under, seat = room.key, room.below, room.under, room.seat_turn
    frame, offset = head.frame, head.offset
    turn, base, way, swing, at, ahead = (
        room.turn,
        room.base,
        room.way,
        room.swing,
        room.at,
        room.ahead,
    )
    for j in range(LANES):
        x, y = key[0, j], key[1, j]
        t = x * x + y * y
        blend = min(max((t - _BLEND_FROM) * _PER_BLEND, 0.0), 1.0)
        bounded = 0.5 * min(t, _STRETCH_TO)
        own = 0.5 + bounded * head.skew[j]
        half = own + bounded * blend * (head.tip_skew[j] - head.skew[j])
        ux = x * frame[2, 0, j] - y * frame[1, 0, j]
        uy = x * frame[2, 1, j] - y * frame[1, 1, j]
        uz = x * frame[2, 2, j] - y * frame[1, 2, j]
        turn[0, j], turn[1, j], turn[2, j] = own * ux, own * uy, own * uz
        wx, wy, wz = half * ux, half * uy, half * uz
        way[0, 0, j], way[0, 1, j], way[0, 2, j] = wx, wy, wz
        square = half * half * t
        room.blend[j], room.square[j], room.half_angle[j] = blend, square, square * head.steepest[j]
        hx, hy, hz = seat[0, j], seat[1, j], seat[2, j]
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = product(
            below[0, j], below[1, j], below[2, j], below[3, j], c, s * hx, s * hy, s * hz
        )
        base[0, j], base[1, j], base[2, j], base[3, j] = bw, bx, by, bz
        swing[0, j], swing[1, j], swing[2, j], swing[3, j] = product(
            bw, bx, by, bz, 0.0, wx, wy, wz
        )
        ox, oy, oz = rotated(
            under[6, j], under[3, j], under[4, j], under[5, j],
            offset[0, j], offset[1, j], offset[2, j],
        )  # fmt: skip
        at[0, j], at[1, j], at[2, j] = under[0, j] + ox, under[1, j] + oy, under[2, j] + oz
        ahead[0, j], ahead[1, j], ahead[2, j] = 0.0, 0.0, 0.0


@fused
def _leave_bases(head: Any, room: Any, work: Any) -> bool:
    """
    Leave for the children how their parents are turned; return whether any of these bends beyond
    the series.

    """
    is_far = False
    for j in range(head.n_lanes):
        here = work[head.branch[j]]
        for k in range(4):
            here.base[k] = room.base[k, j]
        for k in range(3):
            here.turn[k] = room.turn[k, j]
        is_far |= not room.half_angle[j] <= SERIES_LIMIT
    return is_far


@fused
def _set_further_ways(branches: Any, head: Any, room: Any, x: Floats) -> bool:
    """
    Set how further shapes and twists bend; return whether any branch with them bends beyond the
    series.

    """
    is_far, way = False, room.way
    way[1:] = 0.0
    for j in range(head.n_lanes):
        branch = branches[head.branch[j]]
        if branch.n_coordinates == 2:
            continue
        i, pairs, frame = branch.coordinate, branch.n_pairs, branch.frame
        further = 0.0
        for p in range(1, pairs):
            ux, uy = 0.5 * x[i + 2 * p], 0.5 * x[i + 2 * p + 1]
            for k in range(3):
                way[p, k, j] = ux * frame[2, k] - uy * frame[1, k]
            further += (ux * ux + uy * uy) * branch.steepest[p]
        for p in range(branch.n_coordinates - 2 * pairs):
            spin = 0.5 * x[i + 2 * pairs + p]
            for k in range(3):
                way[N_SHAPES + p, k, j] = spin * frame[0, k]
            further += spin * spin * branch.steepest[N_SHAPES + p]
        # The square of a sum is at most twice the square of its first and twice that of the others.
        is_far |= not 2.0 * (room.half_angle[j] + 5.0 * further) <= SERIES_LIMIT
    return is_far


@inlined
def _half_vector(segment: Any, room: Any, j: int) -> tuple[float, float, float]:
    """Half the rotation vector of a segment of the lane j, of all its shapes and twists."""
    slope, way = segment.slope, room.way
    first = slope[0, j] + room.blend[j] * (segment.tip_slope[j] - slope[0, j])
    hx, hy, hz = first * way[0, 0, j], first * way[0, 1, j], first * way[0, 2, j]
    for c in range(1, slope.shape[0]):
        hx += slope[c, j] * way[c, 0, j]
        hy += slope[c, j] * way[c, 1, j]
        hz += slope[c, j] * way[c, 2, j]
    return hx, hy, hz


@inlined
def _turn(segment: Any, room: Any, j: int, qw: float, qx: float, qy: float, qz: float) -> None:
    """Turn the segment of the lane j from rest, at the end of the one before."""
    rest, chord, pose, at, ahead = segment.rest, segment.chord, room.pose, room.at, room.ahead
    at[0, j], at[1, j], at[2, j] = (
        at[0, j] + ahead[0, j],
        at[1, j] + ahead[1, j],
        at[2, j] + ahead[2, j],
    )
    pose[0, j], pose[1, j], pose[2, j], pose[3, j] = product(
        qw, qx, qy, qz, rest[0, j], rest[1, j], rest[2, j], rest[3, j]
    )
    ahead[0, j], ahead[1, j], ahead[2, j] = rotated(
        qw, qx, qy, qz, chord[0, j], chord[1, j], chord[2, j]
    )


@fused
def _bend_in_plane(segment: Any, room: Any) -> None:
    """Turn sixteen segments, each of a branch that bends about one axis."""
    slope, base, swing = segment.slope, room.base, room.swing
    for j in range(LANES):
        first = slope[0, j] + room.blend[j] * (segment.tip_slope[j] - slope[0, j])
        c, s = half_angle_series(first * first * room.square[j])
        s *= first
        _turn(
            segment, room, j,
            c * base[0, j] + s * swing[0, j], c * base[1, j] + s * swing[1, j],
            c * base[2, j] + s * swing[2, j], c * base[3, j] + s * swing[3, j],
        )  # fmt: skip


@fused
def _bend(segment: Any, room: Any) -> None:
    """Turn sixteen segments of branches with further shapes or twists."""
    base = room.base
    for j in range(LANES):
        hx, hy, hz = _half_vector(segment, room, j)
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = base[0, j], base[1, j], base[2, j], base[3, j]
        qw, qx, qy, qz = product(bw, bx, by, bz, c, s * hx, s * hy, s * hz)
        _turn(segment, room, j, qw, qx, qy, qz)


@fused
def _bend_far(segment: Any, room: Any) -> None:
    """Turn sixteen segments, some of a branch that bends beyond the series."""
    base = room.base
    for j in range(segment.n_lanes):
        hx, hy, hz = _half_vector(segment, room, j)
        c, s = half_angle(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = base[0, j], base[1, j], base[2, j], base[3, j]
        qw, qx, qy, qz = product(bw, bx, by, bz, c, s * hx, s * hy, s * hz)
        _turn(segment, room, j, qw, qx, qy, qz)
