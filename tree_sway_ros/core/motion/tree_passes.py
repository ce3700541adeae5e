"""
One pass out and one pass home: how branches ride on each other, and what they hand to each other.

Out, from the stem to the twigs: each base takes over the motion of its parent. On the way the
wind's force on each branch is found, in the air that passes it. Home, from the twigs to the stem:
each branch adds up force and moment of all it carries.

"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.kernel import fused, inlined
from tree_sway_ros.core.motion.drag import drag
from tree_sway_ros.core.motion.records import AIR, LANES, WORK
from tree_sway_ros.core.rotation import turned


@fused
def ride(branches: Any, work: Any, x: Floats, v: Floats) -> None:
    """
    Hand rotation and velocity of every parent to the bases of its children.

    Parameters
    ----------
    branches, work
        Records of `BRANCH` and `WORK`, (b,); velocity and rotation of the latter are written.
    x, v
        Key rotations in [rad] and their rates in [rad/s], (N,).

    """
    for b in range(1, len(branches)):
        branch = branches[b]
        parent = branches[branch.parent]
        i, twist = parent.coordinate, branch.twist
        here, below = work[b], work[branch.parent]
        vx, vy, ax, ay = v[i], v[i + 1], x[i], x[i + 1]
        for k in range(6):
            here.velocity[k] = below.velocity[k] + twist[0, k] * vx + twist[1, k] * vy
        for k in range(3):
            here.rotation[k] = below.rotation[k] + twist[0, 3 + k] * ax + twist[1, 3 + k] * ay
        for c in range(2, parent.n_coordinates):
            rate, angle = v[i + c], x[i + c]
            for k in range(6):
                here.velocity[k] += twist[c, k] * rate
            for k in range(3):
                here.rotation[k] += twist[c, 3 + k] * angle


def air_records(branches: Any) -> Any:
    """
    Lay out what `blow` knows of `BRANCH` records, (b,), sixteen at a time.

    Returns
    -------
    ndarray
        Of dtype `AIR`, (ceil(b / 16),), with no force so far.

    """
    air = np.zeros(-(-len(branches) // LANES), dtype=AIR)
    refit(air, branches)
    return air


def refit(air: Any, branches: Any) -> None:
    """Take over into `AIR` what has changed in `BRANCH` records; the slip stays."""
    block, lane = np.divmod(np.arange(len(branches)), LANES)
    for name in ("speed", "area", "projector", "compliance"):
        air[name][block, ..., lane] = branches[name]


@fused
def blow(
    branches: Any, work: Any, air: Any, x: Floats, v: Floats,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> None:  # fmt: skip
    """
    Find the wind's force on every branch.

    Parameters
    ----------
    branches, work, air
        Records of `BRANCH` and `WORK`, (b,), and of `AIR`; the slip of the last is read as that of
        the last step; forces and slip are written.
    x, v
        Key rotations and rates half a step on, under the last step's forces, (N,).
    wx, wy, wz
        Mean wind over the step in [m/s].
    per_speed_squared
        `pressure` of the wind in [kg/m^3].

    """
    # Each pass goes over all branches: what is written one by one and read as vectors at once would
    # have to wait.
    n = len(branches)
    for block in range(len(air)):
        for lane in range(min(LANES, n - LANES * block)):
            b = LANES * block + lane
            _expose(branches[b], work[b], air[block], lane, x, v)
    for block in range(len(air)):
        press(air[block], wx, wy, wz, per_speed_squared)
    for block in range(len(air)):
        for lane in range(min(LANES, n - LANES * block)):
            here, pressed = work[LANES * block + lane], air[block]
            for k in range(3):
                here.force[k], here.met[k] = pressed.force[k, lane], pressed.met[k, lane]
    for b in range(n):
        source = branches[b].source
        if source != b:
            force, turn, met = work[b].force, work[b].rotation, work[b].met
            for k in range(3):
                force[k] = work[source].force[k]
            met[0], met[1], met[2] = turned(
                -turn[0], -turn[1], -turn[2], force[0], force[1], force[2]
            )


@inlined
def _expose(branch: Any, work: Any, air: Any, lane: int, x: Floats, v: Floats) -> None:
    """Set how the load of a branch moves and is turned."""
    centre, velocity, rotation, i = branch.centre, work.velocity, work.rotation, branch.coordinate
    flow, turn = branch.flow, branch.turn
    mx = velocity[0] + velocity[4] * centre[2] - velocity[5] * centre[1]
    my = velocity[1] + velocity[5] * centre[0] - velocity[3] * centre[2]
    mz = velocity[2] + velocity[3] * centre[1] - velocity[4] * centre[0]
    tx, ty, tz = rotation[0], rotation[1], rotation[2]
    air.base[0, lane], air.base[1, lane], air.base[2, lane] = tx, ty, tz
    for c in range(branch.n_coordinates):
        rate, angle = v[i + c], x[i + c]
        mx, my, mz = mx + flow[c, 0] * rate, my + flow[c, 1] * rate, mz + flow[c, 2] * rate
        tx, ty, tz = tx + turn[c, 0] * angle, ty + turn[c, 1] * angle, tz + turn[c, 2] * angle
    air.motion[0, lane], air.motion[1, lane], air.motion[2, lane] = mx, my, mz
    air.turn[0, lane], air.turn[1, lane], air.turn[2, lane] = tx, ty, tz


@fused
def press(air: Any, wx: float, wy: float, wz: float, per_speed_squared: float) -> None:
    """Find the force on sixteen branches, drag in the frame of each as it is turned."""
    speed, motion, turn, base, slip = air.speed, air.motion, air.turn, air.base, air.slip
    force, met, p = air.force, air.met, air.projector
    for j in range(LANES):
        tx, ty, tz = turn[0, j], turn[1, j], turn[2, j]
        ux, uy, uz = turned(
            -tx, -ty, -tz,
            speed[j] * wx - motion[0, j], speed[j] * wy - motion[1, j],
            speed[j] * wz - motion[2, j],
        )  # fmt: skip
        beta = air.compliance[j]
        ux, uy, uz = ux + beta * slip[0, j], uy + beta * slip[1, j], uz + beta * slip[2, j]
        fx, fy, fz, f = drag(
            p[0, j], p[1, j], p[2, j], p[3, j], p[4, j], p[5, j],
            per_speed_squared * air.area[j], beta, ux, uy, uz,
        )  # fmt: skip
        slip[0, j], slip[1, j], slip[2, j] = f * ux, f * uy, f * uz
        fx, fy, fz = turned(tx, ty, tz, fx, fy, fz)
        force[0, j], force[1, j], force[2, j] = fx, fy, fz
        met[0, j], met[1, j], met[2, j] = turned(-base[0, j], -base[1, j], -base[2, j], fx, fy, fz)


@fused
def gather(branches: Any, work: Any) -> None:
    """
    Add up, from the twigs to the stem, force and moment about the root of all that each branch
    carries.

    """
    for b in range(len(branches)):
        here, centre = work[b], branches[b].centre
        force, wrench = here.force, here.wrench
        wrench[0], wrench[1], wrench[2] = force[0], force[1], force[2]
        wrench[3] = centre[1] * force[2] - centre[2] * force[1]
        wrench[4] = centre[2] * force[0] - centre[0] * force[2]
        wrench[5] = centre[0] * force[1] - centre[1] * force[0]
    for b in range(len(branches) - 1, 0, -1):
        wrench, below = work[b].wrench, work[branches[b].parent].wrench
        for k in range(6):
            below[k] += wrench[k]


@fused
def generalised(branches: Any, work: Any, carries: bool, moment: Floats, pull: Floats) -> None:
    """
    Turn forces into moments on the key rotations.

    Its own force meets a branch where the branch now points; what it carries acts at rest geometry.

    Parameters
    ----------
    branches, work
        Records of `BRANCH` and `WORK`, (b,), after `blow` and, if anything is carried, `gather`.
    carries
        Whether what a branch carries pushes on it.
    moment
        Moments on the coordinates in [N m], (N,), written.
    pull
        Force along each chord times its lever in [N m], (b,), written.

    """
    for b in range(len(branches)):
        branch, here = branches[b], work[b]
        met, chord = here.met, branch.frame
        fx, fy, fz = met[0], met[1], met[2]
        i = branch.coordinate
        for c in range(branch.n_coordinates):
            moment[i + c] = branch.push[c, 0] * fx + branch.push[c, 1] * fy + branch.push[c, 2] * fz
        pull[b] = branch.lever * (chord[0, 0] * fx + chord[0, 1] * fy + chord[0, 2] * fz)
    if carries:
        carried(branches, work, moment, pull)


@fused
def carried(branches: Any, work: Any, moment: Floats, pull: Floats) -> None:
    """Add to moments and pulls, as of `generalised`, those of all that a branch carries."""
    for b in range(1, len(branches)):
        branch, wrench = branches[b], work[b].wrench
        parent = branches[branch.parent]
        i, chord = parent.coordinate, parent.frame
        for c in range(parent.n_coordinates):
            way = branch.twist[c]
            moment[i + c] += (
                way[0] * wrench[0] + way[1] * wrench[1] + way[2] * wrench[2]
                + way[3] * wrench[3] + way[4] * wrench[4] + way[5] * wrench[5]
            )  # fmt: skip
        along = chord[0, 0] * wrench[0] + chord[0, 1] * wrench[1] + chord[0, 2] * wrench[2]
        pull[branch.parent] += branch.axial_lever * along


def even_wind_moments(branches: Any, n_coordinates: int, *, carries: bool = True) -> Floats:
    """
    Moments of an even wind of 1 m/s and 1 kg/m^3, along x and along y, on the tree at rest.

    Parameters
    ----------
    branches
        Records of `BRANCH`, (b,).
    n_coordinates
        N.
    carries
        Whether what a branch carries pushes on it.

    Returns
    -------
    Floats
        In [N m], (N, 2).

    """
    moments, pull, rest = (
        np.zeros((2, n_coordinates)),
        np.zeros(len(branches)),
        np.zeros(n_coordinates),
    )
    for moment, (wx, wy) in zip(moments, np.eye(2), strict=True):
        work = np.zeros(len(branches), dtype=WORK)
        blow(branches, work, air_records(branches), rest, rest, wx, wy, 0.0, 1.0)
        gather(branches, work)
        generalised(branches, work, carries, moment, pull)
    return moments.T
