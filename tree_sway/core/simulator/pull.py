# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a force at one place of a tree does to its key rotations: ``J^T f``, as the tree is bent now.

A place on a branch is moved by every branch between it and the root: by the turns of the segments
up to the one that it, or the next branch, sits on, and by how a branch turns the base of the next.
One walk down this chain is all that is needed. Symbols: v rotation vector of a segment in the
frame of its branch's base [rad], f force [N], t its moment [N m].
"""

from __future__ import annotations

import math

from tree_sway.core.arrays import Floats, Record, Records
from tree_sway.core.kernel import fused
from tree_sway.core.rotation import product, quaternion, rotated

_STRETCH_TO = (0.5 * math.pi) ** 2
_SMALL = 1e-6


@fused
def moments_of_force(
    branches: Records, segments: Records, rest: Floats, poses: Floats, x: Floats,
    branch: int, segment: int, place: Floats, force: Floats, moments: Floats,
) -> None:  # fmt: skip
    """
    Find the moments on all key rotations by a force at a place of a segment.

    Parameters
    ----------
    branches, segments
        Records of `BRANCH` and `SEGMENT`.
    rest
        Orientation of each segment at rest, w x y z, (n, 4).
    poses
        Pose block of the tree as it is bent now, (n, 7).
    x
        Its key rotations in [rad], (N,).
    branch, segment
        Where the force acts, by number.
    place
        The same in [m], a place that moves with the segment, (3,).
    force
        The force in [N], (3,).
    moments
        Written: moments in [N m], (N,).

    """
    moments[:] = 0.0
    ex, ey, ez = place[0], place[1], place[2]
    last = segment
    while branch >= 0:
        joint = branches[branch]
        first = joint['first']
        bw, bx, by, bz = _base(joint, segments, rest, poses, x)
        for s in range(first, last + 1):
            nx, ny, nz = ex, ey, ez
            if s < last:
                nx, ny, nz = poses[s + 1, 0], poses[s + 1, 1], poses[s + 1, 2]
            ax, ay, az = nx - poses[s, 0], ny - poses[s, 1], nz - poses[s, 2]
            tx, ty, tz = _moment(ax, ay, az, force)
            tx, ty, tz = rotated(bw, -bx, -by, -bz, tx, ty, tz)
            vx, vy, vz = _turn(joint, segments, s - first, x)
            tx, ty, tz = _to_vector(vx, vy, vz, tx, ty, tz)
            for c in range(joint['n_coordinates']):
                rx, ry, rz = _row(joint, segments, s - first, c)
                share = _stretch(joint, x) if c < 2 else 1.0
                moments[joint['coordinate'] + c] += share * (rx * tx + ry * ty + rz * tz)
        ex, ey, ez = poses[first, 0], poses[first, 1], poses[first, 2]
        last, branch = joint['base_segment'], joint['parent']
        if branch < 0:
            break
        parent = branches[branch]
        bw, bx, by, bz = _base(parent, segments, rest, poses, x)
        tx, ty, tz = _moment(place[0] - ex, place[1] - ey, place[2] - ez, force)
        tx, ty, tz = rotated(bw, -bx, -by, -bz, tx, ty, tz)
        vx, vy, vz = 0.0, 0.0, 0.0
        for c in range(parent['n_coordinates']):
            share = _stretch(parent, x) if c < 2 else 1.0
            u = share * x[parent['coordinate'] + c]
            vx += u * joint['twist'][c, 3]
            vy += u * joint['twist'][c, 4]
            vz += u * joint['twist'][c, 5]
        tx, ty, tz = _to_vector(vx, vy, vz, tx, ty, tz)
        for c in range(parent['n_coordinates']):
            share = _stretch(parent, x) if c < 2 else 1.0
            row = joint['twist'][c]
            moments[parent['coordinate'] + c] += share * (row[3] * tx + row[4] * ty + row[5] * tz)


@fused
def _moment(ax: float, ay: float, az: float, force: Floats) -> tuple[float, float, float]:
    fx, fy, fz = force[0], force[1], force[2]
    return ay * fz - az * fy, az * fx - ax * fz, ax * fy - ay * fx


@fused
def _stretch(joint: Record, x: Floats) -> float:
    """By how much placing stretches the first pair of a branch."""
    i = joint['coordinate']
    return 1.0 + min(x[i] * x[i] + x[i + 1] * x[i + 1], _STRETCH_TO) * joint['skew']


@fused
def _row(joint: Record, segments: Records, rank: int, c: int) -> tuple[float, float, float]:
    """Rotation vector of a segment of a branch per unit of a coordinate."""
    segment, lane = segments[joint['block'] + rank], joint['lane']
    turn = segment['turn']
    if turn.shape[0] > 1:
        return turn[c, 0, lane], turn[c, 1, lane], turn[c, 2, lane]
    slope, frame = segment['slope'][lane], joint['frame']
    if c == 0:
        return slope * frame[2, 0], slope * frame[2, 1], slope * frame[2, 2]
    return -slope * frame[1, 0], -slope * frame[1, 1], -slope * frame[1, 2]


@fused
def _turn(joint: Record, segments: Records, rank: int, x: Floats) -> tuple[float, float, float]:
    """Rotation vector of a segment of a branch in [rad]."""
    vx, vy, vz = 0.0, 0.0, 0.0
    for c in range(joint['n_coordinates']):
        u = x[joint['coordinate'] + c] * (_stretch(joint, x) if c < 2 else 1.0)
        rx, ry, rz = _row(joint, segments, rank, c)
        vx, vy, vz = vx + u * rx, vy + u * ry, vz + u * rz
    return vx, vy, vz


@fused
def _base(
    joint: Record, segments: Records, rest: Floats, poses: Floats, x: Floats
) -> tuple[float, float, float, float]:
    """How the base of a branch is turned from rest, by the pose of its first segment."""
    s = joint['first']
    vx, vy, vz = _turn(joint, segments, 0, x)
    w, i, j, k = quaternion(-vx, -vy, -vz)
    rw, ri, rj, rk = product(
        poses[s, 6], poses[s, 3], poses[s, 4], poses[s, 5],
        rest[s, 0], -rest[s, 1], -rest[s, 2], -rest[s, 3],
    )  # fmt: skip
    return product(rw, ri, rj, rk, w, i, j, k)


@fused
def _to_vector(
    vx: float, vy: float, vz: float, tx: float, ty: float, tz: float
) -> tuple[float, float, float]:
    """
    Moment about fixed axes to that by the components of a rotation vector.

    The transposed left Jacobian of the rotation group (Sola et al. 2018, eq. 145).
    """
    square = vx * vx + vy * vy + vz * vz
    half, third = 0.5, 1.0 / 6.0
    if square > _SMALL:
        angle = math.sqrt(square)
        half = (1.0 - math.cos(angle)) / square
        third = (angle - math.sin(angle)) / (square * angle)
    ax, ay, az = vy * tz - vz * ty, vz * tx - vx * tz, vx * ty - vy * tx
    bx, by, bz = vy * az - vz * ay, vz * ax - vx * az, vx * ay - vy * ax
    return (
        tx - half * ax + third * bx,
        ty - half * ay + third * by,
        tz - half * az + third * bz,
    )
