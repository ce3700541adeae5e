# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Outward pass of motion and inward pass of loads through the branches of a tree.

Outward, from the stem to the twigs: the motion of each base follows from that of its parent, in
its own turned frame, and the wind's force on each branch from its relative velocity. Inward, from
the twigs to the stem: forces and moments are summed over subtrees.

**The passes are each other's transpose.** The drag does work at the very velocities that it is
computed from, however far the tree is bent.
"""

from __future__ import annotations

import math

from tree_sway.core.arrays import Floats
from tree_sway.core.model import Branch, WIDTH
from tree_sway_lab.full.load_layouts import Branches, Load, Loads, Work, Works
from tree_sway_lab.full.rotation import product, quaternion, rotated
from tree_sway_lab.full.vector import (
    column,
    cross,
    dot,
    minus,
    plus,
    plus_times,
    put,
    put_column,
    times,
    turned_back,
    turned_by,
    Vector,
    vector,
)
from tree_sway_lab.kernel import fused, part

_SIXTH = 1.0 / 6.0


@part
def outward_pass(branches: Branches, work: Works, x: Floats, v: Floats) -> None:
    """
    Find the motion of all bases by rotations [rad] and rates [rad/s], (N,), of their parents.

    Position, velocity and orientation of the bases are written to records of `WORK`, (b,). A base
    keeps its distance from the parent's base, as the end of a rod: where it is displaced by s
    across an arm a, it comes closer by ``|s|^2 / (2 |a|)``.
    """
    work[0].velocity[:] = 0.0
    work[0].orientation[:] = 0.0
    work[0].orientation[0] = 1.0
    for b in range(1, len(branches)):
        branch = branches[b]
        own = work[b]
        parent = branches[branch.parent]
        on = work[branch.parent]
        rest_arm = vector(branch.arm, 0)
        shift, rotation = _of_base(branch, parent, x)
        shift_rate, rotation_rate = _of_base(branch, parent, v)
        shortening = branch.per_arm * dot(shift, shift)
        shortening_rate = 2.0 * branch.per_arm * dot(shift, shift_rate)
        arm = plus_times(shift, 1.0 - shortening, rest_arm)
        put(shift, own.displacement, 0)
        put(rotation, own.rotation, 0)
        put(arm, own.arm, 0)

        # In the frame of the parent's base, then in that of the base itself.
        parent_spin = vector(on.velocity, 3)
        carried = plus(vector(on.velocity, 0), cross(parent_spin, arm))
        carried = plus(carried, shift_rate)
        velocity = plus_times(carried, -shortening_rate, rest_arm)
        spin = plus(parent_spin, _spin(rotation, rotation_rate))
        put(turned_back(rotation, velocity), own.velocity, 0)
        put(turned_back(rotation, spin), own.velocity, 3)
        _orient(on.orientation, rotation, own.orientation)


@part
def _of_base(branch: Branch, parent: Branch, amounts: Floats) -> tuple[Vector, Vector]:
    """Find displacement and rotation vector of a base by amounts of its parent's coordinates."""
    shift = (0.0, 0.0, 0.0)
    rotation = (0.0, 0.0, 0.0)
    for c in range(parent.n_coordinates):
        amount = amounts[parent.coordinate + c]
        twist = branch.twist[c]
        shift = plus_times(shift, amount, vector(twist, 0))
        rotation = plus_times(rotation, amount, vector(twist, 3))
    return plus(shift, cross(rotation, vector(branch.base, 0))), rotation


@part
def _spin(rotation: Vector, rate: Vector) -> Vector:
    """
    Return the angular velocity of a rotation vector t that changes by w per second.

    By series it is ``w + t x w / 2 + t x (t x w) / 6``.
    """
    first = cross(rotation, rate)
    second = cross(rotation, first)
    return plus_times(plus_times(rate, 0.5, first), _SIXTH, second)


@part
def _orient(parent: Floats, rotation: Vector, orientation: Floats) -> None:
    """Write the orientation of a base, w x y z, that is rotated from its parent's."""
    w, x, y, z = quaternion(rotation[0], rotation[1], rotation[2])
    w, x, y, z = product(parent[0], parent[1], parent[2], parent[3], w, x, y, z)
    orientation[0] = w
    orientation[1] = x
    orientation[2] = y
    orientation[3] = z


@part
def set_air(work: Works, loads: Loads, wx: float, wy: float, wz: float) -> None:
    """Write the wind [m/s] of every branch in the turned frame of its base."""
    for b in range(len(work)):
        group = loads[b // WIDTH]
        j = b % WIDTH
        q = work[b].orientation
        speed = group.speed[j]
        x = speed * (wx + group.gust[0, j])
        y = speed * (wy + group.gust[1, j])
        z = speed * (wz + group.gust[2, j])
        put_column(rotated(q[0], -q[1], -q[2], -q[3], x, y, z), group.air_velocity, j)
        for k in range(6):
            group.velocity[k, j] = work[b].velocity[k]


@part
def wind_forces(loads: Loads, per_speed_squared: float) -> None:
    """
    Find the wind's force on every branch.

    Parameters
    ----------
    loads
        Records of `load_layout`. Input are key rotations and rates at the middle of the step, the
        motion of the bases, the wind (`set_air`) and the drag impulse of the last step; forces and
        drag impulse are written.
    per_speed_squared
        `drag_density` of the wind in [kg/m^3].

    """
    for block in range(len(loads)):
        group = loads[block]
        _move_pieces(group)
        impulse = group.drag_impulse
        for j in range(WIDTH):
            rotation = column(group.rotation, 0, j)
            # The wind less the motion of the base, of the branch itself, and of its spin.
            wind = minus(column(group.air_velocity, 0, j), column(group.velocity, 0, j))
            spin = turned_back(rotation, column(group.velocity, 3, j))
            air = minus(turned_back(rotation, wind), column(group.moment, 0, j))
            air = minus(air, _transposed_times(group.coupling, j, spin))
            air = plus_times(air, group.compliance[j], column(impulse, 0, j))
            fx, fy, fz, per_velocity = _drag_at(group, j, per_speed_squared, air)
            force = fx, fy, fz
            put_column(times(per_velocity, air), impulse, j)
            put_column(force, group.own_force, j)
            put_column(turned_by(rotation, force), group.force, j)


@part
def _move_pieces(group: Load) -> None:
    """Find rotation and velocity of the loaded pieces; ``moment`` is scratch for the latter."""
    mode = group.load_rotation
    damping = group.damping_mode
    x = group.x
    v = group.v
    rotation = group.rotation
    velocity = group.moment
    for j in range(WIDTH):
        for k in range(3):
            rotation[k, j] = mode[0, k, j] * x[0, j] + mode[1, k, j] * x[1, j]
            velocity[k, j] = damping[0, k, j] * v[0, j] + damping[1, k, j] * v[1, j]
    for c in range(2, group.n_rows):
        for k in range(3):
            for j in range(WIDTH):
                rotation[k, j] += mode[c, k, j] * x[c, j]
                velocity[k, j] += damping[c, k, j] * v[c, j]


@part
def _drag_at(
    group: Load, j: int, per_speed_squared: float, air: Vector
) -> tuple[float, float, float, float]:
    """Return the force on a branch in air, and the force per velocity, as `drag`."""
    p = group.projector
    v = group.v
    c = per_speed_squared * group.area[j]
    spread = group.spread[j] * (v[0, j] * v[0, j] + v[1, j] * v[1, j])
    return drag(
        p[0, j], p[1, j], p[2, j], p[3, j], p[4, j], p[5, j],
        c, group.compliance[j], air[0], air[1], air[2], spread,
    )  # fmt: skip


@part
def drag(
    pxx: float, pyy: float, pzz: float, pxy: float, pxz: float, pyz: float,
    c: float, compliance: float, ux: float, uy: float, uz: float, spread: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """
    Return the force on a branch.

    Parameters
    ----------
    pxx, pyy, pzz, pxy, pxz, pyz
        Projector of the branch.
    c
        `drag_density` times the area of the branch in [kg/m].
    compliance
        Velocity half a step after a unit of force in [s/kg].
    ux, uy, uz
        Air velocity in the branch's own frame, relative to the motion of the branch without this
        force, in [m/s].
    spread
        Variance of the velocity of the pieces about that of the load centre in [m^2/s^2].

    Returns
    -------
    tuple
        Force in the same frame in [N], and force per air velocity in [N s/m].

    """
    nx = pxx * ux + pxy * uy + pxz * uz
    ny = pxy * ux + pyy * uy + pyz * uz
    nz = pxz * ux + pyz * uy + pzz * uz
    free = math.sqrt(max(ux * nx + uy * ny + uz * nz, 0.0) + spread)
    relative_over_free = 2.0 / (1.0 + math.sqrt(1.0 + 4.0 * compliance * c * free))
    f = c * free * relative_over_free * relative_over_free
    return f * nx, f * ny, f * nz, f


@part
def _times(matrix: Floats, j: int, v: Vector) -> Vector:
    """Multiply the matrix (3, 3) of a slot by a vector."""
    return (
        dot(column(matrix[0], 0, j), v),
        dot(column(matrix[1], 0, j), v),
        dot(column(matrix[2], 0, j), v),
    )


@part
def _transposed_times(matrix: Floats, j: int, v: Vector) -> Vector:
    """Multiply the transpose of the matrix (3, 3) of a slot by a vector."""
    total = times(v[0], column(matrix[0], 0, j))
    total = plus_times(total, v[1], column(matrix[1], 0, j))
    return plus_times(total, v[2], column(matrix[2], 0, j))


@part
def bent_loads(branches: Branches, work: Works, loads: Loads, moment: Floats) -> None:
    """
    Turn forces into moments on the coordinates of a tree as it is bent and turned.

    The load of a branch rotates with it, and its force and moment act on the parent at the bent
    position of its base: `outward_pass` transposed.

    Parameters
    ----------
    branches, work, loads
        Records of `Branch` and `WORK`, (b,), after `outward_pass`, and of `load_layout`, after
        `wind_forces`.
    moment
        Moments on the coordinates in [N m], (N,), written.

    """
    for block in range(len(loads)):
        _load_own(loads[block])
    for b in range(len(branches)):
        _begin(branches[b], work[b], loads[b // WIDTH], b % WIDTH, moment)
    for b in range(len(branches) - 1, 0, -1):
        branch = branches[b]
        own = work[b]
        rotation = vector(own.rotation, 0)
        shift = vector(own.displacement, 0)
        force = turned_by(rotation, vector(own.wrench, 0))
        couple = turned_by(rotation, vector(own.wrench, 3))
        total = work[branch.parent].wrench
        at_parent = plus(couple, cross(vector(own.arm, 0), force))
        put(plus(vector(total, 0), force), total, 0)
        put(plus(vector(total, 3), at_parent), total, 3)

        # `outward_pass` transposed: the shortening of the arm, the spin, and the base's motion.
        axial = 2.0 * branch.per_arm * dot(vector(branch.arm, 0), force)
        force = plus_times(force, -axial, shift)
        on_base = plus(_spin_transposed(rotation, couple), cross(vector(branch.base, 0), force))
        parent = branches[branch.parent]
        for c in range(parent.n_coordinates):
            twist = branch.twist[c]
            work_done = dot(vector(twist, 0), force) + dot(vector(twist, 3), on_base)
            moment[parent.coordinate + c] += work_done


@part
def _begin(branch: Branch, own: Work, group: Load, j: int, moment: Floats) -> None:
    """Begin moments, wrench and force of a branch with the wind's own."""
    for c in range(branch.n_coordinates):
        moment[branch.coordinate + c] = group.load[c, j]
    force = column(group.force, 0, j)
    q = own.orientation
    put(force, own.wrench, 0)
    put(column(group.moment, 0, j), own.wrench, 3)
    put(rotated(q[0], q[1], q[2], q[3], force[0], force[1], force[2]), own.force, 0)


@part
def _spin_transposed(rotation: Vector, couple: Vector) -> Vector:
    """Return what a couple does per unit of a rotation vector: `_spin` transposed."""
    first = cross(couple, rotation)
    second = cross(first, rotation)
    return plus_times(plus_times(couple, 0.5, first), _SIXTH, second)


@part
def _load_own(group: Load) -> None:
    """Turn the wind's forces on sixteen branches into loads and moments about their bases."""
    mode = group.load_mode
    for c in range(group.n_rows):
        for j in range(WIDTH):
            force = column(group.own_force, 0, j)
            group.load[c, j] = dot(column(mode[c], 0, j), force)
    for j in range(WIDTH):
        couple = _times(group.coupling, j, column(group.own_force, 0, j))
        put_column(turned_by(column(group.rotation, 0, j), couple), group.moment, j)


@fused
def wind_moments(
    branches: Branches, work: Works, loads: Loads, x: Floats, v: Floats, moment: Floats,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> None:  # fmt: skip
    """
    Find the moments of a wind on the key rotations of a tree that bends and moves.

    Moments are those of `bent_loads`; key rotations are in [rad], their rates in [rad/s], (N,).
    """
    outward_pass(branches, work, x, v)
    for b in range(len(branches)):
        group = loads[b // WIDTH]
        j = b % WIDTH
        first = branches[b].coordinate
        for c in range(branches[b].n_coordinates):
            group.x[c, j] = x[first + c]
            group.v[c, j] = v[first + c]
    set_air(work, loads, wx, wy, wz)
    wind_forces(loads, per_speed_squared)
    bent_loads(branches, work, loads, moment)
