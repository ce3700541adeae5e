# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One step of the articulated tree: springs and dampers implicit, all else explicit, order two.

ROS2 of Verwer, Spee, Blom & Hundsdorfer (1999), a Rosenbrock method of order two whatever the
Jacobian, L-stable with gamma = 1 - 1/sqrt 2. As Jacobian serve the springs and dampers, each of
its own joint only, so that (1 - gamma h A) costs no more than some inertia added to each joint:

    (M + gamma h C + gamma^2 h^2 K) k = f - gamma h K w.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway_lab.kernel import kernel
from tree_sway_lab.segments.articulated_bodies import Bodies
from tree_sway_lab.segments.articulated_kernel import (
    accelerate,
    Articulation,
    load,
    Motion,
    move,
    push,
)
from tree_sway_lab.segments.rotation_kernel import (
    cross,
    dot,
    held_torque,
    logarithm,
    matrix_of,
    plus,
    read,
    times,
    turn_on,
    twist_of,
    Vector,
    write,
)

GAMMA = 1.0 - math.sqrt(0.5)


class Laws(NamedTuple):
    """
    What acts on the bodies.

    Parameters
    ----------
    gravity
        In [m/s^2].
    mass_damping, stiffness_damping
        Rayleigh's coefficients in [1/s] and [s].
    mode_damping, mode_square
        Damping of single modes on top in [1/s] and their circular frequencies squared, (k,).
    mode_turn, mode_momentum
        Their rotations of the joints and momenta per rate, (k, n, 3).
    drag
        Half the density of air times C of Cd = C U^-N, in [kg/m^3 (m/s)^N].
    drag_exponent
        N in [-].
    slowest, fastest
        Wind speeds between which the drag coefficient follows U^-N, in [m/s].
    steady_drag
        Half the density of air times a drag coefficient that adds to it, in [kg/m^3].

    """

    gravity: float
    mass_damping: float
    stiffness_damping: float
    mode_damping: Floats
    mode_square: Floats
    mode_turn: Floats
    mode_momentum: Floats
    drag: float
    drag_exponent: float
    slowest: float
    fastest: float
    steady_drag: float = 0.0


class State(NamedTuple):
    """Rotations of the joints, quaternions wxyz (n, 4), and rates in body axes [rad/s], (n, 3)."""

    turn: Floats
    rate: Floats


class Scratch(NamedTuple):
    """
    Scratch of a step.

    Parameters
    ----------
    matrix
        Rotations of the joints, (n, 3, 3).
    stage_turn, stage_rate
        State of the second stage, (n, 4) and (n, 3).
    torque, twist_axis
        Of the joints, body axes, (n, 3).
    pull
        What the stiffness is applied to on top of the springs' own angle in [rad], (n, 3).
    first, second
        Accelerations of the stages, (n, 3).

    """

    matrix: Floats
    stage_turn: Floats
    stage_rate: Floats
    torque: Floats
    twist_axis: Floats
    pull: Floats
    first: Floats
    second: Floats


def scratch_of(n: int) -> Scratch:
    """Make room for a step of n bodies."""
    return Scratch(np.zeros((n, 3, 3)), np.zeros((n, 4)), *np.zeros((6, n, 3)))


@kernel
def drag(laws: Laws, axis: Vector, wind: Vector, velocity: Vector) -> Vector:
    """Drag on a segment with this axis and velocity in this wind, by its area, in [N/m^2]."""
    air = plus(wind, velocity, -1.0)
    across = plus(air, axis, -dot(air, axis))
    factor = laws.drag
    if laws.drag_exponent != 0.0:
        speed = min(max(math.sqrt(dot(wind, wind)), laws.slowest), laws.fastest)
        factor *= math.pow(speed, -laws.drag_exponent)
    factor = (factor + laws.steady_drag) * math.sqrt(dot(across, across))
    return factor * across[0], factor * across[1], factor * across[2]


@kernel
def push_drag(
    bodies: Bodies, motion: Motion, laws: Laws, wind: Floats, articulation: Articulation
) -> None:
    """
    Push the drag on every segment by the wind (n, 3) relative to the middle of its chord.

    Each part of the segment takes the force on its own area, at its own middle.
    """
    for i in range(len(bodies.mass)):
        p = bodies.carrier[i]
        axis, zero = read(bodies.axis, i), (0.0, 0.0, 0.0)
        tip_side = plus(zero, times(motion.rotation[i], axis), bodies.reach[i, 1])
        root_side = axis if p < 0 else times(motion.rotation[p], axis)
        root_side = plus(zero, root_side, bodies.reach[i, 0])
        chord = plus(tip_side, root_side, 1.0)
        chord = plus(zero, chord, 1.0 / math.sqrt(dot(chord, chord)))
        velocity = plus(read(motion.velocity, i), cross(read(motion.spin, i), tip_side), 0.5)
        if p >= 0:
            velocity = plus(velocity, cross(read(motion.spin, p), root_side), -0.5)
        force = drag(laws, chord, read(wind, i), velocity)
        push(i, plus(zero, tip_side, 0.5), force, bodies.area[i, 1], articulation)
        if p >= 0:
            place = plus(read(motion.arm, i), root_side, -0.5)
            push(p, place, force, bodies.area[i, 0], articulation)


@kernel
def spring(bodies: Bodies, i: int, v: Vector, twist: float, twist_axis: Vector) -> Vector:
    """Stiffness of joint i times a vector in body axes whose part along the twist's is given."""
    bend = bodies.bend[i]
    about = (bodies.twist[i] - bend) * twist
    return plus((bend * v[0], bend * v[1], bend * v[2]), twist_axis, about)


@kernel
def damp_modes(laws: Laws, rate: Floats, implicit: float, out: Floats) -> None:
    """
    Take the damping of single modes off the accelerations of the joints, (n, 3).

    Taken off their torques it would shake a bent tree to pieces: there a torque that bends the
    tree at rest also twists it, and has hardly any inertia to do so against.
    """
    for mode in range(len(laws.mode_damping)):
        momentum, shape = laws.mode_momentum[mode], laws.mode_turn[mode]
        speed = 0.0
        for i in range(len(rate)):
            speed += dot(read(momentum, i), read(rate, i))
        speed *= laws.mode_damping[mode] / (1.0 + implicit * laws.mode_square[mode])
        for i in range(len(rate)):
            write(out, i, plus(read(out, i), read(shape, i), -speed))


@kernel
def respond(
    bodies: Bodies,
    laws: Laws,
    turn: Floats,
    rate: Floats,
    wind: Floats,
    implicit: float,
    motion: Motion,
    articulation: Articulation,
    scratch: Scratch,
    out: Floats,
) -> None:
    """
    Accelerations of the joints (n, 3) in [rad/s^2], body axes, in air (n, 3) in [m/s].

    Joints have quaternions (n, 4) and angular velocities (n, 3). ``implicit`` is gamma h in [s]; 0
    is the plain equation of motion. What is filled on the way is scratch, but for its `pull`,
    which is read.
    """
    late = laws.stiffness_damping + implicit
    for i in range(len(turn)):
        matrix_of(turn[i], scratch.matrix[i])
        v = logarithm(turn[i])
        twist, g = twist_of(turn[i], read(bodies.axis, i))
        write(scratch.twist_axis, i, g)
        torque = held_torque(v, read(bodies.rest_torque, i))
        torque = plus(torque, spring(bodies, i, v, twist, g), -1.0)
        v = plus(read(scratch.pull, i), read(rate, i), -late)
        write(scratch.torque, i, plus(torque, spring(bodies, i, v, dot(g, v), g), 1.0))
    move(bodies, scratch.matrix, rate, motion)
    load(bodies, motion, laws.gravity, laws.mass_damping, articulation)
    push_drag(bodies, motion, laws, wind, articulation)
    accelerate(
        bodies, motion, scratch.torque, scratch.twist_axis, implicit * late, articulation, out
    )
    damp_modes(laws, rate, implicit * late, out)


@kernel
def advance(
    bodies: Bodies,
    laws: Laws,
    state: State,
    wind: Floats,
    dt: float,
    motion: Motion,
    articulation: Articulation,
    scratch: Scratch,
) -> None:
    """Move the state on by dt in [s]."""
    turn, rate = state.turn, state.rate
    first, second = scratch.first, scratch.second
    gh = GAMMA * dt
    scratch.pull[:] = 0.0
    respond(bodies, laws, turn, rate, wind, gh, motion, articulation, scratch, first)
    beta = laws.stiffness_damping
    for i in range(len(turn)):
        k = read(first, i)
        moving = plus(read(rate, i), k, gh)
        turn_on(turn[i], plus((0.0, 0.0, 0.0), moving, dt), scratch.stage_turn[i])
        write(scratch.stage_rate, i, plus(read(rate, i), k, dt))
        write(scratch.pull, i, plus((0.0, 0.0, 0.0), plus(moving, k, beta + gh), 2.0 * gh))
    respond(
        bodies,
        laws,
        scratch.stage_turn,
        scratch.stage_rate,
        wind,
        gh,
        motion,
        articulation,
        scratch,
        second,
    )
    for i in range(len(turn)):
        k, m = read(first, i), read(second, i)
        # Rates of rotation of both stages; that their axes differ is of third order.
        both = plus(read(rate, i), read(scratch.stage_rate, i), 1.0)
        both = plus(plus(both, k, -gh), m, gh)
        turn_on(turn[i], plus((0.0, 0.0, 0.0), both, 0.5 * dt), turn[i])
        write(rate, i, plus(plus(read(rate, i), k, 0.5 * dt), m, 0.5 * dt))
