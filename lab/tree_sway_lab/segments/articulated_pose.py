# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Nodes and poses of an articulated tree from the rotations of its joints."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway_lab.kernel import kernel
from tree_sway_lab.segments.articulated_bodies import Bodies
from tree_sway_lab.segments.rotation_kernel import (
    cross,
    dot,
    matrix_of,
    plus,
    product,
    read,
    times,
    turn_on,
    write,
)


@kernel
def place_bodies(
    bodies: Bodies, turn: Floats, rotation: Floats, joint: Floats, start: Floats, end: Floats
) -> None:
    """
    Carry the joints' rotations, quaternions wxyz (n, 4), from the root out.

    Written are the rotation of each body from rest, (n, 3, 3), and joint, start node and end node
    of each segment in [m], (n, 3).
    """
    own = np.empty((3, 3))
    for i in range(len(turn)):
        p = bodies.carrier[i]
        arm, axis = read(bodies.arm, i), read(bodies.axis, i)
        if p < 0:
            matrix_of(turn[i], rotation[i])
            place, back = arm, axis
        else:
            matrix_of(turn[i], own)
            product(rotation[p], own, rotation[i])
            place, back = (
                plus(read(joint, p), times(rotation[p], arm), 1.0),
                times(rotation[p], axis),
            )
        write(joint, i, place)
        write(start, i, plus(place, back, -bodies.reach[i, 0]))
        write(end, i, plus(place, times(rotation[i], axis), bodies.reach[i, 1]))


@kernel
def pose_block(
    bodies: Bodies,
    turn: Floats,
    rest: Floats,
    rotation: Floats,
    start: Floats,
    end: Floats,
    pieces: int,
    out: Floats,
) -> None:
    """
    Fill poses (m, 7): start node, and as ``xyzw`` the turn that lays x along the chord.

    The roll is the body's own: x turns with the segment, then takes the shortest way to the chord.
    Rotations and nodes are those of `place_bodies`; ``rest`` is the orientation of each segment at
    rest, wxyz, (m, 4).
    """
    q = np.empty((len(turn), 4))
    for i in range(len(turn)):
        p = bodies.carrier[i]
        if p < 0:
            for k in range(4):
                q[i, k] = turn[i, k]
        else:
            _multiply(q[p], turn[i], q[i])
    whole = np.empty(4)
    for k in range(len(out)):
        first = k * pieces
        body = first + pieces // 2
        chord = plus(read(end, first + pieces - 1), read(start, first), -1.0)
        along = times(rotation[body], read(bodies.axis, first))
        sine, cosine = cross(along, chord), dot(along, chord)
        size = np.sqrt(dot(sine, sine))
        angle = np.arctan2(size, cosine)
        factor = angle / size if size > 0.0 else 0.0
        # A turn in world axes is one in body axes, turned back.
        world = (factor * sine[0], factor * sine[1], factor * sine[2])
        matrix = rotation[body]
        turn_on(q[body], times(matrix.T, world), whole)
        _multiply(whole, rest[k], whole)
        out[k, 0], out[k, 1], out[k, 2] = start[first, 0], start[first, 1], start[first, 2]
        out[k, 3], out[k, 4], out[k, 5], out[k, 6] = whole[1], whole[2], whole[3], whole[0]


@kernel
def _multiply(p: Floats, q: Floats, out: Floats) -> None:
    w = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    x = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]
    y = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]
    z = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]
    out[0], out[1], out[2], out[3] = w, x, y, z
