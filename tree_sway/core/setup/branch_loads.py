# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Outward pass of motion and inward pass of loads through the branches of a tree.

Outward, from the stem to the twigs: the motion of each base follows from that of its parent, in
its own turned frame, and the wind's force on each branch from its relative velocity. Inward, from
the twigs to the stem: forces and moments are summed over subtrees.

**The passes are each other's transpose.** The drag does work at the very velocities that it is
computed from, however far the tree is bent; so drag never adds energy.
"""

from __future__ import annotations

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import fused, part
from tree_sway.core.model.drag_law import drag
from tree_sway.core.model.records import Branches, Load, Loads, WIDTH, Works
from tree_sway.core.rotation import product, quaternion, rotated, turned


@part
def outward_pass(branches: Branches, work: Works, x: Floats, v: Floats) -> None:
    """
    Find the motion of all bases by rotations [rad] and rates [rad/s], (N,), of their parents.

    Position, velocity and orientation of the bases are written to records of `WORK`, (b,). A base
    keeps its distance from the parent's base, as the end of a rod.
    """
    work[0].velocity[:], work[0].orientation[:] = 0.0, 0.0
    work[0].orientation[0] = 1.0
    for b in range(1, len(branches)):
        branch, own, parent_work = branches[b], work[b], work[branches[b].parent]
        parent, twist, base = branches[branch.parent], branch.twist, branch.base
        i, moved, rotation, arm = parent.coordinate, own.displacement, own.rotation, own.arm
        sx, sy, sz, tx, ty, tz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        ux, uy, uz, wx, wy, wz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for c in range(parent.n_coordinates):
            q, rate, row = x[i + c], v[i + c], twist[c]
            sx, sy, sz = sx + q * row[0], sy + q * row[1], sz + q * row[2]
            tx, ty, tz = tx + q * row[3], ty + q * row[4], tz + q * row[5]
            ux, uy, uz = ux + rate * row[0], uy + rate * row[1], uz + rate * row[2]
            wx, wy, wz = wx + rate * row[3], wy + rate * row[4], wz + rate * row[5]
        sx += ty * base[2] - tz * base[1]
        sy += tz * base[0] - tx * base[2]
        sz += tx * base[1] - ty * base[0]
        ux += wy * base[2] - wz * base[1]
        uy += wz * base[0] - wx * base[2]
        uz += wx * base[1] - wy * base[0]
        shortening = branch.per_arm * (sx * sx + sy * sy + sz * sz)
        shortening_rate = 2.0 * branch.per_arm * (sx * ux + sy * uy + sz * uz)
        ax = (1.0 - shortening) * branch.arm[0] + sx
        ay = (1.0 - shortening) * branch.arm[1] + sy
        az = (1.0 - shortening) * branch.arm[2] + sz
        moved[0], moved[1], moved[2] = sx, sy, sz
        rotation[0], rotation[1], rotation[2] = tx, ty, tz
        arm[0], arm[1], arm[2] = ax, ay, az
        vx, vy, vz, px, py, pz = (
            parent_work.velocity[0], parent_work.velocity[1], parent_work.velocity[2],
            parent_work.velocity[3], parent_work.velocity[4], parent_work.velocity[5],
        )  # fmt: skip
        # The spin of a rotation vector t exceeds its rate w by t x w / 2 + t x (t x w) / 6.
        gx, gy, gz = ty * wz - tz * wy, tz * wx - tx * wz, tx * wy - ty * wx
        kx = px + wx + 0.5 * gx + (ty * gz - tz * gy) / 6.0
        ky = py + wy + 0.5 * gy + (tz * gx - tx * gz) / 6.0
        kz = pz + wz + 0.5 * gz + (tx * gy - ty * gx) / 6.0
        vx += py * az - pz * ay + ux - shortening_rate * branch.arm[0]
        vy += pz * ax - px * az + uy - shortening_rate * branch.arm[1]
        vz += px * ay - py * ax + uz - shortening_rate * branch.arm[2]
        own_velocity = own.velocity
        own_velocity[0], own_velocity[1], own_velocity[2] = turned(-tx, -ty, -tz, vx, vy, vz)
        own_velocity[3], own_velocity[4], own_velocity[5] = turned(-tx, -ty, -tz, kx, ky, kz)
        old, new = parent_work.orientation, own.orientation
        qw, qx, qy, qz = quaternion(tx, ty, tz)
        new[0], new[1], new[2], new[3] = product(old[0], old[1], old[2], old[3], qw, qx, qy, qz)


@part
def set_air(work: Works, loads: Loads, wx: float, wy: float, wz: float) -> None:
    """Write the wind [m/s] of every branch in the turned frame of its base."""
    for b in range(len(work)):
        group, j, q = loads[b // WIDTH], b % WIDTH, work[b].orientation
        speed = group.speed[j]
        group.air_velocity[0, j], group.air_velocity[1, j], group.air_velocity[2, j] = rotated(
            q[0], -q[1], -q[2], -q[3], speed * (wx + group.gust[0, j]),
            speed * (wy + group.gust[1, j]), speed * (wz + group.gust[2, j]),
        )  # fmt: skip
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
        `pressure` of the wind in [kg/m^3].

    """
    for block in range(len(loads)):
        group = loads[block]
        base, air, rotation, impulse, coupling = (
            group.velocity, group.air_velocity, group.rotation, group.drag_impulse, group.coupling,
        )  # fmt: skip
        damping, mode, p, x, v = (
            group.damping_mode, group.load_rotation, group.projector, group.x, group.v,
        )  # fmt: skip
        force, own_force, own_velocity = group.force, group.own_force, group.moment
        for j in range(WIDTH):
            for k in range(3):
                rotation[k, j] = mode[0, k, j] * x[0, j] + mode[1, k, j] * x[1, j]
                own_velocity[k, j] = damping[0, k, j] * v[0, j] + damping[1, k, j] * v[1, j]
        for c in range(2, group.n_rows):
            for k in range(3):
                for j in range(WIDTH):
                    rotation[k, j] += mode[c, k, j] * x[c, j]
                    own_velocity[k, j] += damping[c, k, j] * v[c, j]
        for j in range(WIDTH):
            tx, ty, tz = rotation[0, j], rotation[1, j], rotation[2, j]
            ux, uy, uz = air[0, j] - base[0, j], air[1, j] - base[1, j], air[2, j] - base[2, j]
            ux, uy, uz = turned(-tx, -ty, -tz, ux, uy, uz)
            wx, wy, wz = turned(-tx, -ty, -tz, base[3, j], base[4, j], base[5, j])
            beta = group.compliance[j]
            sx = coupling[0, 0, j] * wx + coupling[1, 0, j] * wy + coupling[2, 0, j] * wz
            sy = coupling[0, 1, j] * wx + coupling[1, 1, j] * wy + coupling[2, 1, j] * wz
            sz = coupling[0, 2, j] * wx + coupling[1, 2, j] * wy + coupling[2, 2, j] * wz
            ux += beta * impulse[0, j] - own_velocity[0, j] - sx
            uy += beta * impulse[1, j] - own_velocity[1, j] - sy
            uz += beta * impulse[2, j] - own_velocity[2, j] - sz
            fx, fy, fz, f = drag(
                p[0, j], p[1, j], p[2, j], p[3, j], p[4, j], p[5, j],
                per_speed_squared * group.area[j], beta, ux, uy, uz,
                group.spread[j] * (v[0, j] * v[0, j] + v[1, j] * v[1, j]),
            )  # fmt: skip
            impulse[0, j], impulse[1, j], impulse[2, j] = f * ux, f * uy, f * uz
            own_force[0, j], own_force[1, j], own_force[2, j] = fx, fy, fz
            force[0, j], force[1, j], force[2, j] = turned(tx, ty, tz, fx, fy, fz)


@part
def own_loads(loads: Loads) -> None:
    """
    Turn the wind's own forces on branches into loads on their key rotations.

    Forces act on the branch in its bent direction. Records are of `load_layout`, after
    `wind_forces`.
    """
    for block in range(len(loads)):
        group = loads[block]
        force, mode, lever, load = group.force, group.load_mode, group.chord_lever, group.load
        for j in range(WIDTH):
            fx, fy, fz = force[0, j], force[1, j], force[2, j]
            load[0, j] = lever[0, j] * fx + lever[1, j] * fy + lever[2, j] * fz
            load[1, j] = mode[0, 0, j] * fx + mode[0, 1, j] * fy + mode[0, 2, j] * fz
            load[2, j] = mode[1, 0, j] * fx + mode[1, 1, j] * fy + mode[1, 2, j] * fz


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
        _turned_loads(loads[block])
    for b in range(len(branches)):
        group, j, i = loads[b // WIDTH], b % WIDTH, branches[b].coordinate
        for c in range(branches[b].n_coordinates):
            moment[i + c] = group.load[1 + c, j]
        wrench = work[b].wrench
        for k in range(3):
            wrench[k], wrench[3 + k] = group.force[k, j], group.moment[k, j]
        q, world = work[b].orientation, work[b].force
        world[0], world[1], world[2] = rotated(
            q[0], q[1], q[2], q[3], wrench[0], wrench[1], wrench[2]
        )
    for b in range(len(branches) - 1, 0, -1):
        branch, own = branches[b], work[b]
        wrench, rotation, moved, bent_arm = own.wrench, own.rotation, own.displacement, own.arm
        tx, ty, tz = rotation[0], rotation[1], rotation[2]
        dx, dy, dz = moved[0], moved[1], moved[2]
        fx, fy, fz = turned(tx, ty, tz, wrench[0], wrench[1], wrench[2])
        mx, my, mz = turned(tx, ty, tz, wrench[3], wrench[4], wrench[5])
        arm, base, twist = branch.arm, branch.base, branch.twist
        ax, ay, az = bent_arm[0], bent_arm[1], bent_arm[2]
        total = work[branch.parent].wrench
        total[0], total[1], total[2] = total[0] + fx, total[1] + fy, total[2] + fz
        total[3] += mx + ay * fz - az * fy
        total[4] += my + az * fx - ax * fz
        total[5] += mz + ax * fy - ay * fx
        axial = 2.0 * branch.per_arm * (arm[0] * fx + arm[1] * fy + arm[2] * fz)
        fx, fy, fz = fx - axial * dx, fy - axial * dy, fz - axial * dz
        gx, gy, gz = my * tz - mz * ty, mz * tx - mx * tz, mx * ty - my * tx
        px = mx + 0.5 * gx + (gy * tz - gz * ty) / 6.0 + base[1] * fz - base[2] * fy
        py = my + 0.5 * gy + (gz * tx - gx * tz) / 6.0 + base[2] * fx - base[0] * fz
        pz = mz + 0.5 * gz + (gx * ty - gy * tx) / 6.0 + base[0] * fy - base[1] * fx
        parent = branches[branch.parent]
        i = parent.coordinate
        for c in range(parent.n_coordinates):
            moment[i + c] += (
                twist[c, 0] * fx + twist[c, 1] * fy + twist[c, 2] * fz
                + twist[c, 3] * px + twist[c, 4] * py + twist[c, 5] * pz
            )  # fmt: skip


@part
def _turned_loads(loads: Load) -> None:
    """Turn the wind's forces on sixteen branches into loads and moments about their bases."""
    force, mode, load, coupling = loads.own_force, loads.load_mode, loads.load, loads.coupling
    rotation, moment = loads.rotation, loads.moment
    for j in range(WIDTH):
        fx, fy, fz = force[0, j], force[1, j], force[2, j]
        load[1, j] = mode[0, 0, j] * fx + mode[0, 1, j] * fy + mode[0, 2, j] * fz
        load[2, j] = mode[1, 0, j] * fx + mode[1, 1, j] * fy + mode[1, 2, j] * fz
        moment[0, j], moment[1, j], moment[2, j] = turned(
            rotation[0, j], rotation[1, j], rotation[2, j],
            coupling[0, 0, j] * fx + coupling[0, 1, j] * fy + coupling[0, 2, j] * fz,
            coupling[1, 0, j] * fx + coupling[1, 1, j] * fy + coupling[1, 2, j] * fz,
            coupling[2, 0, j] * fx + coupling[2, 1, j] * fy + coupling[2, 2, j] * fz,
        )  # fmt: skip
    for c in range(2, loads.n_rows):
        for j in range(WIDTH):
            fx, fy, fz = force[0, j], force[1, j], force[2, j]
            load[1 + c, j] = mode[c, 0, j] * fx + mode[c, 1, j] * fy + mode[c, 2, j] * fz


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
        group, j, i = loads[b // WIDTH], b % WIDTH, branches[b].coordinate
        for c in range(branches[b].n_coordinates):
            group.x[c, j], group.v[c, j] = x[i + c], v[i + c]
    set_air(work, loads, wx, wy, wz)
    wind_forces(loads, per_speed_squared)
    bent_loads(branches, work, loads, moment)
