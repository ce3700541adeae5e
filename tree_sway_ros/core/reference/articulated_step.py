"""
One step of the articulated tree: springs and dampers implicit, everything else explicit, second order.

ROS2 of Verwer, Spee, Blom & Hundsdorfer (1999), a Rosenbrock method of order two whatever the Jacobian,
L-stable with gamma = 1 - 1/sqrt 2. As Jacobian serve the springs and dampers, which are diagonal in the
joints, so that (1 - gamma h A) costs no more than some inertia added to each joint:

    (M + gamma h C + gamma^2 h^2 K) k = f - gamma h K w.

"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tree_sway_ros.core.reference.articulated_bodies import Bodies
from tree_sway_ros.core.reference.articulated_kernel import (
    Articulation,
    Motion,
    accelerate,
    load,
    move,
    push,
)
from tree_sway_ros.core.reference.rotation_kernel import (
    conjugate_torque,
    cross,
    exponential,
    logarithm,
    matrix_of,
    multiply,
    rotate,
)

Floats = NDArray[np.float64]
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
    drag
        Half the density of air times C of Cd = C U^-N, in [kg/m^3 (m/s)^N].
    drag_exponent
        N in [-].
    reconfiguration
        Lowest and highest speed U that the drag law follows in [m/s].

    """

    gravity: float
    mass_damping: float
    stiffness_damping: float
    drag: float
    drag_exponent: float
    reconfiguration: tuple[float, float]


@njit(cache=True)
def drag_force(laws: Laws, axis: Floats, velocity: Floats) -> Floats:
    """Drag (3,) on a segment by the air's velocity (3,) relative to it in [m/s], in [N/m^2]."""
    along = axis[0] * velocity[0] + axis[1] * velocity[1] + axis[2] * velocity[2]
    across = velocity - along * axis
    speed = math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
    factor = laws.drag * speed
    if laws.drag_exponent != 0.0:
        low, high = laws.reconfiguration
        factor *= min(max(speed, low), high) ** -laws.drag_exponent
    return factor * across


@njit(cache=True)
def push_drag(
    bodies: Bodies, motion: Motion, laws: Laws, wind: Floats, room: Articulation
) -> None:
    """
    Push the drag on every segment by the wind (n, 3) relative to the middle of its chord.

    Each part of the segment takes the force on its own area, at its own middle.

    """
    ground, still = np.eye(3), np.zeros(3)
    for i in range(len(bodies.mass)):
        p = bodies.carrier[i]
        root_side = rotate(motion.rotation[p] if p >= 0 else ground, bodies.axis[i])
        root_side *= bodies.reach[i, 0]
        tip_side = bodies.reach[i, 1] * rotate(motion.rotation[i], bodies.axis[i])
        chord = root_side + tip_side
        chord /= math.sqrt(chord[0] ** 2 + chord[1] ** 2 + chord[2] ** 2)
        swung = cross(motion.spin[i], tip_side) - cross(motion.spin[p] if p >= 0 else still, root_side)
        velocity = motion.velocity[i] + 0.5 * swung
        force = drag_force(laws, chord, wind[i] - velocity)
        push(i, 0.5 * tip_side, bodies.area[i, 1] * force, room)
        if p >= 0:
            push(p, motion.arm[i] - 0.5 * root_side, bodies.area[i, 0] * force, room)


@njit(cache=True)
def spring_torque(bodies: Bodies, turn: Floats, out: Floats) -> None:
    """Torque of the springs (n, 3) in body axes by the rotations of the joints, quaternions (n, 4)."""
    for i in range(len(turn)):
        v = logarithm(turn[i])
        along = v[0] * bodies.axis[i, 0] + v[1] * bodies.axis[i, 1] + v[2] * bodies.axis[i, 2]
        gradient = bodies.bend[i] * v + (bodies.twist[i] - bodies.bend[i]) * along * bodies.axis[i]
        out[i] = conjugate_torque(v, gradient - bodies.rest_torque[i])


@njit(cache=True)
def stiffness_times(bodies: Bodies, vector: Floats, i: int) -> Floats:
    """Stiffness of joint i times a vector (3,) in body axes."""
    t = bodies.axis[i]
    along = vector[0] * t[0] + vector[1] * t[1] + vector[2] * t[2]
    return bodies.bend[i] * vector + (bodies.twist[i] - bodies.bend[i]) * along * t


@njit(cache=True)
def respond(
    bodies: Bodies,
    laws: Laws,
    turn: Floats,
    rate: Floats,
    wind: Floats,
    extra: Floats,
    implicit: float,
    motion: Motion,
    room: Articulation,
    out: Floats,
) -> None:
    """
    Accelerations of the joints (n, 3) in [rad/s^2], body axes.

    Parameters
    ----------
    bodies, laws
        The tree and what acts on it.
    turn, rate
        Quaternions (n, 4) and angular velocities (n, 3) of the joints.
    wind
        Air at each segment in [m/s], (n, 3).
    extra
        Torque added to the joints' own in [N m], (n, 3).
    implicit
        gamma h in [s]; 0 is the plain equation of motion.
    motion, room
        Filled on the way.
    out
        Where the accelerations go.

    """
    n = len(turn)
    matrix = np.empty((n, 3, 3))
    for i in range(n):
        matrix_of(turn[i], matrix[i])
    move(bodies, matrix, rate, motion)
    load(bodies, motion, laws.gravity, laws.mass_damping, room)
    push_drag(bodies, motion, laws, wind, room)
    torque = np.empty((n, 3))
    spring_torque(bodies, turn, torque)
    late = laws.stiffness_damping + implicit
    for i in range(n):
        torque[i] += extra[i] - late * stiffness_times(bodies, rate[i], i)
    accelerate(bodies, motion, torque, implicit * late * bodies.bend, implicit * late * bodies.twist, room, out)


@njit(cache=True)
def advance(
    bodies: Bodies,
    laws: Laws,
    turn: Floats,
    rate: Floats,
    wind: Floats,
    dt: float,
    motion: Motion,
    room: Articulation,
) -> None:
    """Move the state, quaternions (n, 4) and rates (n, 3), on by dt in [s]."""
    n = len(turn)
    gh = GAMMA * dt
    first, second = np.empty((n, 3)), np.empty((n, 3))
    extra = np.zeros((n, 3))
    respond(bodies, laws, turn, rate, wind, extra, gh, motion, room, first)
    stage_turn, stage_rate = np.empty((n, 4)), rate + dt * first
    beta = laws.stiffness_damping
    for i in range(n):
        multiply(turn[i], exponential(dt * (rate[i] + gh * first[i])), stage_turn[i])
        along = (rate[i] + gh * first[i]) + (beta + gh) * first[i]
        extra[i] = 2.0 * gh * stiffness_times(bodies, along, i)
    respond(bodies, laws, stage_turn, stage_rate, wind, extra, gh, motion, room, second)
    for i in range(n):
        # Both stages' rates of the rotation; the difference of their frames is third order.
        later = stage_rate[i] - 2.0 * gh * first[i] + gh * second[i]
        moved = 0.5 * dt * (rate[i] + gh * first[i] + later)
        multiply(turn[i], exponential(moved), turn[i])
        rate[i] += 0.5 * dt * (first[i] + second[i])
    for i in range(n):
        matrix_of(turn[i], motion.rotation[i])
    move(bodies, motion.rotation.copy(), rate, motion)

