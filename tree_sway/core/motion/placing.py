# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Key rotations to poses: segments follow the key of their branch, branches join from the root.

A segment turns by its slope times the branch's rotation vector, so a branch bends as one smooth
curve and keeps its length. The chord of the bent chain turns by a little less than the coordinate
says (third cumulant of the slope along the branch); the coordinate is stretched by that much, so
that the chord angle stays. Beyond 30 degrees a tapered branch goes over to the slope of a load
at the tip.

Sixteen branches at a time, parents before their children: how the bases are turned and where they
stand, then segment after segment up the sixteen branches at once.

The pose block is (n, 7) float64 in message order: x y z, then the quaternion as x y z w. A pose
is at its segment's root-side node, its x axis runs along the segment (REP-103).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Singles
from tree_sway.core.branch.shapes import MAX_COORDINATES
from tree_sway.core.kernel import fused, part
from tree_sway.core.motion.records import (
    Head,
    Heads,
    instance_layout,
    Instances,
    Segment,
    Segments,
)
from tree_sway.core.motion.simd import add_shapes, put_four, take_four, TOGETHER
from tree_sway.core.rotation import (
    half_angle,
    half_angle_near,
    half_angle_series,
    NEAR_LIMIT,
    product,
    rotated,
    SERIES_LIMIT,
)

_BLEND_FROM = np.deg2rad(30.0) ** 2
_BLEND_TO = np.deg2rad(45.0) ** 2
_PER_BLEND = 1.0 / (_BLEND_TO - _BLEND_FROM)
_STRETCH_TO = np.deg2rad(90.0) ** 2


GIVEN = np.zeros(1, instance_layout(0, 1)), np.zeros((0, 0, TOGETHER), dtype=np.float32)
"""An instance and shapes for `place` where key rotations are given."""

NONE = np.zeros(0)


@fused
def expand(instances: Instances, shapes: Singles, x: Floats) -> None:
    """Write key rotations (N,) of the first instance, by shapes as of `shapes_together`."""
    instance = instances[0]
    eta, faded, shown = instance.eta, instance.faded, instance.wanted
    for k in range(len(eta)):
        shown[k] = (1.0 - faded[k]) * eta[k]
    shown = shown[: shapes.shape[1] - instance.left_out]
    for block in range(len(shapes)):
        add_shapes(shapes, block, shown, x)


def room_for(n_coordinates: int) -> Floats:
    """Return zeros for `place` to write key rotations to: it reads past the last of a branch."""
    return np.zeros(n_coordinates + MAX_COORDINATES)


@fused
def place(
    instances: Instances, shapes: Singles, segments: Segments, heads: Heads, bases: Floats,
    cosine: float, sine: float, scale: float, x: Floats, given: Floats, origin: Floats,
    out: Floats,
) -> None:  # fmt: skip
    """
    Place every segment of a tree.

    Parameters
    ----------
    instances, shapes
        What key rotations are found from (`expand`), or `GIVEN` where they are given.
    segments, heads
        Records of `SEGMENT` and `head_layout`.
    bases
        Written: orientation of each base from rest, w x y z, then half the key rotation,
        stretched, (b, 8).
    cosine, sine
        Of half the angle that the tree is turned by about the vertical.
    scale
        Its size over that of its records.
    x
        Written: key rotations in the order of the coordinates, (N,), in a `room_for` them.
    given
        Key rotations, (N,), or `NONE` where they are found.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    if len(shapes) > 0:
        expand(instances, shapes, x)
    else:
        for i in range(len(given)):
            x[i] = given[i]
    last = len(heads) - 1
    scratch = heads[last]
    for block in range(last):
        head = heads[block]
        _read_parents(head, scratch, bases, x, origin, cosine, sine, out)
        is_near = _turn_on_parents(head, scratch)
        farthest = _turn_bases(head, scratch, scale, x, is_near)
        _write_bases(head, scratch, bases)
        is_short = is_near and farthest <= NEAR_LIMIT and head.n_rows == 2 and head.is_joined == 1
        for rank in range(head.n_records):
            segment = segments[head.block + rank]
            if is_short:
                _bend_and_join(segment, scratch, scale, head.n_eights)
            else:
                _bend(segment, scratch, head.n_rows, farthest, head.n_eights)
                _join(segment, scratch, scale, head.is_joined, head.n_eights)
            _write_poses(head, scratch, rank, segment.n_slots, out)


@part
def _read_parents(
    head: Head, scratch: Head, bases: Floats, x: Floats, origin: Floats,
    cosine: float, sine: float, out: Floats,
) -> None:  # fmt: skip
    """Collect the keys of sixteen branches and how the parents of these are turned and stand."""
    key, parent_key, carrier = scratch.key, scratch.parent_key, scratch.carrier
    base, parents, on = scratch.parent_base, head.parent, head.base_segment
    own = head.coordinate
    for j in range(8 * head.n_eights):  # slots that are empty have the keys of the stem
        i = np.uintp(own[j])
        key[0, j], key[1, j] = x[i], x[i + np.uintp(1)]
    if parents[0] < 0:  # the stem, alone
        for j in range(8 * head.n_eights):
            for row in range(7):
                base[row, j] = carrier[row, j] = 0.0
            base[0, j], base[3, j], carrier[5, j], carrier[6, j] = cosine, sine, sine, cosine
            carrier[0, j], carrier[1, j], carrier[2, j] = origin[0], origin[1], origin[2]
        return
    for j in range(0, head.n_slots, 4):  # what is read of slots that are empty is of no account
        a, b, c, d = on[j], on[j + 1], on[j + 2], on[j + 3]
        take_four(out, a, b, c, d, 0, carrier, 0, j)
        take_four(out, a, b, c, d, 3, carrier, 3, j)
        a, b, c, d = parents[j], parents[j + 1], parents[j + 2], parents[j + 3]
        take_four(bases, a, b, c, d, 0, base, 0, j)
        take_four(bases, a, b, c, d, 4, base, 4, j)
        if head.n_parent_rows > 2:
            _take_further(x, head.parent_coordinate, parent_key, j)


@part
def _take_further(x: Floats, first: Ints, keys: Floats, j: int) -> None:
    """Read further coordinates of four slots, and what lies behind those of who has fewer."""
    for c in range(2, keys.shape[0], 4):
        row = min(c, keys.shape[0] - 4)
        take_four(x, first[j], first[j + 1], first[j + 2], first[j + 3], row, keys, row, j)


@part
def _turn_on_parents(head: Head, scratch: Head) -> bool:
    """
    Find how sixteen branches are turned from the bases of their parents, by half the vector.

    Returns whether none is turned, nor bent by its key, beyond the short series.
    """
    key, per, turned = scratch.parent_key, head.base_turn, scratch.carrier_turn
    base, own, angle, n_beyond = scratch.parent_base, scratch.key, scratch.angle, 0
    for j in range(8 * head.n_eights):
        u, v = base[4, j], base[5, j]
        for k in range(3):
            turned[k, j] = u * per[0, k, j] + v * per[1, k, j]
    if head.n_parent_rows > 2:
        for j in range(8 * head.n_eights):
            hx, hy, hz = turned[0, j], turned[1, j], turned[2, j]
            for c in range(2, per.shape[0]):
                u = 0.5 * key[c, j]
                hx, hy, hz = hx + u * per[c, 0, j], hy + u * per[c, 1, j], hz + u * per[c, 2, j]
            turned[0, j], turned[1, j], turned[2, j] = hx, hy, hz
    for j in range(8 * head.n_eights):
        hx, hy, hz, u, v = turned[0, j], turned[1, j], turned[2, j], own[0, j], own[1, j]
        angle[j] = hx * hx + hy * hy + hz * hz
        n_beyond += 1 if angle[j] > NEAR_LIMIT or u * u + v * v > _BLEND_FROM else 0
    return n_beyond == 0


@part
def _half_angles(scratch: Head, farthest: float, n_eights: int) -> None:
    """Find cosine and sine over it of sixteen half angles from their squares, of which one is."""
    angle, cosine, sinc = scratch.angle, scratch.cosine, scratch.sinc
    if farthest <= NEAR_LIMIT:
        for j in range(8 * n_eights):
            cosine[j], sinc[j] = half_angle_near(angle[j])
    elif farthest <= SERIES_LIMIT:
        for j in range(8 * n_eights):
            cosine[j], sinc[j] = half_angle_series(angle[j])
    else:
        for j in range(8 * n_eights):
            cosine[j], sinc[j] = half_angle(angle[j])


@part
def _turn_bases(head: Head, scratch: Head, scale: float, x: Floats, is_near: bool) -> float:
    """
    Turn the bases of sixteen branches, place them, and set how their shapes bend.

    Returns a bound on the square of half the angle that any segment turns by.
    """
    key, below, steepest = scratch.key, scratch.parent_base, head.steepest
    turned, frame, base, swing = scratch.carrier_turn, head.frame, scratch.base, scratch.swing
    half_turn, half_key, bound = scratch.half_turn, scratch.half_key, scratch.bound
    _half_angles(scratch, 0.0 if is_near else np.inf, head.n_eights)
    for j in range(8 * head.n_eights):
        u, v = key[0, j], key[1, j]
        t = u * u + v * v
        blend = min(max((t - _BLEND_FROM) * _PER_BLEND, 0.0), 1.0)
        bounded = 0.5 * min(t, _STRETCH_TO)
        own = 0.5 + bounded * head.skew[j]
        half = own + bounded * blend * (head.tip_skew[j] - head.skew[j])
        wx = half * (u * frame[2, 0, j] - v * frame[1, 0, j])
        wy = half * (u * frame[2, 1, j] - v * frame[1, 1, j])
        wz = half * (u * frame[2, 2, j] - v * frame[1, 2, j])
        base[4, j], base[5, j] = own * u, own * v
        half_turn[0, j], half_turn[1, j], half_turn[2, j] = wx, wy, wz
        half_key[0, j], half_key[1, j] = half * u, half * v
        scratch.blend[j], scratch.square[j] = blend, half * half * t
        bound[j] = half * half * t * steepest[0, j]
        c, s = scratch.cosine[j], scratch.sinc[j]
        bw, bx, by, bz = product(
            below[0, j], below[1, j], below[2, j], below[3, j],
            c, s * turned[0, j], s * turned[1, j], s * turned[2, j],
        )  # fmt: skip
        base[0, j], base[1, j], base[2, j], base[3, j] = bw, bx, by, bz
        swing[0, j] = -bx * wx - by * wy - bz * wz
        swing[1, j] = bw * wx + by * wz - bz * wy
        swing[2, j] = bw * wy - bx * wz + bz * wx
        swing[3, j] = bw * wz + bx * wy - by * wx
    _reach(scratch.carrier, scratch.next, scale, head.offset, head.is_at_axes, head.n_eights)
    if head.n_rows > 2:
        # The square of a sum of n is at most n times the sum of the squares.
        for j in range(0, 8 * head.n_eights, 4):
            _take_further(x, head.coordinate, half_key, j)
        for j in range(8 * head.n_eights):
            most = bound[j]
            for c in range(2, half_key.shape[0]):
                half = 0.5 * half_key[c, j]
                half_key[c, j] = half
                most += half * half * steepest[c, j]
            bound[j] = most * head.last[j]
    together, farthest = 0.0, 0.0
    for j in range(8 * head.n_eights):
        together += bound[j]
    if together <= NEAR_LIMIT:
        return together
    for j in range(8 * head.n_eights):
        farthest = max(farthest, bound[j])
    return farthest


@part
def _write_bases(head: Head, scratch: Head, bases: Floats) -> None:
    """Leave their turned bases to the children."""
    branch, base, whole = head.branch, scratch.base, head.n_bearing - head.n_bearing % 4
    for j in range(0, whole, 4):
        a, b, c, d = branch[j], branch[j + 1], branch[j + 2], branch[j + 3]
        put_four(base, 0, j, bases, a, b, c, d, 0)
        put_four(base, 4, j, bases, a, b, c, d, 4)
    for j in range(whole, head.n_bearing):
        for row in range(6):
            bases[branch[j], row] = base[row, j]


@part
def _write_poses(head: Head, scratch: Head, rank: int, n_slots: int, out: Floats) -> None:
    """Write the poses of sixteen segments, each behind the one before it on its branch."""
    pose, first = scratch.pose, head.first
    whole = n_slots - n_slots % 4
    for j in range(0, whole, 4):
        a, b, c, d = first[j] + rank, first[j + 1] + rank, first[j + 2] + rank, first[j + 3] + rank
        put_four(pose, 0, j, out, a, b, c, d, 0)
        put_four(pose, 3, j, out, a, b, c, d, 3)
    for j in range(whole, n_slots):
        for row in range(7):
            out[first[j] + rank, row] = pose[row, j]


@part
def _reach(
    pose: Floats, to: Floats, scale: float, own: Floats, is_ahead: int, n_eights: int
) -> None:
    """Find where points of segments' own frames, all on their x axes or not, are at poses."""
    for j in range(8 * n_eights):
        x, y, z, w = pose[3, j], pose[4, j], pose[5, j], pose[6, j]
        length = scale * own[0, j]
        twice = length + length
        to[0, j] = pose[0, j] + length - twice * (y * y + z * z)
        to[1, j] = pose[1, j] + twice * (x * y + w * z)
        to[2, j] = pose[2, j] + twice * (x * z - w * y)
    if not is_ahead:
        for j in range(8 * n_eights):
            x, y, z = rotated(
                pose[6, j], pose[3, j], pose[4, j], pose[5, j], 0.0, own[1, j], own[2, j]
            )
            to[0, j] += scale * x
            to[1, j] += scale * y
            to[2, j] += scale * z


@part
def _join(segment: Segment, scratch: Head, scale: float, is_joined: int, n_eights: int) -> None:
    """Put sixteen turned segments behind those before them, and find where the next ones are."""
    pose, following = scratch.pose, scratch.next
    for j in range(8 * n_eights):
        pose[0, j], pose[1, j], pose[2, j] = following[0, j], following[1, j], following[2, j]
    _reach(pose, following, scale, segment.reach, is_joined, n_eights)


@part
def _bend_and_join(segment: Segment, scratch: Head, scale: float, n_eights: int) -> None:
    """Turn and join sixteen straight segments of branches that bend a little about one axis."""
    base, swing, rest, reach = scratch.base, scratch.swing, segment.rest, segment.reach
    pose, following = scratch.pose, scratch.next
    for j in range(8 * n_eights):
        slope = segment.slope[j]
        c, s = half_angle_near(slope * slope * scratch.square[j])
        s *= slope
        w, x, y, z = product(
            c * base[0, j] + s * swing[0, j], c * base[1, j] + s * swing[1, j],
            c * base[2, j] + s * swing[2, j], c * base[3, j] + s * swing[3, j],
            rest[0, j], rest[1, j], rest[2, j], rest[3, j],
        )  # fmt: skip
        length = scale * reach[0, j]
        twice = length + length
        px, py, pz = following[0, j], following[1, j], following[2, j]
        pose[0, j], pose[1, j], pose[2, j] = px, py, pz
        pose[3, j], pose[4, j], pose[5, j], pose[6, j] = x, y, z, w
        following[0, j] = px + length - twice * (y * y + z * z)
        following[1, j] = py + twice * (x * y + w * z)
        following[2, j] = pz + twice * (x * z - w * y)


@part
def _bend(segment: Segment, scratch: Head, n_rows: int, farthest: float, n_eights: int) -> None:
    """Turn sixteen segments from rest by all coordinates of their branches."""
    turn, half, angle, rest = segment.turn, scratch.half, scratch.angle, segment.rest
    base, half_key, half_turn = scratch.base, scratch.half_key, scratch.half_turn
    pose, blend = scratch.pose, scratch.blend
    if n_rows == 2:
        for j in range(8 * n_eights):
            slope = segment.slope[j]
            slope += blend[j] * (segment.tip_slope[j] - slope)
            hx, hy, hz = slope * half_turn[0, j], slope * half_turn[1, j], slope * half_turn[2, j]
            half[0, j], half[1, j], half[2, j] = hx, hy, hz
            angle[j] = hx * hx + hy * hy + hz * hz
    else:
        # All rows that there is room for: a count known when compiled lets the slots be a vector.
        for j in range(8 * n_eights):
            slope = blend[j] * (segment.tip_slope[j] - segment.slope[j])
            hx, hy, hz = slope * half_turn[0, j], slope * half_turn[1, j], slope * half_turn[2, j]
            for c in range(turn.shape[0]):
                u = half_key[c, j]
                hx, hy, hz = hx + u * turn[c, 0, j], hy + u * turn[c, 1, j], hz + u * turn[c, 2, j]
            half[0, j], half[1, j], half[2, j] = hx, hy, hz
            angle[j] = hx * hx + hy * hy + hz * hz
    _half_angles(scratch, farthest, n_eights)
    for j in range(8 * n_eights):
        c, s = scratch.cosine[j], scratch.sinc[j]
        w, x, y, z = product(
            base[0, j], base[1, j], base[2, j], base[3, j],
            c, s * half[0, j], s * half[1, j], s * half[2, j],
        )  # fmt: skip
        pose[6, j], pose[3, j], pose[4, j], pose[5, j] = product(
            w, x, y, z, rest[0, j], rest[1, j], rest[2, j], rest[3, j]
        )
