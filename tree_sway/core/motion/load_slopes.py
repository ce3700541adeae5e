# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Slopes of the wind load of a bent tree, by many shapes of motion in one pass.

`tree_passes` differentiated by hand. Each branch multiplies rows of numbers, one number per shape,
by small matrices: outward the motion of the bases, inward the change of the force and the moment
that each branch bears at its base. Where a force stays as it is and the tree below it turns, it
loads other coordinates than before: in a storm that part is as large as the other.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from tree_sway.core.arrays import fields_of, Floats, RecordsOf, Singles
from tree_sway.core.branch.shapes import MAX_COORDINATES
from tree_sway.core.kernel import inlined, kernel
from tree_sway.core.motion.records import Branch, Branches, LANES, Load, Loads, Work, Works
from tree_sway.core.rotation import turned


class Small:
    """Small matrices of one branch."""

    # Of a base: by the motion (v, w) of its parent's base, then by that one's coordinates.
    follow: Annotated[Floats, 6, 6]
    relative: Annotated[Floats, 6, MAX_COORDINATES]  # in the frame of the parent's base
    joint: Annotated[Floats, 6, MAX_COORDINATES]  # in its own frame
    borne: Annotated[Floats, 6, MAX_COORDINATES]  # change of what it hands on
    lever: Annotated[Floats, MAX_COORDINATES, MAX_COORDINATES]  # of what loads the coordinates
    # Of a branch: columns are the motion (v, w) of its base, then its own coordinates.
    ahead: Annotated[Floats, 3, 3]  # from the frame of its base to its own
    drag: Annotated[Floats, 3, 3]  # force per relative wind
    centre: Annotated[Floats, 3, 6 + MAX_COORDINATES]  # velocity of the load centre
    damped: Annotated[Floats, 3, 6 + MAX_COORDINATES]  # force by the rates
    seen: Annotated[Floats, 3, 6 + MAX_COORDINATES]  # how the branch turns
    force: Annotated[Floats, 3, 6 + MAX_COORDINATES]
    wrench: Annotated[Floats, 6, 6 + MAX_COORDINATES]  # force and moment about its base
    load: Annotated[Floats, MAX_COORDINATES, 6 + MAX_COORDINATES]


SCRATCH = np.dtype(fields_of(Small))


@kernel
def load_slopes(
    branches: Branches, work: Works, loads: Loads, shapes: Singles, scratch: RecordsOf[Small],
    rows: Singles, centres: Singles, forces: Singles, moments: Singles,
) -> None:  # fmt: skip
    """
    Find how the loads of a tree change as it moves by any of some shapes.

    Parameters
    ----------
    branches, work, loads
        As `modal.wind_moments` leaves them at 1 kg/m^3, where the tree does not move.
    shapes
        Key rotations of each shape, (N, m).
    scratch
        One record of `SCRATCH`.
    rows
        Room, (d, 12, m), for as many branches as carry one another.
    centres, forces
        Velocity of each load centre at which its force does work, and change of that force, by
        the rates of the shapes, (b, 3, m), both written.
    moments
        Change of the moments on the coordinates by the shapes, (N, m), written.

    """
    small, open_ones, top = scratch[0], np.zeros(len(rows), dtype=np.int64), -1
    _clear(moments)
    for b in range(len(branches)):
        branch = branches[b]
        while top >= 0 and open_ones[top] != branch.parent:
            _hand_on(branches, work, open_ones[top], shapes, small, rows, top, moments)
            top -= 1
        top += 1
        open_ones[top] = b
        of_base = rows[top, :6]
        _clear(rows[top])
        _clear(centres[b])
        _clear(forces[b])
        if top > 0:
            parent = branches[branch.parent]
            i, n = parent.coordinate, parent.n_coordinates
            _set_joint(branch, work[b], n, small)
            _add(small.follow[:, :6], rows[top - 1, :6], of_base)
            _add(small.joint[:, :n], shapes[i : i + n], of_base)
        i, n = branch.coordinate, branch.n_coordinates
        _set_own(branch, loads[b // LANES], b % LANES, small)
        own = shapes[i : i + n]
        _add_both(small.wrench[:, : 6 + n], of_base, own, rows[top, 6:])
        _add_both(small.centre[:, : 6 + n], of_base, own, centres[b])
        _add_both(small.damped[:, : 6 + n], of_base, own, forces[b])
        _add_both(small.load[:n, : 6 + n], of_base, own, moments[i : i + n])
    while top > 0:
        _hand_on(branches, work, open_ones[top], shapes, small, rows, top, moments)
        top -= 1


@kernel
def _hand_on(
    branches: Branches, work: Works, b: int, shapes: Singles, small: Small,
    rows: Singles, top: int, moments: Singles,
) -> None:  # fmt: skip
    """Add what all that a branch bears changes to what its parent bears, and to its moments."""
    parent, change = branches[branches[b].parent], rows[top, 6:]
    i, n = parent.coordinate, parent.n_coordinates
    _set_joint(branches[b], work[b], n, small)
    _set_borne(branches[b], work[b], n, small)
    moved, moment = shapes[i : i + n], moments[i : i + n]
    _add(small.follow[:, :6].T, change, rows[top - 1, 6:])
    _add(small.borne[:, :n], moved, rows[top - 1, 6:])
    _add(small.joint[:, :n].T, change, moment)
    _add(small.lever[:n, :n], moved, moment)


@kernel
def _clear(rows: Singles) -> None:
    for i in range(len(rows)):
        for k in range(rows.shape[1]):
            rows[i, k] = 0.0


@kernel
def _add(matrix: Floats, rows: Singles, into: Singles) -> None:
    """Add a small matrix (i, j) times rows (j, m) to rows (i, m)."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            share = np.float32(matrix[i, j])
            for k in range(rows.shape[1]):
                into[i, k] += share * rows[j, k]


@kernel
def _add_both(matrix: Floats, of_base: Singles, own: Singles, into: Singles) -> None:
    """Add what the motion of a base and the coordinates of its branch make."""
    _add(matrix[:, :6], of_base, into)
    _add(matrix[:, 6:], own, into)


@kernel
def _multiply(a: Floats, b: Floats, out: Floats) -> None:
    """Write the product of small matrices."""
    for i in range(a.shape[0]):
        for j in range(b.shape[1]):
            out[i, j] = 0.0
            for k in range(a.shape[1]):
                out[i, j] += a[i, k] * b[k, j]


@inlined
def _cross(a: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    return a[1] * z - a[2] * y, a[2] * x - a[0] * z, a[0] * y - a[1] * x


@kernel
def _cross_columns(a: Floats, b: Floats, out: Floats) -> None:
    """Write the cross product of a vector and each column of a matrix (3, n)."""
    for c in range(b.shape[1]):
        out[0, c], out[1, c], out[2, c] = _cross(a, b[0, c], b[1, c], b[2, c])


@kernel
def _set_turn(r: Floats, out: Floats) -> None:
    """Write the matrix (3, 3) that undoes a rotation vector."""
    out[0, 0], out[1, 0], out[2, 0] = turned(-r[0], -r[1], -r[2], 1.0, 0.0, 0.0)
    out[0, 1], out[1, 1], out[2, 1] = turned(-r[0], -r[1], -r[2], 0.0, 1.0, 0.0)
    out[0, 2], out[1, 2], out[2, 2] = turned(-r[0], -r[1], -r[2], 0.0, 0.0, 1.0)


@kernel
def _set_joint(branch: Branch, here: Work, n: int, small: Small) -> None:
    """Write how a base moves by its parent's base and each of its parent's coordinates."""
    turn, shift, arm = here.turn, here.shift, branch.arm
    follow, relative = small.follow, small.relative
    _set_turn(turn, follow[:3, :3])
    follow[3:, 3:] = follow[:3, :3]
    for i in range(3):
        x, y, z = _cross(here.arm, follow[i, 0], follow[i, 1], follow[i, 2])
        follow[i, 3], follow[i, 4], follow[i, 5] = x, y, z
    for c in range(n):
        row = branch.twist[c]
        x, y, z = _cross(branch.base, row[3], row[4], row[5])
        x, y, z = row[0] - x, row[1] - y, row[2] - z
        gone = 2.0 * branch.per_arm * (shift[0] * x + shift[1] * y + shift[2] * z)
        relative[0, c] = x - gone * arm[0]
        relative[1, c] = y - gone * arm[1]
        relative[2, c] = z - gone * arm[2]
        x, y, z = _cross(turn, row[3], row[4], row[5])
        ux, uy, uz = _cross(turn, x, y, z)
        relative[3, c] = row[3] + 0.5 * x + ux / 6.0
        relative[4, c] = row[4] + 0.5 * y + uy / 6.0
        relative[5, c] = row[5] + 0.5 * z + uz / 6.0
    _multiply(follow[:3, :3], relative[:3, :n], small.joint[:3, :n])
    _multiply(follow[:3, :3], relative[3:, :n], small.joint[3:, :n])


@kernel
def _set_borne(branch: Branch, here: Work, n: int, small: Small) -> None:
    """Write how what a base hands on, unchanged in its own frame, changes for its parent."""
    relative, borne, lever = small.relative, small.borne, small.lever
    back, wrench, now = small.follow[:3, :3], here.wrench, here.arm
    force, moment, aside = small.seen[:, 0], small.seen[:, 1], small.seen[:, 2]  # room
    for i in range(3):
        force[i] = moment[i] = 0.0
        for k in range(3):
            force[i] += back[k, i] * wrench[k]
            moment[i] += back[k, i] * wrench[3 + k]
    aside[0], aside[1], aside[2] = _cross(moment, here.turn[0], here.turn[1], here.turn[2])
    pull = (
        2.0
        * branch.per_arm
        * (branch.arm[0] * force[0] + branch.arm[1] * force[1] + branch.arm[2] * force[2])
    )
    for c in range(n):
        x, y, z = _cross(force, relative[3, c], relative[4, c], relative[5, c])
        borne[0, c], borne[1, c], borne[2, c] = -x, -y, -z
        x, y, z = _cross(moment, relative[3, c], relative[4, c], relative[5, c])
        borne[3, c], borne[4, c], borne[5, c] = -x, -y, -z
    for c in range(n):
        row = branch.twist[c]
        ux, uy, uz = _cross(branch.base, row[3], row[4], row[5])
        ux, uy, uz = row[0] - ux, row[1] - uy, row[2] - uz
        mx, my, mz = _cross(moment, row[3], row[4], row[5])
        x, y, z = _cross(here.turn, row[3], row[4], row[5])
        x, y, z = _cross(moment, x, y, z)
        vx, vy, vz = _cross(aside, row[3], row[4], row[5])
        mx, my, mz = mx + (x + vx) / 3.0, my + (y + vy) / 3.0, mz + (z + vz) / 3.0
        for d in range(n):
            other = branch.twist[d]
            x, y, z = _cross(branch.base, other[3], other[4], other[5])
            x, y, z = other[0] - x, other[1] - y, other[2] - z
            lever[c, d] = -pull * (ux * x + uy * y + uz * z)
            lever[c, d] -= 0.5 * (mx * other[3] + my * other[4] + mz * other[5])
            for k in range(6):
                lever[c, d] += relative[k, c] * borne[k, d]
    for c in range(n):
        x, y, z = _cross(force, relative[0, c], relative[1, c], relative[2, c])
        ux, uy, uz = _cross(now, borne[0, c], borne[1, c], borne[2, c])
        borne[3, c] += ux - x
        borne[4, c] += uy - y
        borne[5, c] += uz - z


@kernel
def _set_own(branch: Branch, loads: Load, j: int, small: Small) -> None:
    """Write what its own motion and that of its base change of the load of a branch itself."""
    n, ahead, drag, seen = branch.n_coordinates, small.ahead, small.drag, small.seen
    centre, damped, force, wrench = small.centre, small.damped, small.force, small.wrench
    turn, couple = loads.turned[:, j], loads.coupling[:, :, j]
    _set_turn(turn, ahead)
    for c in range(n):
        row = branch.load_rotation[c]
        x, y, z = _cross(turn, row[0], row[1], row[2])
        ux, uy, uz = _cross(turn, x, y, z)
        seen[0, 6 + c] = row[0] - 0.5 * x + ux / 6.0
        seen[1, 6 + c] = row[1] - 0.5 * y + uy / 6.0
        seen[2, 6 + c] = row[2] - 0.5 * z + uz / 6.0
    for i in range(3):
        for k in range(3):
            seen[i, k], seen[i, 3 + k], centre[i, k] = 0.0, ahead[i, k], ahead[i, k]
    _multiply(couple.T, ahead, centre[:, 3:6])
    wind, own = wrench[:3, 0], loads.own_force[:, j]
    for i in range(3):
        wind[i] = (
            ahead[i, 0] * loads.air[0, j] + ahead[i, 1] * loads.air[1, j]
            + ahead[i, 2] * loads.air[2, j]
        )  # fmt: skip
    _set_drag(loads.projector[:, j], loads.area[j], wind, drag)
    # A force by rates, and one by turning: the wind turns back by as much as the branch turns.
    for i in range(3):
        for c in range(n):
            centre[i, 6 + c] = -branch.damping_mode[c, i]
        for k in range(6):
            centre[i, k] = -centre[i, k]
    _multiply(drag, centre[:, : 6 + n], damped[:, : 6 + n])
    for i in range(3):
        for c in range(n):
            centre[i, 6 + c] = branch.load_mode[c, i]
        for k in range(6):
            centre[i, k] = -centre[i, k]
    _cross_columns(wind, seen[:, : 6 + n], wrench[3:, : 6 + n])
    _multiply(drag, wrench[3:, : 6 + n], force[:, : 6 + n])
    _multiply(branch.load_mode[:n], force[:, : 6 + n], small.load[:n, : 6 + n])
    # Of its base: its own force turns with it.
    _turn_wrench(couple, force[:, : 6 + n], seen, own, n, ahead, wrench)


@kernel
def _turn_wrench(
    couple: Floats, force: Floats, seen: Floats, own: Floats, n: int, ahead: Floats, wrench: Floats
) -> None:
    """Write the change of force and moment in the frame of the base, (6, 6 + n)."""
    for c in range(6 + n):
        fx, fy, fz = force[0, c], force[1, c], force[2, c]
        mx = couple[0, 0] * fx + couple[0, 1] * fy + couple[0, 2] * fz
        my = couple[1, 0] * fx + couple[1, 1] * fy + couple[1, 2] * fz
        mz = couple[2, 0] * fx + couple[2, 1] * fy + couple[2, 2] * fz
        if c >= 6:
            sx, sy, sz = seen[0, c], seen[1, c], seen[2, c]
            x, y, z = _cross(own, sx, sy, sz)
            fx, fy, fz = fx - x, fy - y, fz - z
            ux = couple[0, 0] * own[0] + couple[0, 1] * own[1] + couple[0, 2] * own[2]
            uy = couple[1, 0] * own[0] + couple[1, 1] * own[1] + couple[1, 2] * own[2]
            uz = couple[2, 0] * own[0] + couple[2, 1] * own[1] + couple[2, 2] * own[2]
            mx, my, mz = mx + sy * uz - sz * uy, my + sz * ux - sx * uz, mz + sx * uy - sy * ux
        for i in range(3):
            wrench[i, c] = ahead[0, i] * fx + ahead[1, i] * fy + ahead[2, i] * fz
            wrench[3 + i, c] = ahead[0, i] * mx + ahead[1, i] * my + ahead[2, i] * mz


@inlined
def _set_drag(p: Floats, area: float, u: Floats, out: Floats) -> None:
    """Write the slope of `drag` by the relative wind u, (3, 3)."""
    x = p[0] * u[0] + p[3] * u[1] + p[4] * u[2]
    y = p[3] * u[0] + p[1] * u[1] + p[5] * u[2]
    z = p[4] * u[0] + p[5] * u[1] + p[2] * u[2]
    speed = math.sqrt(max(u[0] * x + u[1] * y + u[2] * z, 0.0))
    whole, share = area * speed, area / max(speed, 1e-12)
    out[0, 0], out[1, 1], out[2, 2] = (
        whole * p[0] + share * x * x, whole * p[1] + share * y * y, whole * p[2] + share * z * z,
    )  # fmt: skip
    out[0, 1] = out[1, 0] = whole * p[3] + share * x * y
    out[0, 2] = out[2, 0] = whole * p[4] + share * x * z
    out[1, 2] = out[2, 1] = whole * p[5] + share * y * z
