"""
One pass out and one pass home: how branches ride on each other, and what they hand to each other.

Out, from the stem to the twigs: each base takes over the motion of its parent. On the way the wind's force on each branch is
found, in the air that passes it. Home, from the twigs to the stem: each branch adds up force and moment of all it carries.

"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.layout import WORK
from tree_sway_ros.core.rotation import turned
from tree_sway_ros.core.tree import Floats
from tree_sway_ros.core.wind_load import drag


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
        for k in range(6):
            here.velocity[k] = below.velocity[k]
        for k in range(3):
            here.rotation[k] = below.rotation[k]
        for c in range(parent.n_coordinates):
            rate, angle = v[i + c], x[i + c]
            for k in range(6):
                here.velocity[k] += twist[c, k] * rate
            for k in range(3):
                here.rotation[k] += twist[c, 3 + k] * angle


@fused
def blow(
    branches: Any, work: Any, x: Floats, v: Floats, wx: float, wy: float, wz: float, per_speed_squared: float
) -> None:
    """
    Find the wind's force on every branch.

    Parameters
    ----------
    branches, work
        Records of `BRANCH` and `WORK`, (b,); the slip of the latter is read as that of the last step; force and slip are written.
    x, v
        Key rotations and rates half a step on, under the last step's forces, (N,).
    wx, wy, wz
        Mean wind over the step in [m/s].
    per_speed_squared
        `pressure` of the wind in [kg/m^3].

    """
    for b in range(len(branches)):
        branch, here = branches[b], work[b]
        if branch.source != b:
            for k in range(3):
                here.force[k] = work[branch.source].force[k]
            continue
        centre, velocity, force, slip = branch.centre, here.velocity, here.force, here.slip
        mx = velocity[0] + velocity[4] * centre[2] - velocity[5] * centre[1]
        my = velocity[1] + velocity[5] * centre[0] - velocity[3] * centre[2]
        mz = velocity[2] + velocity[3] * centre[1] - velocity[4] * centre[0]
        tx, ty, tz = here.rotation[0], here.rotation[1], here.rotation[2]
        for c in range(branch.n_coordinates):
            rate, angle = v[branch.coordinate + c], x[branch.coordinate + c]
            mx += branch.flow[c, 0] * rate
            my += branch.flow[c, 1] * rate
            mz += branch.flow[c, 2] * rate
            tx += branch.turn[c, 0] * angle
            ty += branch.turn[c, 1] * angle
            tz += branch.turn[c, 2] * angle
        ux, uy, uz = branch.speed * wx - mx, branch.speed * wy - my, branch.speed * wz - mz
        ux, uy, uz = turned(-tx, -ty, -tz, ux, uy, uz)
        beta = branch.compliance
        ux, uy, uz = ux + beta * slip[0], uy + beta * slip[1], uz + beta * slip[2]
        fx, fy, fz, f = drag(branch, per_speed_squared, ux, uy, uz)
        slip[0], slip[1], slip[2] = f * ux, f * uy, f * uz
        force[0], force[1], force[2] = turned(tx, ty, tz, fx, fy, fz)


@fused
def gather(branches: Any, work: Any) -> None:
    """Add up, from the twigs to the stem, force and moment about the root of all that each branch carries."""
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
        turn, force, chord = here.rotation, here.force, branch.frame
        fx, fy, fz = turned(-turn[0], -turn[1], -turn[2], force[0], force[1], force[2])
        i = branch.coordinate
        for c in range(branch.n_coordinates):
            moment[i + c] = branch.push[c, 0] * fx + branch.push[c, 1] * fy + branch.push[c, 2] * fz
        pull[b] = branch.lever * (chord[0, 0] * fx + chord[0, 1] * fy + chord[0, 2] * fz)
    if not carries:
        return
    for b in range(1, len(branches)):
        branch, wrench = branches[b], work[b].wrench
        parent = branches[branch.parent]
        i, chord = parent.coordinate, parent.frame
        for c in range(parent.n_coordinates):
            total = 0.0
            for k in range(6):
                total += branch.twist[c, k] * wrench[k]
            moment[i + c] += total
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
    moments, pull, rest = np.zeros((2, n_coordinates)), np.zeros(len(branches)), np.zeros(n_coordinates)
    for moment, (wx, wy) in zip(moments, np.eye(2), strict=True):
        work = np.zeros(len(branches), dtype=WORK)
        blow(branches, work, rest, rest, wx, wy, 0.0, 1.0)
        gather(branches, work)
        generalised(branches, work, carries, moment, pull)
    return moments.T
