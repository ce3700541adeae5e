# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
One pass outward and one inward: how branches move on each other, and what they hand to each other.

Outward, from the stem to the twigs: each base takes over the motion of its parent, and the wind's
force on each branch is found in the air that passes it. Inward, from the twigs to the stem: each
branch adds up force and moment of all it carries.
"""

from __future__ import annotations

from tree_sway.core.arrays import Floats, Record, Records
from tree_sway.core.kernel import fused, kernel
from tree_sway.core.motion.drag import drag
from tree_sway.core.motion.records import LANES
from tree_sway.core.rotation import turned


@fused
def outward_pass(branches: Records, work: Records, x: Floats, v: Floats) -> None:
    """
    Hand rotation [rad] and velocity [rad/s], (N,), of every parent to the bases of its children.

    How bases move and are turned is written to records of `WORK`, (b,).
    """
    for b in range(1, len(branches)):
        branch = branches[b]
        parent = branches[branch.parent]
        i, twist = parent.coordinate, branch.twist
        here, below = work[b], work[branch.parent]
        vx, vy, ax, ay = v[i], v[i + 1], x[i], x[i + 1]
        shift, turn, at = here.shift, here.turn, branch.base
        for k in range(6):
            here.velocity[k] = below.velocity[k] + twist[0, k] * vx + twist[1, k] * vy
        for k in range(3):
            shift[k] = twist[0, k] * ax + twist[1, k] * ay
            turn[k] = twist[0, 3 + k] * ax + twist[1, 3 + k] * ay
        for c in range(2, parent.n_coordinates):
            rate, angle = v[i + c], x[i + c]
            for k in range(6):
                here.velocity[k] += twist[c, k] * rate
            for k in range(3):
                shift[k] += twist[c, k] * angle
                turn[k] += twist[c, 3 + k] * angle
        for k in range(3):
            here.rotation[k] = below.rotation[k] + turn[k]
        shift[0] += turn[1] * at[2] - turn[2] * at[1]
        shift[1] += turn[2] * at[0] - turn[0] * at[2]
        shift[2] += turn[0] * at[1] - turn[1] * at[0]


@kernel
def set_gusts(loads: Records, apart: Floats) -> None:
    """Give every branch the wind of its delay: by how much it differs from the tree's (d, 3)."""
    for block in range(len(loads)):
        here = loads[block]
        for j in range(LANES):
            own = here.delay[j]
            for k in range(3):
                here.gust[k, j] = apart[own, k]


@fused
def wind_forces(
    branches: Records, work: Records, loads: Records,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> None:  # fmt: skip
    """
    Find the wind's force on every branch.

    Parameters
    ----------
    branches, work, loads
        Records of `BRANCH` and `WORK`, (b,), and of `load_fields`. The last hold key rotations and
        rates half a step on, under the last step's forces, and the slip of the last step; forces
        and slip are written.
    wx, wy, wz
        Mean wind over the step in [m/s].
    per_speed_squared
        `pressure` of the wind in [kg/m^3].

    """
    # Each pass goes over all branches: what is written one by one and read as vectors at once
    # would have to wait.
    n = len(branches)
    for block in range(len(loads)):
        _move_loads(loads[block])
        _drag_forces(loads[block], wx, wy, wz, per_speed_squared)
    for b in range(n):
        here, j = loads[b // LANES], b % LANES
        if not here.is_solved[j]:
            _copy_force(here, j, loads, branches[b].source)
        for k in range(3):
            work[b].force[k] = here.force[k, j]


@fused
def _move_loads(loads: Record) -> None:
    """Set how the loads of sixteen branches move and are turned, half a step on."""
    velocity, centre, base, flow, lean = (
        loads.velocity, loads.centre, loads.base, loads.damping_mode, loads.load_rotation,
    )  # fmt: skip
    x, v, motion, turn = loads.x, loads.v, loads.motion, loads.turned
    for j in range(LANES):
        cx, cy, cz = centre[0, j], centre[1, j], centre[2, j]
        rx, ry, rz = velocity[3, j], velocity[4, j], velocity[5, j]
        v0, v1, x0, x1 = v[0, j], v[1, j], x[0, j], x[1, j]
        motion[0, j] = velocity[0, j] + ry * cz - rz * cy + flow[0, 0, j] * v0 + flow[1, 0, j] * v1
        motion[1, j] = velocity[1, j] + rz * cx - rx * cz + flow[0, 1, j] * v0 + flow[1, 1, j] * v1
        motion[2, j] = velocity[2, j] + rx * cy - ry * cx + flow[0, 2, j] * v0 + flow[1, 2, j] * v1
        turn[0, j] = base[0, j] + lean[0, 0, j] * x0 + lean[1, 0, j] * x1
        turn[1, j] = base[1, j] + lean[0, 1, j] * x0 + lean[1, 1, j] * x1
        turn[2, j] = base[2, j] + lean[0, 2, j] * x0 + lean[1, 2, j] * x1
    for c in range(2, loads.n_rows):
        for k in range(3):
            for j in range(LANES):
                motion[k, j] += flow[c, k, j] * v[c, j]
                turn[k, j] += lean[c, k, j] * x[c, j]


@fused
def _drag_forces(loads: Record, wx: float, wy: float, wz: float, per_speed_squared: float) -> None:
    """Find the force on sixteen branches, drag in the frame of each as it is turned."""
    speed, motion, turn, base, slip, gust = (
        loads.speed, loads.motion, loads.turned, loads.base, loads.drag_impulse, loads.gust,
    )  # fmt: skip
    force, turned_force, p, v = loads.force, loads.turned_force, loads.projector, loads.v
    own_force = loads.own_force
    for j in range(LANES):
        tx, ty, tz = turn[0, j], turn[1, j], turn[2, j]
        ux, uy, uz = turned(
            -tx, -ty, -tz,
            speed[j] * (wx + gust[0, j]) - motion[0, j],
            speed[j] * (wy + gust[1, j]) - motion[1, j],
            speed[j] * (wz + gust[2, j]) - motion[2, j],
        )  # fmt: skip
        beta = loads.compliance[j]
        ux, uy, uz = ux + beta * slip[0, j], uy + beta * slip[1, j], uz + beta * slip[2, j]
        fx, fy, fz, f = drag(
            p[0, j], p[1, j], p[2, j], p[3, j], p[4, j], p[5, j],
            per_speed_squared * loads.area[j], beta, ux, uy, uz,
            loads.spread[j] * (v[0, j] * v[0, j] + v[1, j] * v[1, j]),
        )  # fmt: skip
        slip[0, j], slip[1, j], slip[2, j] = f * ux, f * uy, f * uz
        own_force[0, j], own_force[1, j], own_force[2, j] = fx, fy, fz
        fx, fy, fz = turned(tx, ty, tz, fx, fy, fz)
        force[0, j], force[1, j], force[2, j] = fx, fy, fz
        turned_force[0, j], turned_force[1, j], turned_force[2, j] = turned(
            -base[0, j], -base[1, j], -base[2, j], fx, fy, fz
        )


@fused
def _copy_force(here: Record, j: int, loads: Records, source: int) -> None:
    """Give a branch that copies the force on its source."""
    force, base, into = loads[source // LANES].force, here.base, here.turned_force
    fx, fy, fz = force[0, source % LANES], force[1, source % LANES], force[2, source % LANES]
    here.force[0, j], here.force[1, j], here.force[2, j] = fx, fy, fz
    into[0, j], into[1, j], into[2, j] = turned(-base[0, j], -base[1, j], -base[2, j], fx, fy, fz)


@fused
def own_loads(loads: Records) -> None:
    """
    Turn the wind's own forces on branches into loads on their key rotations.

    A force meets a branch where the branch now points. Records are of `load_fields`, after
    `wind_forces`.
    """
    for block in range(len(loads)):
        _own_loads(loads[block])


@fused
def _own_loads(loads: Record) -> None:
    """Turn the wind's own forces on sixteen branches into loads on their coordinates."""
    force, push, along, load = loads.turned_force, loads.load_mode, loads.along, loads.load
    for j in range(LANES):
        fx, fy, fz = force[0, j], force[1, j], force[2, j]
        load[0, j] = along[0, j] * fx + along[1, j] * fy + along[2, j] * fz
        load[1, j] = push[0, 0, j] * fx + push[0, 1, j] * fy + push[0, 2, j] * fz
        load[2, j] = push[1, 0, j] * fx + push[1, 1, j] * fy + push[1, 2, j] * fz


@fused
def bent_loads(branches: Records, work: Records, loads: Records, moment: Floats) -> None:
    """
    Turn forces into moments on the coordinates of a tree as it is bent and turned.

    The load of a branch goes with it as it turns, and each branch hands on what acts on it, at the
    place where its base now is, in the frame of its parent's base. On its way there the base keeps
    its distance from the parent's base, as the end of a rod does.

    Parameters
    ----------
    branches, work, loads
        Records of `BRANCH` and `WORK`, (b,), and of `load_fields`, after `wind_forces`.
    moment
        Moments on the coordinates in [N m], (N,), written.

    """
    for block in range(len(loads)):
        _turned_loads(loads[block])
    for b in range(len(branches)):
        here, j, i = loads[b // LANES], b % LANES, branches[b].coordinate
        for c in range(branches[b].n_coordinates):
            moment[i + c] = here.load[1 + c, j]
        wrench = work[b].wrench
        for k in range(3):
            wrench[k], wrench[3 + k] = here.turned_force[k, j], here.moment[k, j]
    for b in range(len(branches) - 1, 0, -1):
        branch, here = branches[b], work[b]
        wrench, turn, shift = here.wrench, here.turn, here.shift
        tx, ty, tz, dx, dy, dz = turn[0], turn[1], turn[2], shift[0], shift[1], shift[2]
        fx, fy, fz = turned(tx, ty, tz, wrench[0], wrench[1], wrench[2])
        mx, my, mz = turned(tx, ty, tz, wrench[3], wrench[4], wrench[5])
        arm, at, twist = branch.arm, branch.base, branch.twist
        shrunk = 1.0 - branch.per_arm * (dx * dx + dy * dy + dz * dz)
        ax, ay, az = shrunk * arm[0] + dx, shrunk * arm[1] + dy, shrunk * arm[2] + dz
        below = work[branch.parent].wrench
        below[0], below[1], below[2] = below[0] + fx, below[1] + fy, below[2] + fz
        below[3] += mx + ay * fz - az * fy
        below[4] += my + az * fx - ax * fz
        below[5] += mz + ax * fy - ay * fx
        pull = 2.0 * branch.per_arm * (arm[0] * fx + arm[1] * fy + arm[2] * fz)
        fx, fy, fz = fx - pull * dx, fy - pull * dy, fz - pull * dz
        # A rotation on top of one by t turns by half of t more than its own vector says.
        px = mx + 0.5 * (my * tz - mz * ty) + at[1] * fz - at[2] * fy
        py = my + 0.5 * (mz * tx - mx * tz) + at[2] * fx - at[0] * fz
        pz = mz + 0.5 * (mx * ty - my * tx) + at[0] * fy - at[1] * fx
        parent = branches[branch.parent]
        i = parent.coordinate
        for c in range(parent.n_coordinates):
            moment[i + c] += (
                twist[c, 0] * fx + twist[c, 1] * fy + twist[c, 2] * fz
                + twist[c, 3] * px + twist[c, 4] * py + twist[c, 5] * pz
            )  # fmt: skip


@fused
def _turned_loads(loads: Record) -> None:
    """Turn the wind's forces on sixteen branches into loads and moments about their bases."""
    force, push, load, couple = loads.own_force, loads.load_mode, loads.load, loads.coupling
    turn, base, moment = loads.turned, loads.base, loads.moment
    for j in range(LANES):
        fx, fy, fz = force[0, j], force[1, j], force[2, j]
        load[1, j] = push[0, 0, j] * fx + push[0, 1, j] * fy + push[0, 2, j] * fz
        load[2, j] = push[1, 0, j] * fx + push[1, 1, j] * fy + push[1, 2, j] * fz
        moment[0, j], moment[1, j], moment[2, j] = turned(
            turn[0, j] - base[0, j], turn[1, j] - base[1, j], turn[2, j] - base[2, j],
            couple[0, 0, j] * fx + couple[0, 1, j] * fy + couple[0, 2, j] * fz,
            couple[1, 0, j] * fx + couple[1, 1, j] * fy + couple[1, 2, j] * fz,
            couple[2, 0, j] * fx + couple[2, 1, j] * fy + couple[2, 2, j] * fz,
        )  # fmt: skip
    for c in range(2, loads.n_rows):
        for j in range(LANES):
            fx, fy, fz = force[0, j], force[1, j], force[2, j]
            load[1 + c, j] = push[c, 0, j] * fx + push[c, 1, j] * fy + push[c, 2, j] * fz
