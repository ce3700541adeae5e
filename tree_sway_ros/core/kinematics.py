"""
Key rotations to poses: the segments of each branch follow its key, the branches are joined from the root.

A segment turns by its slope times the branch's rotation vector, so a branch bends as one smooth curve and keeps
its length. The chord of the bent chain turns by a little less than the coordinate says (third cumulant of the slope
along the branch); the coordinate is stretched by that much, so that the chord angle is kept. Beyond 30 degrees a
tapered branch goes over to the slope of a load at the tip.

Three passes: every branch, for how its base is turned; every segment, sixteen at a time, for its own orientation and
the way to the next one; every branch again, for where its segments then stand.

The pose block is (n, 7) float64 in message order: x y z, then the quaternion as x y z w. A pose stands at its segment's
root-side node, its x axis runs along the segment (REP-103).

"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway_ros.core.branch_shapes import N_SHAPES
from tree_sway_ros.core.kernel import fused, inlined
from tree_sway_ros.core.layout import LANES
from tree_sway_ros.core.rotation import (
    SERIES_LIMIT,
    half_angle,
    half_angle_series,
    product,
    quaternion,
    rotated,
)
from tree_sway_ros.core.tree import Floats

_BLEND_FROM = np.deg2rad(30.0) ** 2
_BLEND_TO = np.deg2rad(45.0) ** 2
_STRETCH_TO = np.deg2rad(90.0) ** 2


@fused
def place(branches: Any, segments: Any, work: Any, x: Floats, origin: Floats, out: Floats) -> None:
    """
    Place every segment.

    Parameters
    ----------
    branches, segments, work
        Records of `BRANCH` (b,), `SEGMENT` and `WORK` (b,); poses of the second and bases of the third are written.
    x
        Key rotations, (N,), in the order of the coordinates.
    origin
        Root node, (3,).
    out
        Pose block to write, (n, 7).

    """
    for b in range(len(branches)):
        branch, base = branches[b], work[b].base
        if branch.parent < 0:
            base[0], base[1], base[2], base[3] = 1.0, 0.0, 0.0, 0.0
        else:
            parent = branches[branch.parent]
            below = work[branch.parent].base
            qw, qx, qy, qz = seat_turn(parent, branch.seat_slope, x)
            base[0], base[1], base[2], base[3] = product(
                below[0], below[1], below[2], below[3], qw, qx, qy, qz
            )
        work[b].half_angle = _set_ways(branch, segments[branch.block], base, x)
    for k in range(len(segments)):
        if segments[k].in_plane:
            _bend_in_plane(segments[k], segments[segments[k].head])
        else:
            _bend(segments[k], segments[segments[k].head])
    for b in range(len(branches)):
        branch = branches[b]
        px, py, pz = origin[0], origin[1], origin[2]
        s = branch.seat
        if s >= 0:
            offset = branch.offset
            ox, oy, oz = rotated(
                out[s, 6], out[s, 3], out[s, 4], out[s, 5], offset[0], offset[1], offset[2]
            )
            px, py, pz = out[s, 0] + ox, out[s, 1] + oy, out[s, 2] + oz
        if not work[b].half_angle <= SERIES_LIMIT:
            _bend_far(branch, segments)
        _stand(branch, segments, px, py, pz, out)


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
    i, pairs, frame = parent.coordinate, parent.n_pairs, parent.frame
    stretch = 1.0 + min(x[i] * x[i] + x[i + 1] * x[i + 1], _STRETCH_TO) * parent.skew
    ux, uy, spin = slope[0] * stretch * x[i], slope[0] * stretch * x[i + 1], 0.0
    for p in range(1, pairs):
        ux += slope[p] * x[i + 2 * p]
        uy += slope[p] * x[i + 2 * p + 1]
    for p in range(parent.n_coordinates - 2 * pairs):
        spin += slope[N_SHAPES + p] * x[i + 2 * pairs + p]
    return quaternion(
        ux * frame[2, 0] - uy * frame[1, 0] + spin * frame[0, 0],
        ux * frame[2, 1] - uy * frame[1, 1] + spin * frame[0, 1],
        ux * frame[2, 2] - uy * frame[1, 2] + spin * frame[0, 2],
    )


@fused
def _set_ways(branch: Any, head: Any, base: Floats, x: Floats) -> float:
    """Set what the segments of a branch share; return a bound on the square of half their rotation [rad^2]."""
    i, pairs, lane, frame = branch.coordinate, branch.n_pairs, branch.lane, branch.frame
    t = x[i] * x[i] + x[i + 1] * x[i + 1]
    blend, skew = 0.0, branch.skew
    if t > _BLEND_FROM:
        blend = min((t - _BLEND_FROM) / (_BLEND_TO - _BLEND_FROM), 1.0)
        skew += blend * (branch.tip_skew - skew)
    stretch = 1.0 + min(t, _STRETCH_TO) * skew
    head.blend[lane] = blend
    for k in range(4):
        head.base[k, lane] = base[k]
    half = 0.5 * stretch
    for k in range(3):
        head.way[0, k, lane] = half * (x[i] * frame[2, k] - x[i + 1] * frame[1, k])
    # The square of a sum is at most twice the square of its first and twice that of the others.
    square = half * half * t * branch.steepest[0]
    if branch.n_coordinates == 2:
        return float(square)
    further = 0.0
    for p in range(1, pairs):
        ux, uy = 0.5 * x[i + 2 * p], 0.5 * x[i + 2 * p + 1]
        for k in range(3):
            head.way[p, k, lane] = ux * frame[2, k] - uy * frame[1, k]
        further += (ux * ux + uy * uy) * branch.steepest[p]
    for p in range(branch.n_coordinates - 2 * pairs):
        spin = 0.5 * x[i + 2 * pairs + p]
        for k in range(3):
            head.way[N_SHAPES + p, k, lane] = spin * frame[0, k]
        further += spin * spin * branch.steepest[N_SHAPES + p]
    return float(2.0 * (square + 5.0 * further))


@inlined
def _half_vector(segment: Any, head: Any, j: int) -> tuple[float, float, float]:
    """Half the rotation vector of a segment of the lane j, of all its shapes and twists."""
    slope, way = segment.slope, head.way
    first = slope[0, j] + head.blend[j] * (segment.tip_slope[j] - slope[0, j])
    hx, hy, hz = first * way[0, 0, j], first * way[0, 1, j], first * way[0, 2, j]
    for c in range(1, slope.shape[0]):
        hx += slope[c, j] * way[c, 0, j]
        hy += slope[c, j] * way[c, 1, j]
        hz += slope[c, j] * way[c, 2, j]
    return hx, hy, hz


@inlined
def _turn(segment: Any, head: Any, j: int, c: float, hx: float, hy: float, hz: float) -> None:
    """Turn the segment of the lane j from rest by a quaternion, then as its base is turned."""
    base, rest, chord, pose, ahead = head.base, segment.rest, segment.chord, segment.pose, segment.ahead
    qw, qx, qy, qz = product(base[0, j], base[1, j], base[2, j], base[3, j], c, hx, hy, hz)
    pose[0, j], pose[1, j], pose[2, j], pose[3, j] = product(
        qw, qx, qy, qz, rest[0, j], rest[1, j], rest[2, j], rest[3, j]
    )
    ahead[0, j], ahead[1, j], ahead[2, j] = rotated(
        qw, qx, qy, qz, chord[0, j], chord[1, j], chord[2, j]
    )


@fused
def _bend_in_plane(segment: Any, head: Any) -> None:
    """Turn sixteen segments, each of a branch that bends about one axis."""
    slope, way = segment.slope, head.way
    for j in range(LANES):
        first = slope[0, j] + head.blend[j] * (segment.tip_slope[j] - slope[0, j])
        hx, hy, hz = first * way[0, 0, j], first * way[0, 1, j], first * way[0, 2, j]
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        _turn(segment, head, j, c, s * hx, s * hy, s * hz)


@fused
def _bend(segment: Any, head: Any) -> None:
    """Turn sixteen segments of branches with further shapes or twists."""
    for j in range(LANES):
        hx, hy, hz = _half_vector(segment, head, j)
        c, s = half_angle_series(hx * hx + hy * hy + hz * hz)
        _turn(segment, head, j, c, s * hx, s * hy, s * hz)


@fused
def _bend_far(branch: Any, segments: Any) -> None:
    """Turn all segments of a branch that bends beyond the series."""
    head, j = segments[branch.block], branch.lane
    for k in range(branch.block, branch.block + branch.end - branch.first):
        segment = segments[k]
        hx, hy, hz = _half_vector(segment, head, j)
        c, s = half_angle(hx * hx + hy * hy + hz * hz)
        _turn(segment, head, j, c, s * hx, s * hy, s * hz)


@fused
def _stand(branch: Any, segments: Any, px: float, py: float, pz: float, out: Floats) -> None:
    """Write the poses of a branch that starts at a place."""
    k, j = branch.block, branch.lane
    for row in range(branch.first, branch.end):
        pose, ahead = segments[k].pose, segments[k].ahead
        out[row, 0], out[row, 1], out[row, 2] = px, py, pz
        out[row, 3], out[row, 4], out[row, 5], out[row, 6] = pose[1, j], pose[2, j], pose[3, j], pose[0, j]
        px, py, pz = px + ahead[0, j], py + ahead[1, j], pz + ahead[2, j]
        k += 1
