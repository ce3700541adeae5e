# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Inertia, centrifugal force and weight of a tree at the pose it has, in its own coordinates.

With p the middles of the segments, m their masses and ``J = dp/dq``, Lagrange's equations of the
tree are (Shabana 2020, *Dynamics of Multibody Systems*, chapter 3)

    M q'' + J' m (dJ/dt) q' = forces + J' m g,   M = J' m J.

All three are found by placing the tree: a column of J is the difference of two places of the
segments, and the centrifugal force the second difference along the motion. **Columns are renewed
in turn**, an eighth of them a step or more: M is a
product of a matrix with itself, and so is positive definite however old its columns are.

**No energy comes of it.** In truth the change of M and the centrifugal force do no work together.
So the rates are scaled to the kinetic energy that they had before a renewal, and what the
centrifugal force has along the motion is left out.

A step places the tree at some poses together: `HERE`, `AHEAD` and `BEHIND` along the motion, and
from `COLUMNS` on turned a little from here, each along one leading coordinate. From those behind
on, the places are then overwritten by the differences of which the products with J are taken.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import part
from tree_sway.core.run.dense import copy, dot, multiply, multiply_rows
from tree_sway.core.run.middles import Middles

LEADING = 120
"""
Largest number of coordinates whose inertia is that of the pose, others keep that at rest; of
models with a table.
"""

OLDEST, MOST_STEPS = 0.3, 8
"""
The largest rotation [rad] of a branch, and the largest number of steps, between two renewals of a
column.
"""

HERE, AHEAD, BEHIND, COLUMNS = 0, 1, 2, 3
"""Places of a step: here, a little ahead and behind along the motion, then those for columns."""

_COLUMN_TURN, _MOTION_TURN = 1e-5, 1e-2
"""Largest key rotation [rad] of the differences for a column, and along the motion."""


class PoseInertia(NamedTuple):
    """
    Inertia of the q leading coordinates at a pose, relative to that at rest.

    The first fields are its state, the last scratch memory.
    """

    columns: Floats
    """J of all coordinates, times the square roots of the masses, (m, 3 n)."""
    change: Floats
    """M less that at rest, which is 1, (q, q)."""
    weight: Floats
    """Force of the weight beyond that which is linear in the coordinates, (q,)."""
    directions: Floats
    """Key rotations per unit of each coordinate, (m, N)."""
    steps: Floats
    """Amount of each coordinate for the difference of its column, (m,)."""
    columns_at_rest: Floats
    """The columns at rest, (m, 3 n)."""
    factor: Floats
    """Cholesky factor of the inertia of the middles at rest, (q, q)."""
    weight_at_rest: Floats
    """Force of the weight at rest on the leading coordinates, (q,)."""
    slopes: Floats
    """Derivative of this force by each coordinate, at rest, (q, m)."""
    gravity: Floats
    """Gravity on each middle over its factor, (3 n,)."""
    place_at_rest: Floats
    """The middles at rest, (3 n,)."""
    force_at_rest: Floats
    """Force of the weight at rest on the model's coordinates, (m,)."""
    all_slopes: Floats
    """Derivative of this force by each coordinate, at rest, (m, m)."""
    turned: Floats
    """Key rotations of the places of a step, (m + 3, N)."""
    placed: Floats
    """Middles at these, (m + 3, 3 n)."""
    products: Floats
    """Products of the columns with the bend of the motion, then with each new one, (m + 1, q)."""
    momentum: Floats
    """Scratch memory, (q,)."""
    sloped: Floats
    """Scratch memory, (m,)."""


def inertia_at_rest(
    middles: Middles, shapes: Floats, gravity: Floats, weight_slopes: Floats, q: int
) -> PoseInertia:
    """
    Find the inertia of a tree at rest.

    Parameters
    ----------
    middles
        Places the tree.
    shapes
        Key rotations per unit of each coordinate, (N, m), of which the first q are leading.
    gravity
        Gravity on each of the `Middles` over its factor, (3 n,).
    weight_slopes
        Derivative of the weight's force on the coordinates by each of them, at rest, (m, m).
    q
        Number of leading coordinates.

    """
    n_rotations, m = shapes.shape
    at_rest = _columns_at_rest(middles, shapes)
    # The model's coordinates have unit mass, that of its points to some percent.
    factor = np.asarray(np.linalg.cholesky(at_rest[:q] @ at_rest[:q].T), dtype=np.float64)
    unit = np.linalg.inv(factor)
    directions = shapes.T.copy()
    columns = at_rest.copy()
    directions[:q] = unit @ directions[:q]
    columns[:q] = unit @ columns[:q]
    return PoseInertia(
        columns=columns.copy(),
        change=np.zeros((q, q)),
        weight=np.zeros(q),
        directions=directions,
        steps=_COLUMN_TURN / np.maximum(np.abs(directions).max(axis=1), 1e-300),
        columns_at_rest=columns,
        factor=factor,
        weight_at_rest=columns[:q] @ gravity,
        slopes=unit @ weight_slopes[:q],
        gravity=gravity,
        place_at_rest=middles.at(np.zeros(n_rotations)),
        force_at_rest=at_rest @ gravity,
        all_slopes=np.ascontiguousarray(weight_slopes),
        turned=np.zeros((m + COLUMNS, n_rotations)),
        placed=np.zeros((m + COLUMNS, len(gravity))),
        products=np.zeros((m + 1, q)),
        momentum=np.zeros(q),
        sloped=np.zeros(m),
    )


def _columns_at_rest(middles: Middles, shapes: Floats) -> Floats:
    """Find J at rest by central differences, (m, 3 n)."""
    columns = []
    for shape in shapes.T:
        turn = _COLUMN_TURN / max(float(np.abs(shape).max()), 1e-300)
        apart = middles.at(turn * shape) - middles.at(-turn * shape)
        columns.append(apart / (2.0 * turn))
    return np.array(columns)


def return_to_rest(pose: PoseInertia) -> None:
    """Take the inertia of the tree at rest."""
    pose.columns[:] = pose.columns_at_rest
    pose.change[:] = 0.0
    pose.weight[:] = 0.0


@part
def columns_due(pose: PoseInertia, turned: float) -> int:
    """Return how many columns to renew after a branch has rotated by an angle [rad]."""
    share = min(max(turned / OLDEST, 1.0 / MOST_STEPS), 1.0)
    return math.ceil(share * len(pose.columns))


@part
def turn_for_columns(pose: PoseInertia, first: int, count: int) -> None:
    """Turn the tree a little from here along each of the next coordinates."""
    for k in range(count):
        row = (first + k) % len(pose.columns)
        turned = pose.turned[COLUMNS + k]
        np.multiply(pose.directions[row], pose.steps[row], turned)
        turned += pose.turned[HERE]


@part
def turn_along(pose: PoseInertia, rotation_rates: Floats, fastest: float) -> float:
    """
    Turn the tree a little ahead and behind along a motion; returns the time [s] to there.

    Rates of the key rotations are (N,) in [rad/s], ``fastest`` is the largest.
    """
    step = _MOTION_TURN / fastest if fastest > 0.0 else 0.0
    here = pose.turned[HERE]
    ahead = pose.turned[AHEAD]
    behind = pose.turned[BEHIND]
    np.multiply(rotation_rates, step, ahead)
    np.subtract(here, ahead, behind)
    ahead += here
    return step


@part
def twice_kinetic_energy(pose: PoseInertia, rate: Floats, momentum: Floats) -> float:
    """Return twice the kinetic energy [J] of rates (m,), and write the momentum, (q,)."""
    leading = rate[: len(momentum)]
    multiply(pose.change, leading, momentum)
    momentum += leading
    others = rate[len(momentum) :]
    return dot(leading, momentum) + dot(others, others)


@part
def renew_columns(pose: PoseInertia, first: int, count: int, eta: Floats, rate: Floats) -> None:
    """
    Take the next columns, inertia and weight of a pose, where the tree is placed.

    Parameters
    ----------
    pose
        The inertia.
    first, count
        First column to renew, and how many.
    eta
        Coordinates of the pose, (m,).
    rate
        Rates of the coordinates, (m,), scaled to the kinetic energy that they had before.

    """
    before = twice_kinetic_energy(pose, rate, pose.momentum)
    _take_columns(pose, first, count, eta)
    after = twice_kinetic_energy(pose, rate, pose.momentum)
    if after > 0.0:
        rate *= math.sqrt(before / after)


@part
def _take_columns(pose: PoseInertia, first: int, count: int, eta: Floats) -> None:
    """Take columns, inertia and weight of `renew_columns`, and the bend along the motion."""
    q = len(pose.change)
    here = pose.placed[HERE]
    bend = pose.placed[BEHIND]
    bend += pose.placed[AHEAD]
    bend -= here
    bend -= here
    new = pose.placed[COLUMNS : COLUMNS + count]
    for k in range(count):
        row = (first + k) % len(pose.columns)
        column = new[k]
        column -= here
        column /= pose.steps[row]
        copy(column, pose.columns[row])
    rows = pose.placed[BEHIND : COLUMNS + count]
    products = pose.products[: 1 + count]
    multiply_rows(rows, pose.columns[:q], products)
    for k in range(count):
        row = (first + k) % len(pose.columns)
        if row < q:
            for j in range(q):
                pose.change[row, j] = pose.change[j, row] = products[1 + k, j]
            linear = pose.weight_at_rest[row] + dot(pose.slopes[row], eta)
            pose.weight[row] = dot(new[k], pose.gravity) - linear
    for k in range(count):
        row = (first + k) % len(pose.columns)
        if row < q:
            pose.change[row, row] -= 1.0


@part
def load_of_forces(pose: PoseInertia, force: Floats, load: Floats) -> None:
    """
    Write the work (m,) that forces do per unit of each coordinate.

    Forces on the segments are over the square roots of their masses, (3 n,).
    """
    multiply(pose.columns, force, load)
    for i in range(len(pose.factor) - 1, -1, -1):
        load[i] = dot(pose.factor[i, : i + 1], load[: i + 1])


@part
def centrifugal_force(
    pose: PoseInertia, rate: Floats, step: float, force: Floats, along: Floats
) -> None:
    """
    Find ``-J' m (dJ/dt) q'`` but for what does work on the motion.

    Parameters
    ----------
    pose
        The inertia, after `renew_columns` with the tree placed ahead and behind.
    rate
        Rates of the coordinates, (m,).
    step
        Time [s] from here to the place ahead.
    force, along
        The force, and the momentum over twice the kinetic energy, both (q,), written.

    """
    energy = twice_kinetic_energy(pose, rate, along)
    if not (step > 0.0 and energy > 0.0):
        force[:] = 0.0
        along[:] = 0.0
        return
    np.multiply(pose.products[0], -1.0 / (step * step), force)
    along /= energy
    working = dot(force, rate[: len(force)])
    for i in range(len(force)):
        force[i] -= working * along[i]


@part
def weight_potential(pose: PoseInertia, eta: Floats) -> float:
    """Energy [J] of the weight beyond that which the stiffness has, at coordinates (m,), here."""
    multiply(pose.all_slopes, eta, pose.sloped)
    linear = dot(pose.force_at_rest, eta) + 0.5 * dot(eta, pose.sloped)
    fallen = dot(pose.gravity, pose.placed[HERE]) - dot(pose.gravity, pose.place_at_rest)
    return linear - fallen
