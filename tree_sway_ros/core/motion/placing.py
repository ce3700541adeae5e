# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
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
    place_standing_at(
        branches, segments, heads, work, x, origin[0], origin[1], origin[2], 1.0, 0.0, 1.0, out
    )


@fused
def place_standing_at(
    branches: Any, segments: Any, heads: Any, work: Any, x: Floats,
    east: float, north: float, up: float, cosine: float, sine: float, scale: float, out: Floats,
) -> None:  # fmt: skip
    """
    Place every segment of a tree that is turned and scaled.

    Parameters
    ----------
    branches, segments, heads, work, x, out
        As for `place`.
    east, north, up
        Root node.
    cosine, sine
        Of half the angle that the tree is turned by about the vertical.
    scale
        Its size over that of its records.

    """
    last = len(heads) - 1
    scratch = heads[last]
    at, pose = scratch.at, scratch.pose
    for block in range(last):
        head = heads[block]
        _read_parents(branches, head, scratch, work, x, east, north, up, cosine, sine, out)
        _turn_bases(head, scratch, scale)
        is_far = _write_bases(head, scratch, work)
        if head.n_rows > 2:
            is_far = _set_further_keys(branches, head, scratch, x) or is_far
        for rank in range(head.n_records):
            segment = segments[head.block + rank]
            if is_far:
                _bend_far(segment, scratch, head.n_rows)
            elif head.n_rows == 2:
                _bend_in_plane(segment, scratch)
            else:
                _bend(segment, scratch, head.n_rows)
            if head.is_joined:
                _join(segment, scratch, scale)
            else:
                _join_gaps(segment, scratch, scale)
            for j in range(segment.n_lanes):
                pose_to = out[np.uintp(head.first[j] + rank)]
                pose_to[0], pose_to[1], pose_to[2] = at[0, j], at[1, j], at[2, j]
                pose_to[3], pose_to[4], pose_to[5] = pose[1, j], pose[2, j], pose[3, j]
                pose_to[6] = pose[0, j]


@fused
def turn_at(parent: Any, turns: Floats, x: Floats) -> tuple[float, float, float, float]:
    """
    Rotation of a place on a branch.

    Parameters
    ----------
    parent
        Record of `BRANCH`.
    turns
        Rotation vector of that place per unit of each of its coordinates, (c, 3).
    x
        Key rotations, (N,).

    Returns
    -------
    tuple
        Quaternion w x y z, from rest.

    """
    hx, hy, hz = _half_turn_at(parent, turns, x)
    return quaternion(2.0 * hx, 2.0 * hy, 2.0 * hz)


@inlined
def _half_turn_at(parent: Any, turns: Floats, x: Floats) -> tuple[float, float, float]:
    """Half the rotation vector of a place on a branch, as `turn_at`."""
    i = parent.coordinate
    half = 0.5 + 0.5 * min(x[i] * x[i] + x[i + 1] * x[i + 1], _STRETCH_TO) * parent.skew
    ux, uy = half * x[i], half * x[i + 1]
    hx = ux * turns[0, 0] + uy * turns[1, 0]
    hy = ux * turns[0, 1] + uy * turns[1, 1]
    hz = ux * turns[0, 2] + uy * turns[1, 2]
    for c in range(2, parent.n_coordinates):
        u = 0.5 * x[i + c]
        hx, hy, hz = hx + u * turns[c, 0], hy + u * turns[c, 1], hz + u * turns[c, 2]
    return hx, hy, hz


@fused
def _read_parents(
    branches: Any, head: Any, scratch: Any, work: Any, x: Floats,
    east: float, north: float, up: float, cosine: float, sine: float, out: Floats,
) -> None:  # fmt: skip
    """Collect the keys of sixteen branches and how the parents of these are turned and stand."""
    turned, base, carrier = scratch.carrier_turn, scratch.parent_base, scratch.carrier
    for j in range(head.n_lanes):
        i = head.coordinate[j]
        scratch.key[0, j], scratch.key[1, j] = x[i], x[i + 1]
        if head.parent[j] < 0:
            hx, hy, hz = 0.0, 0.0, 0.0
            bw, bx, by, bz = cosine, 0.0, 0.0, sine
            px, py, pz = east, north, up
            sx, sy, sz, sw = 0.0, 0.0, sine, cosine
        else:
            below, on = work[head.parent[j]], head.base_segment[j]
            if head.is_parent_plain[j]:
                ux, uy, per = below.key[0], below.key[1], head.base_turn
                hx = ux * per[0, 0, j] + uy * per[1, 0, j]
                hy = ux * per[0, 1, j] + uy * per[1, 1, j]
                hz = ux * per[0, 2, j] + uy * per[1, 2, j]
            else:
                turns = branches[head.branch[j]].twist[:, 3:]
                hx, hy, hz = _half_turn_at(branches[head.parent[j]], turns, x)
            bw, bx, by, bz = below.base[0], below.base[1], below.base[2], below.base[3]
            if hx * hx + hy * hy + hz * hz > SERIES_LIMIT:
                qw, qx, qy, qz = quaternion(2.0 * hx, 2.0 * hy, 2.0 * hz)
                bw, bx, by, bz = product(bw, bx, by, bz, qw, qx, qy, qz)
                hx, hy, hz = 0.0, 0.0, 0.0
            px, py, pz = out[on, 0], out[on, 1], out[on, 2]
            sx, sy, sz, sw = out[on, 3], out[on, 4], out[on, 5], out[on, 6]
        turned[0, j], turned[1, j], turned[2, j] = hx, hy, hz
        base[0, j], base[1, j], base[2, j], base[3, j] = bw, bx, by, bz
        carrier[0, j], carrier[1, j], carrier[2, j] = px, py, pz
        carrier[3, j], carrier[4, j], carrier[5, j], carrier[6, j] = sx, sy, sz, sw


@fused
def _turn_bases(head: Any, scratch: Any, scale: float) -> None:
    """
    Turn the bases of sixteen branches, put them where they stand, and set how their first shape
    bends.

    """
    key, below = scratch.key, scratch.parent_base
    carrier, turned = scratch.carrier, scratch.carrier_turn
    frame, offset = head.frame, head.offset
    bent, base, half_turn, half_key, swing, following = (
        scratch.bent, scratch.base, scratch.half_turn, scratch.half_key, scratch.swing,
        scratch.next,
    )  # fmt: skip
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
        bent[0, j], bent[1, j] = own * x, own * y
        wx, wy, wz = half * ux, half * uy, half * uz
        half_turn[0, j], half_turn[1, j], half_turn[2, j] = wx, wy, wz
        half_key[0, j], half_key[1, j] = half * x, half * y
        square = half * half * t
        scratch.blend[j], scratch.square[j] = blend, square
        scratch.half_angle[j] = square * head.steepest[j]
        hx, hy, hz = turned[0, j], turned[1, j], turned[2, j]
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = product(
            below[0, j], below[1, j], below[2, j], below[3, j], c, s * hx, s * hy, s * hz
        )
        base[0, j], base[1, j], base[2, j], base[3, j] = bw, bx, by, bz
        swing[0, j], swing[1, j], swing[2, j], swing[3, j] = product(
            bw, bx, by, bz, 0.0, wx, wy, wz
        )
        ox, oy, oz = rotated(
            carrier[6, j], carrier[3, j], carrier[4, j], carrier[5, j],
            offset[0, j], offset[1, j], offset[2, j],
        )  # fmt: skip
        following[0, j] = carrier[0, j] + scale * ox
        following[1, j] = carrier[1, j] + scale * oy
        following[2, j] = carrier[2, j] + scale * oz


@fused
def _write_bases(head: Any, scratch: Any, work: Any) -> bool:
    """
    Leave for the children how their parents are turned; return whether any of these bends beyond
    the series.

    """
    is_far = False
    for j in range(head.n_lanes):
        here = work[head.branch[j]]
        for k in range(4):
            here.base[k] = scratch.base[k, j]
        here.key[0], here.key[1] = scratch.bent[0, j], scratch.bent[1, j]
        is_far |= not scratch.half_angle[j] <= SERIES_LIMIT
    return is_far


@fused
def _set_further_keys(branches: Any, head: Any, scratch: Any, x: Floats) -> bool:
    """Set the further coordinates; return whether any branch with them bends beyond the series."""
    is_far, half_key = False, scratch.half_key
    half_key[2:] = 0.0
    for j in range(head.n_lanes):
        branch = branches[head.branch[j]]
        if branch.n_coordinates == 2:
            continue
        i, further = branch.coordinate, 0.0
        for c in range(2, branch.n_coordinates):
            half = 0.5 * x[i + c]
            half_key[c, j] = half
            further += half * half * branch.steepest[c]
        # The square of a sum is at most twice the square of its first and twice that of the others.
        others = branch.n_coordinates - 2
        is_far |= not 2.0 * (scratch.half_angle[j] + others * further) <= SERIES_LIMIT
    return is_far


@inlined
def _half_vector(segment: Any, scratch: Any, n_rows: int, j: int) -> tuple[float, float, float]:
    """Half the rotation vector of a segment of the lane j, by all its coordinates."""
    turn, half_key, half_turn = segment.turn, scratch.half_key, scratch.half_turn
    far = scratch.blend[j] * (segment.tip_slope[j] - segment.slope[j])
    hx, hy, hz = far * half_turn[0, j], far * half_turn[1, j], far * half_turn[2, j]
    for c in range(n_rows):
        key = half_key[c, j]
        hx, hy, hz = hx + key * turn[c, 0, j], hy + key * turn[c, 1, j], hz + key * turn[c, 2, j]
    return hx, hy, hz


@inlined
def _turn(segment: Any, scratch: Any, j: int, qw: float, qx: float, qy: float, qz: float) -> None:
    """Turn the segment of the lane j from rest."""
    rest, pose = segment.rest, scratch.pose
    pose[0, j], pose[1, j], pose[2, j], pose[3, j] = product(
        qw, qx, qy, qz, rest[0, j], rest[1, j], rest[2, j], rest[3, j]
    )


@fused
def _join(segment: Any, scratch: Any, scale: float) -> None:
    """Put sixteen turned segments at the ends of those before them, and find their own ends."""
    pose, at, following, reach = scratch.pose, scratch.at, scratch.next, segment.reach
    for j in range(LANES):
        w, x, y, z = pose[0, j], pose[1, j], pose[2, j], pose[3, j]
        px, py, pz, length = following[0, j], following[1, j], following[2, j], scale * reach[0, j]
        at[0, j], at[1, j], at[2, j] = px, py, pz
        twice = length + length
        following[0, j] = px + length - twice * (y * y + z * z)
        following[1, j] = py + twice * (x * y + w * z)
        following[2, j] = pz + twice * (x * z - w * y)


@fused
def _join_gaps(segment: Any, scratch: Any, scale: float) -> None:
    """Do the same where the next segment does not start at this one's end."""
    pose, at, following, reach = scratch.pose, scratch.at, scratch.next, segment.reach
    for j in range(LANES):
        px, py, pz = following[0, j], following[1, j], following[2, j]
        at[0, j], at[1, j], at[2, j] = px, py, pz
        rx, ry, rz = rotated(
            pose[0, j], pose[1, j], pose[2, j], pose[3, j], reach[0, j], reach[1, j], reach[2, j]
        )
        following[0, j] = px + scale * rx
        following[1, j] = py + scale * ry
        following[2, j] = pz + scale * rz


@fused
def _bend_in_plane(segment: Any, scratch: Any) -> None:
    """Turn sixteen segments, each of a branch that bends about one axis."""
    slope, base, swing = segment.slope, scratch.base, scratch.swing
    for j in range(LANES):
        first = slope[j] + scratch.blend[j] * (segment.tip_slope[j] - slope[j])
        c, s = half_angle_series(first * first * scratch.square[j])
        s *= first
        _turn(
            segment, scratch, j,
            c * base[0, j] + s * swing[0, j], c * base[1, j] + s * swing[1, j],
            c * base[2, j] + s * swing[2, j], c * base[3, j] + s * swing[3, j],
        )  # fmt: skip


@fused
def _bend(segment: Any, scratch: Any, n_rows: int) -> None:
    """Turn sixteen segments of branches with further coordinates."""
    turn, half_key, half_turn, half = (
        segment.turn, scratch.half_key, scratch.half_turn, scratch.half,
    )  # fmt: skip
    for j in range(LANES):
        far = scratch.blend[j] * (segment.tip_slope[j] - segment.slope[j])
        for k in range(3):
            half[k, j] = far * half_turn[k, j]
    # Lane by lane within each coordinate, so that the loop is one of vectors.
    for row in range(n_rows):
        for j in range(LANES):
            key = half_key[row, j]
            half[0, j] += key * turn[row, 0, j]
            half[1, j] += key * turn[row, 1, j]
            half[2, j] += key * turn[row, 2, j]
    base = scratch.base
    for j in range(LANES):
        hx, hy, hz = half[0, j], half[1, j], half[2, j]
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = base[0, j], base[1, j], base[2, j], base[3, j]
        qw, qx, qy, qz = product(bw, bx, by, bz, c, s * hx, s * hy, s * hz)
        _turn(segment, scratch, j, qw, qx, qy, qz)


@fused
def _bend_far(segment: Any, scratch: Any, n_rows: int) -> None:
    """Turn sixteen segments, some of a branch that bends beyond the series."""
    base, half_turn = scratch.base, scratch.half_turn
    for j in range(segment.n_lanes):
        if n_rows > 2:
            hx, hy, hz = _half_vector(segment, scratch, n_rows, j)
        else:
            slope = segment.slope[j]
            slope += scratch.blend[j] * (segment.tip_slope[j] - slope)
            hx, hy, hz = slope * half_turn[0, j], slope * half_turn[1, j], slope * half_turn[2, j]
        c, s = half_angle(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = base[0, j], base[1, j], base[2, j], base[3, j]
        qw, qx, qy, qz = product(bw, bx, by, bz, c, s * hx, s * hy, s * hz)
        _turn(segment, scratch, j, qw, qx, qy, qz)
