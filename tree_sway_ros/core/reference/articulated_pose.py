"""Nodes and poses of an articulated tree from the rotations of its bodies."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tree_sway_ros.core.reference.articulated_bodies import Bodies
from tree_sway_ros.core.reference.rotation_kernel import cross, multiply, rotate

Floats = NDArray[np.float64]


@njit(cache=True)
def joint_positions(bodies: Bodies, rotation: Floats) -> Floats:
    """Joint of each segment in [m], (n, 3)."""
    out = np.empty((len(rotation), 3))
    for i in range(len(rotation)):
        p = bodies.carrier[i]
        out[i] = bodies.arm[i] if p < 0 else out[p] + rotate(rotation[p], bodies.arm[i])
    return out


@njit(cache=True)
def end_nodes(bodies: Bodies, rotation: Floats) -> Floats:
    """End node of each segment in [m], (n, 3), by the rotations (n, 3, 3) of the bodies."""
    out = joint_positions(bodies, rotation)
    for i in range(len(rotation)):
        out[i] += bodies.reach[i, 1] * rotate(rotation[i], bodies.axis[i])
    return out


@njit(cache=True)
def pose_block(
    bodies: Bodies, rotation: Floats, ends: Floats, pieces: int, out: Floats
) -> Floats:
    """
    Poses (n / pieces, 7): start node, and the turn that lays x along the chord, ``xyzw``.

    The roll is the body's own: it turns with the segment, then takes the shortest way to the chord.

    """
    joint = joint_positions(bodies, rotation)
    x_axis = np.array([1.0, 0.0, 0.0])
    rest, whole, swing = np.empty(4), np.empty(4), np.empty(4)
    for k in range(len(out)):
        first = k * pieces
        p = bodies.carrier[first]
        back = bodies.reach[first, 0] * bodies.axis[first]
        start = joint[first] - (rotate(rotation[p], back) if p >= 0 else back)
        chord = ends[first + pieces - 1] - start
        chord /= np.sqrt(chord[0] ** 2 + chord[1] ** 2 + chord[2] ** 2)
        body = rotation[first + pieces // 2]
        shortest(x_axis, bodies.axis[first], rest)
        shortest(rotate(body, bodies.axis[first]), chord, swing)
        multiply(swing, quaternion_of(body), whole)
        multiply(whole, rest, whole)
        out[k, :3] = start
        out[k, 3:6] = whole[1:]
        out[k, 6] = whole[0]
    return out


@njit(cache=True)
def shortest(a: Floats, b: Floats, out: Floats) -> None:
    """Quaternion wxyz of the shortest turn from one unit vector (3,) to another."""
    cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    if cosine < -1.0 + 1e-12:
        aside = np.array([0.0, 0.0, 1.0]) if abs(a[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
        axis, out[0] = cross(a, aside), 0.0
    else:
        axis, out[0] = cross(a, b), 1.0 + cosine
    out[1:] = axis
    out /= np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2 + out[3] ** 2)


@njit(cache=True)
def quaternion_of(R: Floats) -> Floats:
    """Quaternion wxyz of a rotation matrix (3, 3), by its largest part (Shepperd 1978)."""
    out = np.empty(4)
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    largest = 0
    for k in range(3):
        if R[k, k] > max(trace, R[0, 0], R[1, 1], R[2, 2]) - 1e-15 and R[k, k] > trace:
            largest = k + 1
    if largest == 0:
        out[0] = 1.0 + trace
        out[1], out[2], out[3] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        out[0] = R[k, j] - R[j, k]
        out[1 + i] = 1.0 + R[i, i] - R[j, j] - R[k, k]
        out[1 + j] = R[j, i] + R[i, j]
        out[1 + k] = R[k, i] + R[i, k]
    out /= np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2 + out[3] ** 2)
    return out
