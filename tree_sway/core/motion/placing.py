# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Key rotations to poses: segments follow the key of their branch, branches join from the root.

A segment turns by its slope times the branch's rotation vector, so a branch bends as one smooth
curve and keeps its length. The chord of the bent chain turns by a little less than the coordinate
says (third cumulant of the slope along the branch); the coordinate is stretched by that much, so
that the chord angle is kept. Beyond 30 degrees a tapered branch goes over to the slope of a load
at the tip.

Sixteen branches at a time, parents before their children: how the bases are turned and where they
stand, then segment after segment up the sixteen branches at once.

The pose block is (n, 7) float64 in message order: x y z, then the quaternion as x y z w. A pose
is at its segment's root-side node, its x axis runs along the segment (REP-103).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Singles
from tree_sway.core.kernel import fused, inlined, part
from tree_sway.core.motion.records import (
    Branches,
    Head,
    Heads,
    instance_layout,
    Instances,
    LANES,
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
    quaternion,
    rotated,
    SERIES_LIMIT,
)

_BLEND_FROM = np.deg2rad(30.0) ** 2
_BLEND_TO = np.deg2rad(45.0) ** 2
_PER_BLEND = 1.0 / (_BLEND_TO - _BLEND_FROM)
_STRETCH_TO = np.deg2rad(90.0) ** 2


GIVEN = np.zeros(1, instance_layout(0, 1)), np.zeros((0, 0, TOGETHER), dtype=np.float32)
"""An instance and shapes for `place` where key rotations are given."""


@fused
def expand(instances: Instances, shapes: Singles, x: Floats) -> None:
    """Write key rotations (N,) of the first instance, by shapes as of `shapes_together`."""
    instance = instances[0]
    eta, faded, shown = instance.eta, instance.faded, instance.wanted
    for k in range(len(eta)):
        shown[k] = (1.0 - faded[k]) * eta[k]
    shown = shown[: len(eta) - instance.left_out]
    for block in range(len(shapes)):
        add_shapes(shapes, block, shown, x)


@fused
def place(
    instances: Instances, shapes: Singles,
    branches: Branches, segments: Segments, heads: Heads, bases: Floats,
    cosine: float, sine: float, scale: float, x: Floats, origin: Floats, out: Floats,
) -> None:  # fmt: skip
    """
    Place every segment of a tree.

    Parameters
    ----------
    instances, shapes
        What key rotations are found from (`expand`), or `GIVEN`.
    branches, segments, heads
        Records of `BRANCH` (b,), `SEGMENT` and `head_layout`.
    bases
        Written: orientation of each base from rest, w x y z, then half the key rotation,
        stretched, for who sits on a plain branch, (b, 8).
    cosine, sine
        Of half the angle that the tree is turned by about the vertical.
    scale
        Its size over that of its records.
    x
        Key rotations, (N,), in the order of the coordinates; written unless they are given.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    expand(instances, shapes, x)
    last = len(heads) - 1
    scratch = heads[last]
    for block in range(last):
        head = heads[block]
        _read_parents(branches, head, scratch, bases, x, origin, cosine, sine, out)
        is_near = _turn_on_parents(head, scratch)
        if is_near:
            farthest = _turn_bases(head, scratch, scale, True)
        else:
            farthest = _turn_bases(head, scratch, scale, False)
        _write_bases(head, scratch, bases)
        if head.n_rows > 2:
            farthest = max(farthest, _set_further_keys(branches, head, scratch, x))
        is_near = is_near and farthest <= NEAR_LIMIT
        for rank in range(head.n_records):
            segment = segments[head.block + rank]
            if is_near and head.n_rows == 2 and head.is_joined:
                _bend_and_join(segment, scratch, scale)
            else:
                if not farthest <= SERIES_LIMIT:
                    _bend_far(segment, scratch, head.n_rows)
                elif head.n_rows > 2:
                    _bend(segment, scratch)
                else:
                    _bend_in_plane(segment, scratch)
                _join(segment, scratch, scale)
            _write_poses(head, scratch, rank, segment.n_lanes, out)


@part
def _read_parents(
    branches: Branches, head: Head, scratch: Head, bases: Floats, x: Floats, origin: Floats,
    cosine: float, sine: float, out: Floats,
) -> None:  # fmt: skip
    """Collect the keys of sixteen branches and how the parents of these are turned and stand."""
    key, parent_key = scratch.key, scratch.parent_key
    base, carrier = scratch.parent_base, scratch.carrier
    if head.n_parent_rows > 2:
        parent_key[2:] = 0.0
    if head.parent[0] < 0:  # the stem, alone
        parent_key[:], base[:], carrier[:] = 0.0, 0.0, 0.0
        base[0, 0], base[1, 0], base[2, 0], base[3, 0] = cosine, 0.0, 0.0, sine
        carrier[0, 0], carrier[1, 0], carrier[2, 0] = origin[0], origin[1], origin[2]
        carrier[5, 0], carrier[6, 0] = sine, cosine
        key[:] = 0.0
        key[0, 0], key[1, 0] = x[head.coordinate[0]], x[head.coordinate[0] + 1]
        return
    parents, on = head.parent, head.base_segment
    for j in range(0, head.n_lanes, 4):  # what is read of lanes that are empty is of no account
        a, b, c, d = on[j], on[j + 1], on[j + 2], on[j + 3]
        take_four(out, a, b, c, d, 0, carrier, 0, j)
        take_four(out, a, b, c, d, 3, carrier, 3, j)
        a, b, c, d = parents[j], parents[j + 1], parents[j + 2], parents[j + 3]
        take_four(bases, a, b, c, d, 0, base, 0, j)
        take_four(bases, a, b, c, d, 4, base, 4, j)
    for j in range(head.n_lanes):
        i = np.uintp(head.coordinate[j])
        key[0, j], key[1, j] = x[i], x[i + np.uintp(1)]
    for j in range(head.n_lanes, LANES):  # which series is taken hangs on no key of before
        key[0, j], key[1, j] = 0.0, 0.0
    if head.n_parent_rows > 2:
        for j in range(LANES):
            parent_key[0, j], parent_key[1, j] = base[4, j], base[5, j]
        for j in range(head.n_lanes):
            parent = branches[parents[j]]
            own = parent.coordinate
            for c in range(2, parent.n_coordinates):
                parent_key[c, j] = 0.5 * x[own + c]


@inlined
def _turn_by(key: Floats, per: Floats, turned: Floats, n_rows: int, j: int) -> None:
    """Sum what the first rows of keys turn the lane j by."""
    hx, hy, hz = 0.0, 0.0, 0.0
    for c in range(n_rows):
        u = key[c, j]
        hx, hy, hz = hx + u * per[c, 0, j], hy + u * per[c, 1, j], hz + u * per[c, 2, j]
    turned[0, j], turned[1, j], turned[2, j] = hx, hy, hz


@inlined
def _is_beyond(turned: Floats, key: Floats, j: int) -> int:
    """Return 1 where the lane j is turned or bent further than the short series holds."""
    hx, hy, hz, x, y = turned[0, j], turned[1, j], turned[2, j], key[0, j], key[1, j]
    return 1 if hx * hx + hy * hy + hz * hz > NEAR_LIMIT or x * x + y * y > _BLEND_FROM else 0


@part
def _turn_on_parents(head: Head, scratch: Head) -> bool:
    """
    Find how sixteen branches are turned from the bases of their parents, by half the vector.

    Returns whether none is turned, nor bent by its key, beyond the short series.
    """
    key, per, turned = scratch.parent_key, head.base_turn, scratch.carrier_turn
    base, n_beyond = scratch.parent_base, 0
    if head.n_parent_rows == 2:
        for j in range(LANES):
            _turn_by(base[4:], per, turned, 2, j)
            n_beyond += _is_beyond(turned, scratch.key, j)
    else:
        for j in range(LANES):
            _turn_by(key, per, turned, per.shape[0], j)
            n_beyond += _is_beyond(turned, scratch.key, j)
    if n_beyond == 0:
        return True
    for j in range(head.n_lanes):
        hx, hy, hz = turned[0, j], turned[1, j], turned[2, j]
        if hx * hx + hy * hy + hz * hz > SERIES_LIMIT:
            qw, qx, qy, qz = quaternion(2.0 * hx, 2.0 * hy, 2.0 * hz)
            base[0, j], base[1, j], base[2, j], base[3, j] = product(
                base[0, j], base[1, j], base[2, j], base[3, j], qw, qx, qy, qz
            )
            turned[0, j], turned[1, j], turned[2, j] = 0.0, 0.0, 0.0
    return False


@part
def _turn_bases(head: Head, scratch: Head, scale: float, is_near: bool) -> float:
    """
    Turn the bases of sixteen branches, place them, and set how their first shape bends.

    Returns a bound on the square of half the angle that any segment turns by.
    """
    key, below = scratch.key, scratch.parent_base
    carrier, turned = scratch.carrier, scratch.carrier_turn
    frame, offset = head.frame, head.offset
    base, half_turn, half_key, swing, following = (
        scratch.base, scratch.half_turn, scratch.half_key, scratch.swing, scratch.next
    )  # fmt: skip
    together = 0.0
    for j in range(LANES):
        x, y = key[0, j], key[1, j]
        t = x * x + y * y
        blend, bounded = 0.0, 0.5 * t
        if not is_near:
            blend = min(max((t - _BLEND_FROM) * _PER_BLEND, 0.0), 1.0)
            bounded = 0.5 * min(t, _STRETCH_TO)
        own = 0.5 + bounded * head.skew[j]
        half = own
        if not is_near:
            half += bounded * blend * (head.tip_skew[j] - head.skew[j])
        ux = x * frame[2, 0, j] - y * frame[1, 0, j]
        uy = x * frame[2, 1, j] - y * frame[1, 1, j]
        uz = x * frame[2, 2, j] - y * frame[1, 2, j]
        base[4, j], base[5, j] = own * x, own * y
        wx, wy, wz = half * ux, half * uy, half * uz
        half_turn[0, j], half_turn[1, j], half_turn[2, j] = wx, wy, wz
        half_key[0, j], half_key[1, j] = half * x, half * y
        square = half * half * t
        scratch.blend[j], scratch.square[j] = blend, square
        scratch.half_angle[j] = square * head.steepest[j]
        together += square * head.steepest[j]
        hx, hy, hz = turned[0, j], turned[1, j], turned[2, j]
        if is_near:
            c, s = half_angle_near(hx * hx + hy * hy + hz * hz)
        else:
            c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = product(
            below[0, j], below[1, j], below[2, j], below[3, j], c, s * hx, s * hy, s * hz
        )
        base[0, j], base[1, j], base[2, j], base[3, j] = bw, bx, by, bz
        swing[0, j] = -bx * wx - by * wy - bz * wz
        swing[1, j] = bw * wx + by * wz - bz * wy
        swing[2, j] = bw * wy - bx * wz + bz * wx
        swing[3, j] = bw * wz + bx * wy - by * wx
    if head.is_at_axes:
        for j in range(LANES):
            _reach_ahead(carrier, following, scale * offset[0, j], j)
    else:
        for j in range(LANES):
            _reach(carrier, following, scale, offset, j)
    if together <= NEAR_LIMIT:
        return together
    farthest = 0.0
    for j in range(head.n_lanes):
        farthest = max(farthest, scratch.half_angle[j])
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
def _set_further_keys(branches: Branches, head: Head, scratch: Head, x: Floats) -> float:
    """Set the further coordinates; return as `_turn_bases`, of the branches that have them."""
    farthest, half_key = 0.0, scratch.half_key
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
        # The square of a sum is at most twice the square of its first and twice that of the
        # others.
        others = branch.n_coordinates - 2
        farthest = max(farthest, 2.0 * (scratch.half_angle[j] + others * further))
    return farthest


@part
def _write_poses(head: Head, scratch: Head, rank: int, n_lanes: int, out: Floats) -> None:
    """Write the poses of sixteen segments, each behind the one before it on its branch."""
    pose, first = scratch.pose, head.first
    whole = n_lanes - n_lanes % 4
    for j in range(0, whole, 4):
        a, b, c, d = first[j] + rank, first[j + 1] + rank, first[j + 2] + rank, first[j + 3] + rank
        put_four(pose, 0, j, out, a, b, c, d, 0)
        put_four(pose, 3, j, out, a, b, c, d, 3)
    for j in range(whole, n_lanes):
        for row in range(7):
            out[first[j] + rank, row] = pose[row, j]


@part
def _half_vector(segment: Segment, scratch: Head, j: int) -> tuple[float, float, float]:
    """Half the rotation vector of a segment of the lane j, by all its coordinates."""
    turn, half_key, half_turn = segment.turn, scratch.half_key, scratch.half_turn
    far = scratch.blend[j] * (segment.tip_slope[j] - segment.slope[j])
    hx, hy, hz = far * half_turn[0, j], far * half_turn[1, j], far * half_turn[2, j]
    # All rows that there is room for: a count known when compiled lets the lanes be a vector.
    for c in range(turn.shape[0]):
        key = half_key[c, j]
        hx, hy, hz = hx + key * turn[c, 0, j], hy + key * turn[c, 1, j], hz + key * turn[c, 2, j]
    return hx, hy, hz


@part
def _turn(
    segment: Segment, scratch: Head, j: int, qw: float, qx: float, qy: float, qz: float
) -> None:
    """Turn the segment of the lane j from rest."""
    rest, pose = segment.rest, scratch.pose
    pose[6, j], pose[3, j], pose[4, j], pose[5, j] = product(
        qw, qx, qy, qz, rest[0, j], rest[1, j], rest[2, j], rest[3, j]
    )


@part
def _reach_ahead(pose: Floats, to: Floats, length: float, j: int) -> None:
    """Find where the x axis of the pose of the lane j reaches."""
    x, y, z, w = pose[3, j], pose[4, j], pose[5, j], pose[6, j]
    twice = length + length
    to[0, j] = pose[0, j] + length - twice * (y * y + z * z)
    to[1, j] = pose[1, j] + twice * (x * y + w * z)
    to[2, j] = pose[2, j] + twice * (x * z - w * y)


@part
def _reach(pose: Floats, to: Floats, scale: float, own: Floats, j: int) -> None:
    """Find where a point of a segment's own frame is at the pose of the lane j."""
    x, y, z = rotated(
        pose[6, j], pose[3, j], pose[4, j], pose[5, j], own[0, j], own[1, j], own[2, j]
    )
    to[0, j] = pose[0, j] + scale * x
    to[1, j] = pose[1, j] + scale * y
    to[2, j] = pose[2, j] + scale * z


@part
def _join(segment: Segment, scratch: Head, scale: float) -> None:
    """Put sixteen turned segments behind those before them, and find where the next ones are."""
    pose, following, reach = scratch.pose, scratch.next, segment.reach
    for j in range(LANES):
        pose[0, j], pose[1, j], pose[2, j] = following[0, j], following[1, j], following[2, j]
        _reach(pose, following, scale, reach, j)


@part
def _swing(segment: Segment, scratch: Head, j: int, c: float, s: float) -> None:
    """Turn the segment of the lane j about the one axis of its branch."""
    base, swing = scratch.base, scratch.swing
    _turn(
        segment, scratch, j,
        c * base[0, j] + s * swing[0, j], c * base[1, j] + s * swing[1, j],
        c * base[2, j] + s * swing[2, j], c * base[3, j] + s * swing[3, j],
    )  # fmt: skip


@part
def _bend_and_join(segment: Segment, scratch: Head, scale: float) -> None:
    """Turn and join sixteen straight segments of branches that bend a little about one axis."""
    pose, following, reach = scratch.pose, scratch.next, segment.reach
    for j in range(LANES):
        slope = segment.slope[j]
        c, s = half_angle_near(slope * slope * scratch.square[j])
        _swing(segment, scratch, j, c, s * slope)
        pose[0, j], pose[1, j], pose[2, j] = following[0, j], following[1, j], following[2, j]
        _reach_ahead(pose, following, scale * reach[0, j], j)


@part
def _bend_in_plane(segment: Segment, scratch: Head) -> None:
    """Turn sixteen segments, each of a branch that bends about one axis."""
    slope = segment.slope
    for j in range(LANES):
        first = slope[j] + scratch.blend[j] * (segment.tip_slope[j] - slope[j])
        c, s = half_angle_series(first * first * scratch.square[j])
        _swing(segment, scratch, j, c, s * first)


@part
def _bend(segment: Segment, scratch: Head) -> None:
    """Turn sixteen segments of branches with further coordinates."""
    base = scratch.base
    for j in range(LANES):
        hx, hy, hz = _half_vector(segment, scratch, j)
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = base[0, j], base[1, j], base[2, j], base[3, j]
        qw, qx, qy, qz = product(bw, bx, by, bz, c, s * hx, s * hy, s * hz)
        _turn(segment, scratch, j, qw, qx, qy, qz)


@part
def _bend_far(segment: Segment, scratch: Head, n_rows: int) -> None:
    """Turn sixteen segments, some of a branch that bends beyond the series."""
    base, half_turn = scratch.base, scratch.half_turn
    for j in range(segment.n_lanes):
        if n_rows > 2:
            hx, hy, hz = _half_vector(segment, scratch, j)
        else:
            slope = segment.slope[j]
            slope += scratch.blend[j] * (segment.tip_slope[j] - slope)
            hx, hy, hz = slope * half_turn[0, j], slope * half_turn[1, j], slope * half_turn[2, j]
        c, s = half_angle(hx * hx + hy * hy + hz * hz)
        bw, bx, by, bz = base[0, j], base[1, j], base[2, j], base[3, j]
        qw, qx, qy, qz = product(bw, bx, by, bz, c, s * hx, s * hy, s * hz)
        _turn(segment, scratch, j, qw, qx, qy, qz)
