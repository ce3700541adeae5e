"""
The articulated-body algorithm for a tree of ball joints, forward and back in O(n).

Featherstone (2008), Rigid Body Dynamics Algorithms, section 7.3, in world axes and with moments taken
about each body's own joint. Wrenches and motions are stacked angular first. Compiled by numba.

"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tree_sway_ros.core.reference.articulated_bodies import Bodies
from tree_sway_ros.core.reference.rotation_kernel import cross, inverse_3, outer_add, rotate

Floats = NDArray[np.float64]


class Motion(NamedTuple):
    """
    Where the bodies are and how they move, world axes, filled by `move`.

    Parameters
    ----------
    rotation
        Rotation of each body from rest, (n, 3, 3).
    position, velocity
        Of each joint in [m] and [m/s], (n, 3).
    spin
        Angular velocity of each body in [rad/s], (n, 3).
    arm
        From the joint of the carrier to this joint in [m], (n, 3).
    bias
        Angular and linear acceleration of each joint that no joint's acceleration causes, (n, 6).

    """

    rotation: Floats
    position: Floats
    velocity: Floats
    spin: Floats
    arm: Floats
    bias: Floats


class Articulation(NamedTuple):
    """
    Room for the backward pass.

    Parameters
    ----------
    inertia, force
        Articulated inertia (n, 6, 6) and bias force (n, 6) about each joint.
    inverse
        Inverse of the joint's own block of the inertia, (n, 3, 3).
    drive
        Joint torque left over for acceleration in [N m], (n, 3).
    acceleration
        Angular and linear acceleration of each body at its joint, (n, 6).

    """

    inertia: Floats
    force: Floats
    inverse: Floats
    drive: Floats
    acceleration: Floats


def motion_of(n: int) -> Motion:
    """Make room for the motion of n bodies."""
    z = np.zeros
    return Motion(z((n, 3, 3)), z((n, 3)), z((n, 3)), z((n, 3)), z((n, 3)), z((n, 6)))


def articulation_of(n: int) -> Articulation:
    """Make room for the articulated inertias of n bodies."""
    z = np.zeros
    return Articulation(z((n, 6, 6)), z((n, 6)), z((n, 3, 3)), z((n, 3)), z((n, 6)))


@njit(cache=True)
def move(bodies: Bodies, turn: Floats, rate: Floats, motion: Motion) -> None:
    """
    Carry rotations (n, 3, 3) and rates (n, 3) of the joints, both in body axes, from the root out.

    """
    position, velocity, spin, arm = motion.position, motion.velocity, motion.spin, motion.arm
    for i in range(len(turn)):
        p = bodies.carrier[i]
        if p < 0:
            motion.rotation[i] = turn[i]
            arm[i] = bodies.arm[i]
            position[i] = arm[i]
            velocity[i] = 0.0
            spin[i] = rotate(turn[i], rate[i])
            motion.bias[i] = 0.0
            continue
        motion.rotation[i] = motion.rotation[p] @ turn[i]
        arm[i] = rotate(motion.rotation[p], bodies.arm[i])
        position[i] = position[p] + arm[i]
        swept = cross(spin[p], arm[i])
        velocity[i] = velocity[p] + swept
        own = rotate(motion.rotation[i], rate[i])
        spin[i] = spin[p] + own
        motion.bias[i, :3] = cross(spin[p], own)
        motion.bias[i, 3:] = cross(spin[p], swept)


@njit(cache=True)
def load(
    bodies: Bodies, motion: Motion, gravity: float, mass_damping: float, room: Articulation
) -> None:
    """
    Start the articulated inertia and bias force from each body's own, with its weight.

    The damping in [1/s] acts on each body's momentum.

    """
    for i in range(len(bodies.mass)):
        R = motion.rotation[i]
        m = bodies.mass[i]
        r = rotate(R, bodies.centre[i])
        own = R @ bodies.inertia[i] @ R.T
        w = motion.spin[i]
        A, b = room.inertia[i], room.force[i]
        A[:] = 0.0
        A[:3, :3] = own
        outer_add(A[:3, :3], r, r, -m)
        square = m * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
        for k in range(3):
            A[k, k] += square
            A[3 + k, 3 + k] = m
        A[0, 4], A[0, 5], A[1, 5] = -m * r[2], m * r[1], -m * r[0]
        A[1, 3], A[2, 3], A[2, 4] = m * r[2], -m * r[1], m * r[0]
        A[3:, :3] = A[:3, 3:].T

        swept = cross(w, r)
        force = m * (cross(w, swept) + mass_damping * (motion.velocity[i] + swept))
        force[2] += m * gravity
        momentum = rotate(own, w)
        b[:3] = cross(w, momentum) + cross(r, force) + mass_damping * momentum
        b[3:] = force


@njit(cache=True)
def push(i: int, place: Floats, force: Floats, room: Articulation) -> None:
    """Apply a force (3,) in [N] to body i at a place (3,) from its joint in [m]."""
    room.force[i, :3] -= cross(place, force)
    room.force[i, 3:] -= force


@njit(cache=True)
def accelerate(
    bodies: Bodies,
    motion: Motion,
    torque: Floats,
    bend_inertia: Floats,
    twist_inertia: Floats,
    room: Articulation,
    out: Floats,
) -> None:
    """
    Solve for the accelerations of the joints, body axes, (n, 3) in [rad/s^2].

    Parameters
    ----------
    bodies, motion
        The tree and how it moves now.
    torque
        Torque of the joints, body axes, (n, 3) in [N m].
    bend_inertia, twist_inertia
        Inertia added to the joints across and about the axis in [kg m^2], (n,): what makes the springs
        implicit.
    room
        From `load`, with every force pushed.
    out
        Where the accelerations go.

    """
    n = len(bodies.mass)
    for i in range(n - 1, -1, -1):
        A = room.inertia[i]
        R = motion.rotation[i]
        t = rotate(R, bodies.axis[i])
        block = A[:3, :3].copy()
        for k in range(3):
            block[k, k] += bend_inertia[i]
        outer_add(block, t, t, twist_inertia[i] - bend_inertia[i])
        inverse_3(block, room.inverse[i])
        room.drive[i] = rotate(R, torque[i]) - room.force[i, :3]
        p = bodies.carrier[i]
        if p < 0:
            continue
        U = np.ascontiguousarray(A[:, :3])
        passed = U @ room.inverse[i]
        rest = A - passed @ U.T
        force = room.force[i] + rest @ motion.bias[i] + passed @ room.drive[i]
        d = motion.arm[i]
        # Moments about the carrier's joint: n + d x f, and the motion there: a = a_p + alpha x d.
        T = np.zeros((6, 6))
        for k in range(6):
            T[k, k] = 1.0
        T[3, 1], T[3, 2], T[4, 2] = d[2], -d[1], d[0]
        T[4, 0], T[5, 0], T[5, 1] = -d[2], d[1], -d[0]
        room.inertia[p] += T.T @ rest @ T
        room.force[p] += T.T @ force

    for i in range(n):
        a = room.acceleration[i]
        a[:] = motion.bias[i]
        p = bodies.carrier[i]
        if p >= 0:
            a += room.acceleration[p]
            a[3:] += cross(room.acceleration[p, :3], motion.arm[i])
        spare = room.drive[i] - room.inertia[i, :3] @ a
        own = rotate(room.inverse[i], spare)
        a[:3] += own
        out[i] = rotate(motion.rotation[i].T, own)
