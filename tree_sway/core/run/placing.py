# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Key rotations to poses: segments bend with their branch, branches are joined from the root.

A segment rotates by its slope times the rotation vector of the branch, so a branch bends as one
smooth curve and keeps its length. The chord of the bent chain rotates by a little less than the
coordinate (third cumulant of the slope along the branch); the coordinate is stretched by the
difference, so that the chord angle is right. Beyond 30 degrees the slope of a tapered branch is
blended with that of a load at the tip.

Sixteen branches are placed at a time, parents before their children: first orientation and
position of the bases, then one segment after the other of the sixteen branches.

The pose block is (n, 7) float64 in message order: x y z, then the quaternion as x y z w. A pose is
at its segment's root-side node, its x axis is along the segment (REP-103).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats, Ints, Singles
from tree_sway.core.beams.field_counts import MAX_COORDINATES
from tree_sway.core.kernel import fused, part
from tree_sway.core.model.records import (
    Block,
    Blocks,
    instance_layout,
    Instances,
    Segment,
    Segments,
    WIDTH,
)
from tree_sway.core.rotation import (
    half_angle,
    half_angle_near,
    half_angle_series,
    NEAR_LIMIT,
    product,
    rotated,
    SERIES_LIMIT,
)
from tree_sway.core.run.simd import add_shapes, put_four, take_four, TOGETHER

_BLEND_FROM = np.deg2rad(30.0) ** 2
_BLEND_TO = np.deg2rad(45.0) ** 2
_PER_BLEND = 1.0 / (_BLEND_TO - _BLEND_FROM)
_STRETCH_TO = np.deg2rad(90.0) ** 2


GIVEN = np.zeros(1, instance_layout(0)), np.zeros((0, 0, TOGETHER), dtype=np.float32)
"""An instance and shapes for `place` where key rotations are given."""

NONE = np.zeros(0)


@fused
def expand(instances: Instances, shapes: Singles, x: Floats) -> None:
    """Write key rotations (N,) of the first instance, by the shapes of `shapes_together`."""
    _expand(instances, shapes, x)


@part
def _expand(instances: Instances, shapes: Singles, x: Floats) -> None:
    instance = instances[0]
    eta, hidden, shown = instance.eta, instance.hidden, instance.shown
    for k in range(len(eta)):
        shown[k] = eta[k] - hidden[k]
    shown = shown[: shapes.shape[1] - instance.left_out]
    for block in range(len(shapes)):
        add_shapes(shapes, block, shown, x)


def room_for(n_coordinates: int) -> Floats:
    """Return zeros for `place` to write key rotations to, and some more that kernels read."""
    return np.zeros(n_coordinates + MAX_COORDINATES)


@fused
def place(
    instances: Instances, shapes: Singles, segments: Segments, blocks: Blocks, bases: Floats,
    cosine: float, sine: float, scale: float, x: Floats, given: Floats, origin: Floats,
    out: Floats,
) -> None:  # fmt: skip
    """
    Place every segment of a tree.

    Parameters
    ----------
    instances, shapes
        Coordinates and shapes of the key rotations (`expand`), or `GIVEN` where these are given.
    segments, blocks
        Records of `Segment` and `block_layout`.
    bases
        Orientation of each base from rest, w x y z, then half the stretched key rotation, (b, 8),
        written.
    cosine, sine
        Cosine and sine of half the rotation of the tree about the vertical.
    scale
        Size of the tree over that of its records.
    x
        Key rotations in the order of the coordinates, (N,), in an array of `room_for`, written.
    given
        Key rotations, (N,), or `NONE` where they are computed.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    if len(shapes) > 0:
        _expand(instances, shapes, x)
    else:
        for i in range(len(given)):
            x[i] = given[i]
    last = len(blocks) - 1
    scratch = blocks[last]
    for number in range(last):
        block = blocks[number]
        # With a known largest number of slots the compiler makes short loops.
        n = 8 * min(block.n_eights, WIDTH // 8)
        _read_parents(block, scratch, bases, x, origin, cosine, sine, out, n)
        is_near = _rotate_on_parents(block, scratch, n)
        largest = _rotate_bases(block, scratch, scale, x, n)
        _write_bases(block, scratch, bases)
        is_short = is_near and largest <= NEAR_LIMIT and block.n_rows == 2 and block.is_joined == 1
        for rank in range(block.n_records):
            segment = segments[block.first_record + rank]
            if is_short:
                _bend_and_join(segment, scratch, scale, n)
            else:
                _bend(segment, scratch, scale, block, largest, n)
            _write_poses(block, scratch, rank, segment.n_slots, out)


@part
def _read_parents(
    block: Block, scratch: Block, bases: Floats, x: Floats, origin: Floats,
    cosine: float, sine: float, out: Floats, n: int,
) -> None:  # fmt: skip
    """Read the keys of sixteen branches, and the bases and base segments of their parents."""
    key, parent_key, support = scratch.key, scratch.parent_key, scratch.support
    base, parents, on = scratch.parent_base, block.parent, block.base_segment
    coordinate = block.coordinate
    for j in range(n):  # empty slots have the keys of the stem
        i = np.uintp(coordinate[j])
        key[0, j], key[1, j] = x[i], x[i + np.uintp(1)]
    if parents[0] < 0:  # the stem
        for j in range(n):
            for row in range(7):
                base[row, j] = support[row, j] = 0.0
            base[0, j], base[3, j], support[5, j], support[6, j] = cosine, sine, sine, cosine
            support[0, j], support[1, j], support[2, j] = origin[0], origin[1], origin[2]
        return
    for j in range(0, block.n_slots, 4):  # values of empty slots are unused
        a, b, c, d = on[j], on[j + 1], on[j + 2], on[j + 3]
        take_four(out, a, b, c, d, 0, support, 0, j)
        take_four(out, a, b, c, d, 3, support, 3, j)
        a, b, c, d = parents[j], parents[j + 1], parents[j + 2], parents[j + 3]
        take_four(bases, a, b, c, d, 0, base, 0, j)
        take_four(bases, a, b, c, d, 4, base, 4, j)
        if block.n_parent_rows > 2:
            _read_further(x, block.parent_coordinate, parent_key, j)


@part
def _read_further(x: Floats, first: Ints, keys: Floats, j: int) -> None:
    """Read further coordinates of four slots, or values after the last one of a branch."""
    for c in range(2, keys.shape[0], 4):
        row = min(c, keys.shape[0] - 4)
        take_four(x, first[j], first[j + 1], first[j + 2], first[j + 3], row, keys, row, j)


@part
def _rotate_on_parents(block: Block, scratch: Block, n: int) -> bool:
    """
    Find half the rotation vectors of sixteen bases from the bases of their parents.

    Returns whether all these, and the key rotations, are within the range of the short series.
    """
    parent_key, mode, half = scratch.parent_key, block.base_rotation, scratch.base_half
    base, key, square, n_beyond = scratch.parent_base, scratch.key, scratch.square, 0
    is_further = block.n_parent_rows > 2
    for j in range(n):
        u, v = base[4, j], base[5, j]
        hx = u * mode[0, 0, j] + v * mode[1, 0, j]
        hy = u * mode[0, 1, j] + v * mode[1, 1, j]
        hz = u * mode[0, 2, j] + v * mode[1, 2, j]
        if is_further:
            for c in range(2, mode.shape[0]):
                u = 0.5 * parent_key[c, j]
                hx, hy, hz = hx + u * mode[c, 0, j], hy + u * mode[c, 1, j], hz + u * mode[c, 2, j]
        u, v, t = key[0, j], key[1, j], hx * hx + hy * hy + hz * hz
        half[0, j], half[1, j], half[2, j], square[j] = hx, hy, hz, t
        scratch.cosine[j], scratch.sinc[j] = half_angle_near(t)
        n_beyond += 1 if t > NEAR_LIMIT or u * u + v * v > _BLEND_FROM else 0
    if n_beyond > 0:
        _half_angles(scratch, np.inf, n)
    return n_beyond == 0


@part
def _half_angles(scratch: Block, largest: float, n: int) -> None:
    """Find cosine and sinc of sixteen half angles from squares up to the largest."""
    square, cosine, sinc = scratch.square, scratch.cosine, scratch.sinc
    if largest <= NEAR_LIMIT:
        for j in range(n):
            cosine[j], sinc[j] = half_angle_near(square[j])
    elif largest <= SERIES_LIMIT:
        for j in range(n):
            cosine[j], sinc[j] = half_angle_series(square[j])
    else:
        for j in range(n):
            cosine[j], sinc[j] = half_angle(square[j])


@part
def _rotate_bases(block: Block, scratch: Block, scale: float, x: Floats, n: int) -> float:
    """
    Rotate and place the bases of sixteen branches, and set their amounts of bending.

    Returns a bound on the squared half angle of any segment.
    """
    key, frame, parent, half_key = scratch.key, block.frame, scratch.parent_base, scratch.half_key
    on_parent, base, sine = scratch.base_half, scratch.base, scratch.sine_part
    half_rotation, bound, steepest = scratch.half_rotation, scratch.bound, block.steepest
    support, start, offset = scratch.support, scratch.next, block.offset
    for j in range(n):
        key_x, key_y = key[0, j], key[1, j]
        square = key_x * key_x + key_y * key_y
        carrying, half, blend = _halves(square, block.skew[j], block.tip_skew[j])
        base[4, j], base[5, j] = carrying * key_x, carrying * key_y
        half_key[0, j], half_key[1, j] = half * key_x, half * key_y
        scratch.blend[j], scratch.rotation_square[j] = blend, half * half * square
        bound[j] = half * half * square * steepest[0, j]
        # x rotates the chord about the axis e2 of the branch, y about -e1.
        rx = half * (key_x * frame[2, 0, j] - key_y * frame[1, 0, j])
        ry = half * (key_x * frame[2, 1, j] - key_y * frame[1, 1, j])
        rz = half * (key_x * frame[2, 2, j] - key_y * frame[1, 2, j])
        half_rotation[0, j], half_rotation[1, j], half_rotation[2, j] = rx, ry, rz
        cosine, sinc = scratch.cosine[j], scratch.sinc[j]
        qw, qx, qy, qz = product(
            parent[0, j], parent[1, j], parent[2, j], parent[3, j],
            cosine, sinc * on_parent[0, j], sinc * on_parent[1, j], sinc * on_parent[2, j],
        )  # fmt: skip
        base[0, j], base[1, j], base[2, j], base[3, j] = qw, qx, qy, qz
        sine[0, j], sine[1, j], sine[2, j], sine[3, j] = _times_vector(qw, qx, qy, qz, rx, ry, rz)
        start[0, j], start[1, j], start[2, j] = _along(support, j, scale * offset[0, j])
    if not block.is_at_axes:
        _go_aside(support, start, scale, offset, n)
    if block.n_rows > 2:
        _take_further(block, scratch, x, n)
    return _largest(bound, n)


@part
def _halves(square: float, skew: float, tip_skew: float) -> tuple[float, float, float]:
    """
    Find what half a key rotation is, stretched so that the chord has the angle of the key.

    ``square`` is the squared key rotation in [rad^2].

    Returns
    -------
    tuple
        Half a rotation for the branches that it carries, for its own segments, and the fraction
        of the slope of a load at the tip in the latter.

    """
    blend = min(max((square - _BLEND_FROM) * _PER_BLEND, 0.0), 1.0)
    stretched = 0.5 * min(square, _STRETCH_TO)
    carrying = 0.5 + stretched * skew
    return carrying, carrying + stretched * blend * (tip_skew - skew), blend


@part
def _times_vector(
    w: float, x: float, y: float, z: float, vx: float, vy: float, vz: float
) -> tuple[float, float, float, float]:
    """Multiply a quaternion by a vector, a quaternion without real part."""
    return (
        -x * vx - y * vy - z * vz,
        w * vx + y * vz - z * vy,
        w * vy - x * vz + z * vx,
        w * vz + x * vy - y * vx,
    )


@part
def _take_further(block: Block, scratch: Block, x: Floats, n: int) -> None:
    """Halve the coordinates after the key rotations, and raise the bounds on angles by them."""
    half_key, bound, steepest = scratch.half_key, scratch.bound, block.steepest
    for j in range(0, n, 4):
        _read_further(x, block.coordinate, half_key, j)
    for j in range(n):
        total = bound[j]
        for c in range(2, half_key.shape[0]):
            half = 0.5 * half_key[c, j]
            half_key[c, j] = half
            total += half * half * steepest[c, j]
        # The square of a sum of n is at most n times the sum of the squares.
        bound[j] = total * block.bound_factor[j]


@part
def _largest(bound: Floats, n: int) -> float:
    """Return the largest bound, or the sum of all where that is near enough to zero."""
    total, largest = 0.0, 0.0
    for j in range(n):
        total += bound[j]
    if total <= NEAR_LIMIT:
        return total
    for j in range(n):
        largest = max(largest, bound[j])
    return largest


@part
def _write_bases(block: Block, scratch: Block, bases: Floats) -> None:
    """Write the rotated bases for the children."""
    branch, base, whole = block.branch, scratch.base, block.n_parents - block.n_parents % 4
    for j in range(0, whole, 4):
        a, b, c, d = branch[j], branch[j + 1], branch[j + 2], branch[j + 3]
        put_four(base, 0, j, bases, a, b, c, d, 0)
        put_four(base, 4, j, bases, a, b, c, d, 4)
    for j in range(whole, block.n_parents):
        for row in range(6):
            bases[branch[j], row] = base[row, j]


@part
def _write_poses(block: Block, scratch: Block, rank: int, n_slots: int, out: Floats) -> None:
    """Write the poses of sixteen segments, each after the one before it on its branch."""
    pose, first = scratch.pose, block.first
    whole = n_slots - n_slots % 4
    for j in range(0, whole, 4):
        a, b, c, d = first[j] + rank, first[j + 1] + rank, first[j + 2] + rank, first[j + 3] + rank
        put_four(pose, 0, j, out, a, b, c, d, 0)
        put_four(pose, 3, j, out, a, b, c, d, 3)
    for j in range(whole, n_slots):
        for row in range(7):
            out[first[j] + rank, row] = pose[row, j]


@part
def _along(pose: Floats, j: int, length: float) -> tuple[float, float, float]:
    """Return the point at a length along the x axis of a pose."""
    x, y, z, w, twice = pose[3, j], pose[4, j], pose[5, j], pose[6, j], length + length
    return (
        pose[0, j] + length - twice * (y * y + z * z),
        pose[1, j] + twice * (x * y + w * z),
        pose[2, j] + twice * (x * z - w * y),
    )


@part
def _go_aside(pose: Floats, point: Floats, scale: float, local: Floats, n: int) -> None:
    """Add the parts across the x axes of points in frames of segments."""
    for j in range(n):
        x, y, z = rotated(
            pose[6, j], pose[3, j], pose[4, j], pose[5, j], 0.0, local[1, j], local[2, j]
        )
        point[0, j] += scale * x
        point[1, j] += scale * y
        point[2, j] += scale * z


@part
def _bend_and_join(segment: Segment, scratch: Block, scale: float, n: int) -> None:
    """Rotate and join sixteen straight segments of branches that bend a little about one axis."""
    base, sine, rest, chord = scratch.base, scratch.sine_part, segment.rest, segment.own_chord
    pose, start = scratch.pose, scratch.next
    for j in range(n):
        slope = segment.slope[j]
        c, s = half_angle_near(slope * slope * scratch.rotation_square[j])
        s *= slope
        w, x, y, z = product(
            c * base[0, j] + s * sine[0, j], c * base[1, j] + s * sine[1, j],
            c * base[2, j] + s * sine[2, j], c * base[3, j] + s * sine[3, j],
            rest[0, j], rest[1, j], rest[2, j], rest[3, j],
        )  # fmt: skip
        pose[0, j], pose[1, j], pose[2, j] = start[0, j], start[1, j], start[2, j]
        pose[3, j], pose[4, j], pose[5, j], pose[6, j] = x, y, z, w
        start[0, j], start[1, j], start[2, j] = _along(pose, j, scale * chord[0, j])


@part
def _bend(
    segment: Segment, scratch: Block, scale: float, block: Block, largest: float, n: int
) -> None:
    """Rotate sixteen segments from rest by all coordinates of their branches, and join them."""
    if block.n_rows == 2:
        _rotate_plain(segment, scratch, n)
    else:
        _rotate_by_all(segment, scratch, n)
    _half_angles(scratch, largest, n)
    base, half, rest, pose = scratch.base, scratch.half, segment.rest, scratch.pose
    start, chord = scratch.next, segment.own_chord
    for j in range(n):
        cosine, sinc = scratch.cosine[j], scratch.sinc[j]
        w, x, y, z = product(
            base[0, j], base[1, j], base[2, j], base[3, j],
            cosine, sinc * half[0, j], sinc * half[1, j], sinc * half[2, j],
        )  # fmt: skip
        w, x, y, z = product(w, x, y, z, rest[0, j], rest[1, j], rest[2, j], rest[3, j])
        pose[0, j], pose[1, j], pose[2, j] = start[0, j], start[1, j], start[2, j]
        pose[3, j], pose[4, j], pose[5, j], pose[6, j] = x, y, z, w
        start[0, j], start[1, j], start[2, j] = _along(pose, j, scale * chord[0, j])
    if not block.is_joined:
        _go_aside(pose, start, scale, chord, n)


@part
def _rotate_plain(segment: Segment, scratch: Block, n: int) -> None:
    """Find half the rotation vectors of sixteen segments of branches with key rotations alone."""
    rotation, half, blend = scratch.half_rotation, scratch.half, scratch.blend
    for j in range(n):
        slope = segment.slope[j]
        slope += blend[j] * (segment.tip_slope[j] - slope)
        hx, hy, hz = slope * rotation[0, j], slope * rotation[1, j], slope * rotation[2, j]
        half[0, j], half[1, j], half[2, j] = hx, hy, hz
        scratch.square[j] = hx * hx + hy * hy + hz * hz


@part
def _rotate_by_all(segment: Segment, scratch: Block, n: int) -> None:
    """
    Find half the rotation vectors of sixteen segments, by all coordinates of their branches.

    All rows of the record are summed: with a count known at compile time the slots are a vector.
    """
    rotation, half, blend = scratch.half_rotation, scratch.half, scratch.blend
    mode, half_key = segment.rotation_mode, scratch.half_key
    for j in range(n):
        slope = blend[j] * (segment.tip_slope[j] - segment.slope[j])
        hx, hy, hz = slope * rotation[0, j], slope * rotation[1, j], slope * rotation[2, j]
        for c in range(mode.shape[0]):
            amount = half_key[c, j]
            hx += amount * mode[c, 0, j]
            hy += amount * mode[c, 1, j]
            hz += amount * mode[c, 2, j]
        half[0, j], half[1, j], half[2, j] = hx, hy, hz
        scratch.square[j] = hx * hx + hy * hy + hz * hz
