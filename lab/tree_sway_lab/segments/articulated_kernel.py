# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The articulated-body algorithm for a tree of ball joints, forward and back in O(n).

Featherstone (2008), Rigid Body Dynamics Algorithms, section 7.3, in world axes and with moments
taken about each body's own joint. The articulated inertia of a body is three blocks (3, 3): with n
and f the moment and force that its joint passes, alpha and a the accelerations there,

    n = A alpha + B a + n0,   f = B^T alpha + C a + f0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway_lab.kernel import kernel
from tree_sway_lab.segments.articulated_bodies import Bodies
from tree_sway_lab.segments.rotation_kernel import (
    cross,
    cross_columns,
    dot,
    inverse,
    plus,
    product,
    read,
    times,
    times_transposed,
    Vector,
    write,
)


class Motion(NamedTuple):
    """
    Where the bodies are and how they move, world axes, filled by `move`.

    Parameters
    ----------
    rotation
        Rotation of each body from rest, (n, 3, 3).
    velocity, spin
        Of each joint in [m/s], and of each body in [rad/s], (n, 3).
    arm
        From the joint of the carrier to this joint in [m], (n, 3).
    bias_turn, bias_shift
        Angular and linear acceleration of each joint that no joint's acceleration causes, (n, 3).

    """

    rotation: Floats
    velocity: Floats
    spin: Floats
    arm: Floats
    bias_turn: Floats
    bias_shift: Floats


class Articulation(NamedTuple):
    """
    Scratch for the backward pass.

    Parameters
    ----------
    A, B, C
        Articulated inertia of each body about its joint, (n, 3, 3).
    moment, force
        n0 and f0 of each body, (n, 3).
    inverse
        Inverse of A with what is added for the joint, (n, 3, 3).
    drive
        Torque left over for the joint's acceleration in [N m], (n, 3).
    alpha, a
        Acceleration of each body at its joint, (n, 3).

    """

    A: Floats
    B: Floats
    C: Floats
    moment: Floats
    force: Floats
    inverse: Floats
    drive: Floats
    alpha: Floats
    a: Floats


def motion_of(n: int) -> Motion:
    """Make room for the motion of n bodies."""
    return Motion(np.zeros((n, 3, 3)), *np.zeros((5, n, 3)))


def articulation_of(n: int) -> Articulation:
    """Make room for the articulated inertias of n bodies."""
    A, B, C, inverse_A = np.zeros((4, n, 3, 3))
    moment, force, drive, alpha, a = np.zeros((5, n, 3))
    return Articulation(A, B, C, moment, force, inverse_A, drive, alpha, a)


@kernel
def move(bodies: Bodies, turn: Floats, rate: Floats, motion: Motion) -> None:
    """Carry rotations (n, 3, 3) and rates (n, 3) of the joints in body axes from the root out."""
    rotation = motion.rotation
    for i in range(len(turn)):
        p = bodies.carrier[i]
        arm = read(bodies.arm, i)
        if p < 0:
            for j in range(3):
                for k in range(3):
                    rotation[i, j, k] = turn[i, j, k]
            write(motion.arm, i, arm)
            write(motion.spin, i, times(turn[i], read(rate, i)))
            continue
        product(rotation[p], turn[i], rotation[i])
        arm = times(rotation[p], arm)
        spin = read(motion.spin, p)
        swept = cross(spin, arm)
        own = times(rotation[i], read(rate, i))
        write(motion.arm, i, arm)
        write(motion.velocity, i, plus(read(motion.velocity, p), swept, 1.0))
        write(motion.spin, i, plus(spin, own, 1.0))
        write(motion.bias_turn, i, cross(spin, own))
        write(motion.bias_shift, i, cross(spin, swept))


@kernel
def load(
    bodies: Bodies, motion: Motion, gravity: float, mass_damping: float, scratch: Articulation
) -> None:
    """
    Start each articulated inertia and bias from the body's own, with its weight.

    The damping in [1/s] acts on each body's momentum.
    """
    half, own = np.empty((3, 3)), np.empty((3, 3))
    for i in range(len(bodies.mass)):
        R, A, B, C = motion.rotation[i], scratch.A[i], scratch.B[i], scratch.C[i]
        m, r, w = bodies.mass[i], times(R, read(bodies.centre, i)), read(motion.spin, i)
        product(R, bodies.inertia[i], half)
        square = dot(r, r)
        for j in range(3):
            for k in range(3):
                own[j, k] = half[j, 0] * R[k, 0] + half[j, 1] * R[k, 1] + half[j, 2] * R[k, 2]
                A[j, k] = own[j, k] - m * r[j] * r[k]
                C[j, k] = 0.0
            A[j, j] += m * square
            B[j, j], C[j, j] = 0.0, m
        B[0, 1], B[0, 2], B[1, 2] = -m * r[2], m * r[1], -m * r[0]
        B[1, 0], B[2, 0], B[2, 1] = m * r[2], -m * r[1], m * r[0]

        swept = cross(w, r)
        velocity = plus(read(motion.velocity, i), swept, 1.0)
        rising = plus(cross(w, swept), velocity, mass_damping)
        force = (m * rising[0], m * rising[1], m * (rising[2] + gravity))
        momentum = times(own, w)
        moment = plus(plus(cross(w, momentum), cross(r, force), 1.0), momentum, mass_damping)
        write(scratch.moment, i, moment)
        write(scratch.force, i, force)


@kernel
def push(i: int, place: Vector, force: Vector, share: float, scratch: Articulation) -> None:
    """Apply a share of a force in [N] to body i, at a place from its joint in [m]."""
    write(scratch.moment, i, plus(read(scratch.moment, i), cross(place, force), -share))
    write(scratch.force, i, plus(read(scratch.force, i), force, -share))


@kernel
def accelerate(
    bodies: Bodies,
    motion: Motion,
    torque: Floats,
    twist_axis: Floats,
    implicit: float,
    scratch: Articulation,
    out: Floats,
) -> None:
    """
    Solve for the accelerations of the joints, body axes, (n, 3) in [rad/s^2].

    Parameters
    ----------
    bodies, motion
        The tree, and its motion from `move`.
    torque
        Torque of the joints, body axes, (n, 3) in [N m].
    twist_axis
        Gradient of their angles of twist, body axes, (n, 3).
    implicit
        Inertia added to the joints by their stiffness in [s^2]: it makes the springs implicit.
    scratch, out
        From `load`, with every force pushed; the accelerations.

    """
    n = len(bodies.mass)
    block, passed, shared, turned, spread = np.empty((5, 3, 3))
    for i in range(n - 1, -1, -1):
        R, A, B, C = motion.rotation[i], scratch.A[i], scratch.B[i], scratch.C[i]
        t = times(R, read(twist_axis, i))
        across = implicit * bodies.bend[i]
        about = implicit * bodies.twist[i] - across
        for j in range(3):
            for k in range(3):
                block[j, k] = A[j, k] + about * t[j] * t[k]
            block[j, j] += across
        inverse(block, scratch.inverse[i])
        moment, force = read(scratch.moment, i), read(scratch.force, i)
        drive = plus(times(R, read(torque, i)), moment, -1.0)
        write(scratch.drive, i, drive)
        p = bodies.carrier[i]
        if p < 0:
            continue
        # What is left of the inertia when the joint gives way: A - A D A, B - A D B, C - B^T D B.
        turn, shift = read(motion.bias_turn, i), read(motion.bias_shift, i)
        given = plus(drive, times(A, turn), -1.0)
        given = times(scratch.inverse[i], plus(given, times(B, shift), -1.0))
        turn = plus(turn, given, 1.0)
        moment = plus(plus(moment, times(A, turn), 1.0), times(B, shift), 1.0)
        force = plus(plus(force, times_transposed(B, turn), 1.0), times(C, shift), 1.0)
        d = read(motion.arm, i)
        write(
            scratch.moment,
            p,
            plus(plus(read(scratch.moment, p), moment, 1.0), cross(d, force), 1.0),
        )
        write(scratch.force, p, plus(read(scratch.force, p), force, 1.0))
        product(A, scratch.inverse[i], passed)
        product(passed, B, shared)
        product(scratch.inverse[i], B, turned)
        product(passed, A, block)
        left_A, left_B, left_C = block, shared, spread
        for j in range(3):
            for k in range(3):
                left_A[j, k] = A[j, k] - block[j, k]
                left_B[j, k] = B[j, k] - shared[j, k]
                gone = B[0, j] * turned[0, k] + B[1, j] * turned[1, k] + B[2, j] * turned[2, k]
                left_C[j, k] = C[j, k] - gone
        _shift(d, left_A, left_B, left_C, passed, turned, scratch.A[p], scratch.B[p], scratch.C[p])

    for i in range(n):
        turn, shift = read(motion.bias_turn, i), read(motion.bias_shift, i)
        p = bodies.carrier[i]
        if p >= 0:
            alpha = read(scratch.alpha, p)
            turn = plus(turn, alpha, 1.0)
            shift = plus(
                plus(shift, read(scratch.a, p), 1.0), cross(alpha, read(motion.arm, i)), 1.0
            )
        spare = plus(read(scratch.drive, i), times(scratch.A[i], turn), -1.0)
        own = times(scratch.inverse[i], plus(spare, times(scratch.B[i], shift), -1.0))
        write(scratch.alpha, i, plus(turn, own, 1.0))
        write(scratch.a, i, shift)
        write(out, i, times_transposed(motion.rotation[i], own))


@kernel
def _shift(
    d: Vector, A: Floats, B: Floats, C: Floats, first: Floats, second: Floats,
    to_A: Floats, to_B: Floats, to_C: Floats,
) -> None:  # fmt: skip
    """Add an inertia to one whose point is d back: B + d x C; A + d x B^T - (B + d x C) d x."""
    cross_columns(d, C, first)
    for j in range(3):
        for k in range(3):
            first[j, k] += B[j, k]
            to_B[j, k] += first[j, k]
            to_C[j, k] += C[j, k]
    # (M d x)^T = -d x M^T, so both products are of columns.
    cross_columns(d, B.T, second)
    for j in range(3):
        for k in range(3):
            to_A[j, k] += A[j, k] + second[j, k]
    cross_columns(d, first.T, second)
    for j in range(3):
        for k in range(3):
            to_A[j, k] += second[k, j]
