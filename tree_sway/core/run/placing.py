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
def expand(instances: Instances, shapes: Singles, rotations: Floats) -> None:
    """Write key rotations (N,) of the first instance, by the shapes of `shapes_together`."""
    _expand(instances, shapes, rotations)


@part
def _expand(instances: Instances, shapes: Singles, rotations: Floats) -> None:
    instance = instances[0]
    shown = instance.shown
    for mode in range(len(instance.eta)):
        shown[mode] = instance.eta[mode] - instance.hidden[mode]
    n_shown = shapes.shape[1] - instance.left_out
    for block in range(len(shapes)):
        add_shapes(shapes, block, shown[:n_shown], rotations)


def room_for(n_coordinates: int) -> Floats:
    """Return zeros for `place` to write key rotations to, and some more that kernels read."""
    return np.zeros(n_coordinates + MAX_COORDINATES)


@fused
def place(
    instances: Instances,
    shapes: Singles,
    segments: Segments,
    blocks: Blocks,
    bases: Floats,
    cosine: float,
    sine: float,
    scale: float,
    rotations: Floats,
    given: Floats,
    origin: Floats,
    out: Floats,
) -> None:
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
    rotations
        Key rotations in the order of the coordinates, (N,), in an array of `room_for`, written.
    given
        Key rotations, (N,), or `NONE` where they are computed.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    if len(shapes) > 0:
        _expand(instances, shapes, rotations)
    else:
        for i in range(len(given)):
            rotations[i] = given[i]
    last = len(blocks) - 1
    scratch = blocks[last]
    for number in range(last):
        block = blocks[number]
        # With a known largest number of slots the compiler makes short loops.
        count = 8 * min(block.n_eights, WIDTH // 8)
        _read_keys(block, scratch, rotations, count)
        if block.parent[0] < 0:
            _stand_on_ground(scratch, origin, cosine, sine, count)
        else:
            _read_parents(block, scratch, bases, rotations, out)
        is_near = _rotate_on_parents(block, scratch, count)
        largest = _rotate_bases(block, scratch, scale, rotations, count)
        _write_bases(block, scratch, bases)
        is_near = is_near and largest <= NEAR_LIMIT
        is_short = is_near and block.n_rows == 2 and block.is_joined == 1
        for rank in range(block.n_records):
            segment = segments[block.first_record + rank]
            if is_short:
                _bend_and_join(segment, scratch, scale, count)
            else:
                _bend(segment, scratch, scale, block, largest, count)
            _write_poses(block, scratch, rank, segment.n_slots, out)


@part
def _read_keys(block: Block, scratch: Block, rotations: Floats, count: int) -> None:
    """Read the key rotations of sixteen branches; empty slots have those of the stem."""
    key = scratch.key
    for slot in range(count):
        first = np.uintp(block.coordinate[slot])
        key[0, slot] = rotations[first]
        key[1, slot] = rotations[first + np.uintp(1)]


@part
def _stand_on_ground(
    scratch: Block, origin: Floats, cosine: float, sine: float, count: int
) -> None:
    """Put the ground, at the root node and rotated about the vertical, in place of a parent."""
    base = scratch.parent_base
    support = scratch.support
    for slot in range(count):
        for row in range(7):
            base[row, slot] = 0.0
        base[0, slot] = cosine
        base[3, slot] = sine
        support[0, slot] = origin[0]
        support[1, slot] = origin[1]
        support[2, slot] = origin[2]
        support[3, slot] = 0.0
        support[4, slot] = 0.0
        support[5, slot] = sine
        support[6, slot] = cosine


@part
def _read_parents(
    block: Block, scratch: Block, bases: Floats, rotations: Floats, out: Floats
) -> None:
    """Read the bases and base segments of the parents of sixteen branches."""
    base = scratch.parent_base
    support = scratch.support
    for slot in range(0, block.n_slots, 4):  # values of empty slots are unused
        _take(out, block.base_segment, 0, support, 0, slot)
        _take(out, block.base_segment, 3, support, 3, slot)
        _take(bases, block.parent, 0, base, 0, slot)
        _take(bases, block.parent, 4, base, 4, slot)
        if block.n_parent_rows > 2:
            _read_further(rotations, block.parent_coordinate, scratch.parent_key, slot)


@part
def _take(array: Floats, rows: Ints, first: int, slots: Floats, row: int, slot: int) -> None:
    """Read four numbers from an element on, of the rows of an array for four slots."""
    take_four(
        array, rows[slot], rows[slot + 1], rows[slot + 2], rows[slot + 3], first, slots, row, slot
    )


@part
def _put(
    slots: Floats, row: int, slot: int, array: Floats, rows: Ints, ahead: int, first: int
) -> None:
    """Write four numbers of four slots to rows of an array, from an element on."""
    put_four(
        slots, row, slot, array, rows[slot] + ahead, rows[slot + 1] + ahead,
        rows[slot + 2] + ahead, rows[slot + 3] + ahead, first,
    )  # fmt: skip


@part
def _read_further(rotations: Floats, first: Ints, keys: Floats, slot: int) -> None:
    """Read further coordinates of four slots, or values after the last one of a branch."""
    n_rows = keys.shape[0]
    for from_row in range(2, n_rows, 4):
        row = min(from_row, n_rows - 4)
        _take(rotations, first, row, keys, row, slot)


@part
def _rotate_on_parents(block: Block, scratch: Block, count: int) -> bool:
    """
    Find half the rotation vectors of sixteen bases from the bases of their parents.

    Returns whether all these, and the key rotations, are within the range of the short series.
    """
    mode = block.base_rotation
    parent_key = scratch.parent_key
    key = scratch.key
    base = scratch.parent_base
    half = scratch.base_half
    has_further = block.n_parent_rows > 2
    n_beyond = 0
    for slot in range(count):
        half_x = base[4, slot]
        half_y = base[5, slot]
        x = half_x * mode[0, 0, slot] + half_y * mode[1, 0, slot]
        y = half_x * mode[0, 1, slot] + half_y * mode[1, 1, slot]
        z = half_x * mode[0, 2, slot] + half_y * mode[1, 2, slot]
        if has_further:
            for row in range(2, mode.shape[0]):
                amount = 0.5 * parent_key[row, slot]
                x += amount * mode[row, 0, slot]
                y += amount * mode[row, 1, slot]
                z += amount * mode[row, 2, slot]
        square = x * x + y * y + z * z
        half[0, slot] = x
        half[1, slot] = y
        half[2, slot] = z
        scratch.square[slot] = square
        scratch.cosine[slot], scratch.sinc[slot] = half_angle_near(square)
        key_square = key[0, slot] * key[0, slot] + key[1, slot] * key[1, slot]
        n_beyond += 1 if square > NEAR_LIMIT or key_square > _BLEND_FROM else 0
    if n_beyond > 0:
        _half_angles(scratch, np.inf, count)
    return n_beyond == 0


@part
def _half_angles(scratch: Block, largest: float, count: int) -> None:
    """Find cosine and sinc of sixteen half angles from squares up to the largest."""
    square = scratch.square
    cosine = scratch.cosine
    sinc = scratch.sinc
    if largest <= NEAR_LIMIT:
        for slot in range(count):
            cosine[slot], sinc[slot] = half_angle_near(square[slot])
    elif largest <= SERIES_LIMIT:
        for slot in range(count):
            cosine[slot], sinc[slot] = half_angle_series(square[slot])
    else:
        for slot in range(count):
            cosine[slot], sinc[slot] = half_angle(square[slot])


@part
def _rotate_bases(
    block: Block, scratch: Block, scale: float, rotations: Floats, count: int
) -> float:
    """
    Rotate and place the bases of sixteen branches, and set their amounts of bending.

    Returns a bound on the squared half angle of any segment.
    """
    key = scratch.key
    half_key = scratch.half_key
    frame = block.frame
    parent = scratch.parent_base
    on_parent = scratch.base_half
    base = scratch.base
    half_rotation = scratch.half_rotation
    times_half = scratch.sine_part
    start = scratch.next
    offset = block.offset
    for slot in range(count):
        key_x = key[0, slot]
        key_y = key[1, slot]
        square = key_x * key_x + key_y * key_y
        carrying, half, blend = _halves(square, block.skew[slot], block.tip_skew[slot])
        base[4, slot] = carrying * key_x
        base[5, slot] = carrying * key_y
        half_key[0, slot] = half * key_x
        half_key[1, slot] = half * key_y
        scratch.blend[slot] = blend
        scratch.rotation_square[slot] = half * half * square
        scratch.bound[slot] = half * half * square * block.steepest[0, slot]
        # x rotates the chord about the axis e2 of the branch, y about -e1.
        half_x = half * (key_x * frame[2, 0, slot] - key_y * frame[1, 0, slot])
        half_y = half * (key_x * frame[2, 1, slot] - key_y * frame[1, 1, slot])
        half_z = half * (key_x * frame[2, 2, slot] - key_y * frame[1, 2, slot])
        half_rotation[0, slot] = half_x
        half_rotation[1, slot] = half_y
        half_rotation[2, slot] = half_z
        sinc = scratch.sinc[slot]
        w, x, y, z = product(
            parent[0, slot], parent[1, slot], parent[2, slot], parent[3, slot],
            scratch.cosine[slot],
            sinc * on_parent[0, slot], sinc * on_parent[1, slot], sinc * on_parent[2, slot],
        )  # fmt: skip
        base[0, slot] = w
        base[1, slot] = x
        base[2, slot] = y
        base[3, slot] = z
        w, x, y, z = _times_vector(w, x, y, z, half_x, half_y, half_z)
        times_half[0, slot] = w
        times_half[1, slot] = x
        times_half[2, slot] = y
        times_half[3, slot] = z
        x, y, z = _along(scratch.support, slot, scale * offset[0, slot])
        start[0, slot] = x
        start[1, slot] = y
        start[2, slot] = z
    if not block.is_at_axes:
        _go_aside(scratch.support, start, scale, offset, count)
    if block.n_rows > 2:
        _take_further(block, scratch, rotations, count)
    return _largest(scratch.bound, count)


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
    w: float, x: float, y: float, z: float, along_x: float, along_y: float, along_z: float
) -> tuple[float, float, float, float]:
    """Multiply a quaternion by a vector, a quaternion without real part."""
    return (
        -x * along_x - y * along_y - z * along_z,
        w * along_x + y * along_z - z * along_y,
        w * along_y - x * along_z + z * along_x,
        w * along_z + x * along_y - y * along_x,
    )


@part
def _take_further(block: Block, scratch: Block, rotations: Floats, count: int) -> None:
    """Halve the coordinates after the key rotations, and raise the bounds on angles by them."""
    half_key = scratch.half_key
    bound = scratch.bound
    steepest = block.steepest
    for slot in range(0, count, 4):
        _read_further(rotations, block.coordinate, half_key, slot)
    for slot in range(count):
        total = bound[slot]
        for row in range(2, half_key.shape[0]):
            half = 0.5 * half_key[row, slot]
            half_key[row, slot] = half
            total += half * half * steepest[row, slot]
        # The square of a sum of n is at most n times the sum of the squares.
        bound[slot] = total * block.bound_factor[slot]


@part
def _largest(bound: Floats, count: int) -> float:
    """Return the largest bound, or the sum of all where that is near enough to zero."""
    total = 0.0
    largest = 0.0
    for slot in range(count):
        total += bound[slot]
    if total <= NEAR_LIMIT:
        return total
    for slot in range(count):
        largest = max(largest, bound[slot])
    return largest


@part
def _write_bases(block: Block, scratch: Block, bases: Floats) -> None:
    """Write the rotated bases for the children."""
    branch = block.branch
    base = scratch.base
    in_fours = block.n_parents - block.n_parents % 4
    for slot in range(0, in_fours, 4):
        _put(base, 0, slot, bases, branch, 0, 0)
        _put(base, 4, slot, bases, branch, 0, 4)
    for slot in range(in_fours, block.n_parents):
        for row in range(6):
            bases[branch[slot], row] = base[row, slot]


@part
def _write_poses(block: Block, scratch: Block, rank: int, n_slots: int, out: Floats) -> None:
    """Write the poses of sixteen segments, each after the one before it on its branch."""
    pose = scratch.pose
    first = block.first
    in_fours = n_slots - n_slots % 4
    for slot in range(0, in_fours, 4):
        _put(pose, 0, slot, out, first, rank, 0)
        _put(pose, 3, slot, out, first, rank, 3)
    for slot in range(in_fours, n_slots):
        for row in range(7):
            out[first[slot] + rank, row] = pose[row, slot]


@part
def _along(pose: Floats, slot: int, length: float) -> tuple[float, float, float]:
    """Return the point at a length along the x axis of a pose."""
    x = pose[3, slot]
    y = pose[4, slot]
    z = pose[5, slot]
    w = pose[6, slot]
    twice = length + length
    return (
        pose[0, slot] + length - twice * (y * y + z * z),
        pose[1, slot] + twice * (x * y + w * z),
        pose[2, slot] + twice * (x * z - w * y),
    )


@part
def _go_aside(pose: Floats, point: Floats, scale: float, local: Floats, count: int) -> None:
    """Add the parts across the x axes of points in frames of segments."""
    for slot in range(count):
        x, y, z = rotated(
            pose[6, slot], pose[3, slot], pose[4, slot], pose[5, slot],
            0.0, local[1, slot], local[2, slot],
        )  # fmt: skip
        point[0, slot] += scale * x
        point[1, slot] += scale * y
        point[2, slot] += scale * z


@part
def _bend_and_join(segment: Segment, scratch: Block, scale: float, count: int) -> None:
    """Rotate and join sixteen straight segments of branches that bend a little about one axis."""
    base = scratch.base
    times_half = scratch.sine_part
    for slot in range(count):
        slope = segment.slope[slot]
        cosine, sinc = half_angle_near(slope * slope * scratch.rotation_square[slot])
        sine = slope * sinc
        w = cosine * base[0, slot] + sine * times_half[0, slot]
        x = cosine * base[1, slot] + sine * times_half[1, slot]
        y = cosine * base[2, slot] + sine * times_half[2, slot]
        z = cosine * base[3, slot] + sine * times_half[3, slot]
        _join(segment, scratch, scale, slot, w, x, y, z)


@part
def _bend(
    segment: Segment, scratch: Block, scale: float, block: Block, largest: float, count: int
) -> None:
    """Rotate sixteen segments from rest by all coordinates of their branches, and join them."""
    if block.n_rows == 2:
        _rotate_plain(segment, scratch, count)
    else:
        _rotate_by_all(segment, scratch, count)
    _half_angles(scratch, largest, count)
    base = scratch.base
    half = scratch.half
    for slot in range(count):
        sinc = scratch.sinc[slot]
        w, x, y, z = product(
            base[0, slot], base[1, slot], base[2, slot], base[3, slot],
            scratch.cosine[slot], sinc * half[0, slot], sinc * half[1, slot], sinc * half[2, slot],
        )  # fmt: skip
        _join(segment, scratch, scale, slot, w, x, y, z)
    if not block.is_joined:
        _go_aside(scratch.pose, scratch.next, scale, segment.own_chord, count)


@part
def _join(
    segment: Segment, scratch: Block, scale: float, slot: int,
    w: float, x: float, y: float, z: float,
) -> None:  # fmt: skip
    """Rotate a segment from rest, begin it where the one before ended, and find its end."""
    rest = segment.rest
    pose = scratch.pose
    start = scratch.next
    w, x, y, z = product(w, x, y, z, rest[0, slot], rest[1, slot], rest[2, slot], rest[3, slot])
    pose[0, slot], pose[1, slot], pose[2, slot] = start[0, slot], start[1, slot], start[2, slot]
    pose[3, slot] = x
    pose[4, slot] = y
    pose[5, slot] = z
    pose[6, slot] = w
    x, y, z = _along(pose, slot, scale * segment.own_chord[0, slot])
    start[0, slot] = x
    start[1, slot] = y
    start[2, slot] = z


@part
def _rotate_plain(segment: Segment, scratch: Block, count: int) -> None:
    """Find half the rotation vectors of sixteen segments of branches with key rotations alone."""
    rotation = scratch.half_rotation
    blend = scratch.blend
    for slot in range(count):
        slope = segment.slope[slot]
        slope += blend[slot] * (segment.tip_slope[slot] - slope)
        x = slope * rotation[0, slot]
        y = slope * rotation[1, slot]
        z = slope * rotation[2, slot]
        _rotate_by(scratch, slot, x, y, z)


@part
def _rotate_by_all(segment: Segment, scratch: Block, count: int) -> None:
    """
    Find half the rotation vectors of sixteen segments, by all coordinates of their branches.

    All rows of the record are summed: with a count known at compile time the slots are a vector.
    """
    rotation = scratch.half_rotation
    blend = scratch.blend
    turn = segment.segment_turn
    half_key = scratch.half_key
    for slot in range(count):
        slope = blend[slot] * (segment.tip_slope[slot] - segment.slope[slot])
        x = slope * rotation[0, slot]
        y = slope * rotation[1, slot]
        z = slope * rotation[2, slot]
        for row in range(turn.shape[0]):
            amount = half_key[row, slot]
            x += amount * turn[row, 0, slot]
            y += amount * turn[row, 1, slot]
            z += amount * turn[row, 2, slot]
        _rotate_by(scratch, slot, x, y, z)


@part
def _rotate_by(scratch: Block, slot: int, x: float, y: float, z: float) -> None:
    """Write half the rotation vector of a segment, and its square."""
    half = scratch.half
    half[0, slot] = x
    half[1, slot] = y
    half[2, slot] = z
    scratch.square[slot] = x * x + y * y + z * z
