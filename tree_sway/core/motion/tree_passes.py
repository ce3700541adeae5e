# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One pass outward and one inward: how branches move on each other, and what they hand to each other.

Outward, from the stem to the twigs: each base takes over the motion of its parent, in its own
frame as it is turned, and the wind's force on each branch is found in the air that passes it.
Inward, from the twigs to the stem: each branch adds up force and moment of all it carries.

**One is the other's transpose.** The velocities that drag is found at are those that its moments
do work at, however far the tree is bent; so no drag ever feeds motion.
"""

from __future__ import annotations

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import part
from tree_sway.core.motion.drag import drag
from tree_sway.core.motion.records import Branches, Load, Loads, WIDTH, Works
from tree_sway.core.rotation import product, quaternion, rotated, turned


@part
def outward_pass(branches: Branches, work: Works, x: Floats, v: Floats) -> None:
    """
    Hand rotation [rad] and velocity [rad/s], (N,), of every parent to the bases of its children.

    Where bases are, how they move and how they are turned is written to records of `WORK`, (b,).
    On its way a base keeps its distance from the parent's base, as the end of a rod does.
    """
    work[0].velocity[:], work[0].attitude[:] = 0.0, 0.0
    work[0].attitude[0] = 1.0
    for b in range(1, len(branches)):
        branch, here, below = branches[b], work[b], work[branches[b].parent]
        parent, twist, at = branches[branch.parent], branch.twist, branch.base
        i, shift, turn, arm = parent.coordinate, here.shift, here.turn, here.arm
        sx, sy, sz, tx, ty, tz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        ux, uy, uz, wx, wy, wz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for c in range(parent.n_coordinates):
            q, rate, row = x[i + c], v[i + c], twist[c]
            sx, sy, sz = sx + q * row[0], sy + q * row[1], sz + q * row[2]
            tx, ty, tz = tx + q * row[3], ty + q * row[4], tz + q * row[5]
            ux, uy, uz = ux + rate * row[0], uy + rate * row[1], uz + rate * row[2]
            wx, wy, wz = wx + rate * row[3], wy + rate * row[4], wz + rate * row[5]
        sx += ty * at[2] - tz * at[1]
        sy += tz * at[0] - tx * at[2]
        sz += tx * at[1] - ty * at[0]
        ux += wy * at[2] - wz * at[1]
        uy += wz * at[0] - wx * at[2]
        uz += wx * at[1] - wy * at[0]
        far = branch.per_arm * (sx * sx + sy * sy + sz * sz)
        gone = 2.0 * branch.per_arm * (sx * ux + sy * uy + sz * uz)
        ax = (1.0 - far) * branch.arm[0] + sx
        ay = (1.0 - far) * branch.arm[1] + sy
        az = (1.0 - far) * branch.arm[2] + sz
        shift[0], shift[1], shift[2] = sx, sy, sz
        turn[0], turn[1], turn[2] = tx, ty, tz
        arm[0], arm[1], arm[2] = ax, ay, az
        vx, vy, vz, px, py, pz = (
            below.velocity[0], below.velocity[1], below.velocity[2],
            below.velocity[3], below.velocity[4], below.velocity[5],
        )  # fmt: skip
        # A rotation on top of one by t spins by t x w / 2 + t x (t x w) / 6 more than its rate w.
        gx, gy, gz = ty * wz - tz * wy, tz * wx - tx * wz, tx * wy - ty * wx
        kx = px + wx + 0.5 * gx + (ty * gz - tz * gy) / 6.0
        ky = py + wy + 0.5 * gy + (tz * gx - tx * gz) / 6.0
        kz = pz + wz + 0.5 * gz + (tx * gy - ty * gx) / 6.0
        vx += py * az - pz * ay + ux - gone * branch.arm[0]
        vy += pz * ax - px * az + uy - gone * branch.arm[1]
        vz += px * ay - py * ax + uz - gone * branch.arm[2]
        mine = here.velocity
        mine[0], mine[1], mine[2] = turned(-tx, -ty, -tz, vx, vy, vz)
        mine[3], mine[4], mine[5] = turned(-tx, -ty, -tz, kx, ky, kz)
        old, new = below.attitude, here.attitude
        qw, qx, qy, qz = quaternion(tx, ty, tz)
        new[0], new[1], new[2], new[3] = product(old[0], old[1], old[2], old[3], qw, qx, qy, qz)


@part
def set_air(work: Works, loads: Loads, wx: float, wy: float, wz: float) -> None:
    """Give every branch the wind [m/s] that blows at it, as its turned base sees it."""
    for b in range(len(work)):
        here, j, q = loads[b // WIDTH], b % WIDTH, work[b].attitude
        speed = here.speed[j]
        here.air[0, j], here.air[1, j], here.air[2, j] = rotated(
            q[0], -q[1], -q[2], -q[3], speed * (wx + here.gust[0, j]),
            speed * (wy + here.gust[1, j]), speed * (wz + here.gust[2, j]),
        )  # fmt: skip
        for k in range(6):
            here.velocity[k, j] = work[b].velocity[k]


@part
def wind_forces(loads: Loads, per_speed_squared: float) -> None:
    """
    Find the wind's force on every branch.

    Parameters
    ----------
    loads
        Records of `load_fields`. They hold key rotations and rates half a step on, under the last
        step's forces, how bases move then, their wind (`set_air`) and the slip of the last step;
        forces and slip are written.
    per_speed_squared
        `pressure` of the wind in [kg/m^3].

    """
    for block in range(len(loads)):
        here = loads[block]
        speed, air, turn, slip, couple = (
            here.velocity, here.air, here.turned, here.drag_impulse, here.coupling,
        )  # fmt: skip
        flow, lean, p, x, v = (
            here.damping_mode, here.load_rotation, here.projector, here.x, here.v,
        )  # fmt: skip
        force, own_force, free = here.force, here.own_force, here.moment
        for j in range(WIDTH):
            for k in range(3):
                turn[k, j] = lean[0, k, j] * x[0, j] + lean[1, k, j] * x[1, j]
                free[k, j] = flow[0, k, j] * v[0, j] + flow[1, k, j] * v[1, j]
        for c in range(2, here.n_rows):
            for k in range(3):
                for j in range(WIDTH):
                    turn[k, j] += lean[c, k, j] * x[c, j]
                    free[k, j] += flow[c, k, j] * v[c, j]
        for j in range(WIDTH):
            tx, ty, tz = turn[0, j], turn[1, j], turn[2, j]
            ux, uy, uz = air[0, j] - speed[0, j], air[1, j] - speed[1, j], air[2, j] - speed[2, j]
            ux, uy, uz = turned(-tx, -ty, -tz, ux, uy, uz)
            wx, wy, wz = turned(-tx, -ty, -tz, speed[3, j], speed[4, j], speed[5, j])
            beta = here.compliance[j]
            ux += (
                beta * slip[0, j]
                - free[0, j]
                - (couple[0, 0, j] * wx + couple[1, 0, j] * wy + couple[2, 0, j] * wz)
            )
            uy += (
                beta * slip[1, j]
                - free[1, j]
                - (couple[0, 1, j] * wx + couple[1, 1, j] * wy + couple[2, 1, j] * wz)
            )
            uz += (
                beta * slip[2, j]
                - free[2, j]
                - (couple[0, 2, j] * wx + couple[1, 2, j] * wy + couple[2, 2, j] * wz)
            )
            fx, fy, fz, f = drag(
                p[0, j], p[1, j], p[2, j], p[3, j], p[4, j], p[5, j],
                per_speed_squared * here.area[j], beta, ux, uy, uz,
                here.spread[j] * (v[0, j] * v[0, j] + v[1, j] * v[1, j]),
            )  # fmt: skip
            slip[0, j], slip[1, j], slip[2, j] = f * ux, f * uy, f * uz
            own_force[0, j], own_force[1, j], own_force[2, j] = fx, fy, fz
            force[0, j], force[1, j], force[2, j] = turned(tx, ty, tz, fx, fy, fz)


@part
def own_loads(loads: Loads) -> None:
    """
    Turn the wind's own forces on branches into loads on their key rotations.

    A force meets a branch where the branch now points. Records are of `load_fields`, after
    `wind_forces`.
    """
    for block in range(len(loads)):
        here = loads[block]
        force, push, along, load = here.force, here.load_mode, here.along, here.load
        for j in range(WIDTH):
            fx, fy, fz = force[0, j], force[1, j], force[2, j]
            load[0, j] = along[0, j] * fx + along[1, j] * fy + along[2, j] * fz
            load[1, j] = push[0, 0, j] * fx + push[0, 1, j] * fy + push[0, 2, j] * fz
            load[2, j] = push[1, 0, j] * fx + push[1, 1, j] * fy + push[1, 2, j] * fz


@part
def bent_loads(branches: Branches, work: Works, loads: Loads, moment: Floats) -> None:
    """
    Turn forces into moments on the coordinates of a tree as it is bent and turned.

    The load of a branch goes with it as it turns, and each branch hands on what acts on it, at the
    place where its base now is, in the frame of its parent's base: `outward_pass` transposed.

    Parameters
    ----------
    branches, work, loads
        Records of `BRANCH` and `WORK`, (b,), after `outward_pass`, and of `load_fields`, after
        `wind_forces`.
    moment
        Moments on the coordinates in [N m], (N,), written.

    """
    for block in range(len(loads)):
        _turned_loads(loads[block])
    for b in range(len(branches)):
        here, j, i = loads[b // WIDTH], b % WIDTH, branches[b].coordinate
        for c in range(branches[b].n_coordinates):
            moment[i + c] = here.load[1 + c, j]
        wrench = work[b].wrench
        for k in range(3):
            wrench[k], wrench[3 + k] = here.force[k, j], here.moment[k, j]
        q, world = work[b].attitude, work[b].force
        world[0], world[1], world[2] = rotated(
            q[0], q[1], q[2], q[3], wrench[0], wrench[1], wrench[2]
        )
    for b in range(len(branches) - 1, 0, -1):
        branch, base = branches[b], work[b]
        wrench, turn, shift, now = base.wrench, base.turn, base.shift, base.arm
        tx, ty, tz, dx, dy, dz = turn[0], turn[1], turn[2], shift[0], shift[1], shift[2]
        fx, fy, fz = turned(tx, ty, tz, wrench[0], wrench[1], wrench[2])
        mx, my, mz = turned(tx, ty, tz, wrench[3], wrench[4], wrench[5])
        arm, at, twist = branch.arm, branch.base, branch.twist
        ax, ay, az = now[0], now[1], now[2]
        below = work[branch.parent].wrench
        below[0], below[1], below[2] = below[0] + fx, below[1] + fy, below[2] + fz
        below[3] += mx + ay * fz - az * fy
        below[4] += my + az * fx - ax * fz
        below[5] += mz + ax * fy - ay * fx
        pull = 2.0 * branch.per_arm * (arm[0] * fx + arm[1] * fy + arm[2] * fz)
        fx, fy, fz = fx - pull * dx, fy - pull * dy, fz - pull * dz
        gx, gy, gz = my * tz - mz * ty, mz * tx - mx * tz, mx * ty - my * tx
        px = mx + 0.5 * gx + (gy * tz - gz * ty) / 6.0 + at[1] * fz - at[2] * fy
        py = my + 0.5 * gy + (gz * tx - gx * tz) / 6.0 + at[2] * fx - at[0] * fz
        pz = mz + 0.5 * gz + (gx * ty - gy * tx) / 6.0 + at[0] * fy - at[1] * fx
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
    force, push, load, couple = loads.own_force, loads.load_mode, loads.load, loads.coupling
    turn, moment = loads.turned, loads.moment
    for j in range(WIDTH):
        fx, fy, fz = force[0, j], force[1, j], force[2, j]
        load[1, j] = push[0, 0, j] * fx + push[0, 1, j] * fy + push[0, 2, j] * fz
        load[2, j] = push[1, 0, j] * fx + push[1, 1, j] * fy + push[1, 2, j] * fz
        moment[0, j], moment[1, j], moment[2, j] = turned(
            turn[0, j], turn[1, j], turn[2, j],
            couple[0, 0, j] * fx + couple[0, 1, j] * fy + couple[0, 2, j] * fz,
            couple[1, 0, j] * fx + couple[1, 1, j] * fy + couple[1, 2, j] * fz,
            couple[2, 0, j] * fx + couple[2, 1, j] * fy + couple[2, 2, j] * fz,
        )  # fmt: skip
    for c in range(2, loads.n_rows):
        for j in range(WIDTH):
            fx, fy, fz = force[0, j], force[1, j], force[2, j]
            load[1 + c, j] = push[c, 0, j] * fx + push[c, 1, j] * fy + push[c, 2, j] * fz
