# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A step of oscillators that an inertia beyond their own couples.

Each coordinate has the mass 1 and moves exactly, as an oscillator of its own, under a force f that
is constant over the step of length h (`ModalCoordinates`). What the inertia M has beyond 1 is a
part of that force, by the mean acceleration over the step:

    f = F - (M - 1) (v1 - v0) / (h T),   v1 = v1(q0, v0, f),   T = tan(w h / 2) / (w h / 2),

which is linear in f. As ``q1 - q0 = h T (v0 + v1) / 2`` for a coordinate of the circular frequency
w, this f does exactly the work that ``v' (M - 1) v / 2`` loses: with a constant M, no step of any
length makes energy. With the acceleration u that f makes, as unknown, the matrix is symmetric and
positive definite:

    (k + M - 1 + D) u = T F - (M - 1) a + D u0,   k = T f / u >= 1,   D = h B / 2

with a the mean acceleration without f, and u0 that of the last step: the drag is implicit by the
damping B of the air, for F was found at the rates which the last step's force predicts. B is
``S M S``, S the roots of the damping of each coordinate at rest: a motion that hardly moves the
bent tree is hardly damped there. With more damping than that its force would follow late, and
feed it.

A force s that is at right angles to the motion v in the middle, as the centrifugal, would lengthen
v if it were constant. It turns with the motion instead, as ``G (v0 + v1) / 2`` with the
antisymmetric ``G = s r' - r s'``, ``r = M v / (v' M v)``, so that ``G v = s``, and does no work.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.kernel import part
from tree_sway.core.run.dense import dot, multiply, solve_positive, take_block
from tree_sway.core.run.table_model import middle_of_step, Propagators

FASTEST = 2.5
"""
Largest angle [rad] by which a coordinate swings in a step with more inertia than its own: T is
infinite at half a turn.
"""


class CoupledStep(NamedTuple):
    """
    Coefficients of a step, and scratch memory.

    A coordinate moves by its coefficients c of a step, (6, m), to ``c0 q + c1 v + c2 f``, at a
    rate of ``c3 q + c4 v + c5 f``. Of the m coordinates c are coupled.
    """

    length: float
    """Length of the step, h, in [s]."""
    half: Floats
    """Coefficients of half a step, (6, m)."""
    whole: Floats
    """Coefficients of the step, (6, m)."""
    coupled: Ints
    """Numbers of the coupled coordinates, (c,)."""
    stretch: Floats
    """T of these, (c,)."""
    per_force: Floats
    """Acceleration u of these by a force, (c,)."""
    own: Floats
    """k of these, (c,)."""
    root_damping: Floats
    """S of these times the root of ``h / 2``, for a drag of 1, (c,)."""
    own_damping: Floats
    """D of each coordinate by itself at rest, for a drag of 1, (m,)."""
    matrix: Floats
    """Matrix of the equation above, (c, c)."""
    rights: Floats
    """Right-hand sides of this equation, then its solutions, (3, c)."""
    products: Floats
    """Scratch memory, (7, c)."""


def coupled_step(
    over: Propagators, damping: Floats, leading: int, length: float
) -> CoupledStep:
    """
    Find the coefficients of a step.

    Parameters
    ----------
    over
        Coordinates, with the propagators of this step.
    damping
        Damping of each coordinate by the air at rest for a drag of 1, (m,).
    leading
        Number of coordinates that may be coupled.
    length
        Length of the step, h, in [s].

    """
    whole = over.whole.T[[0, 1, 2, 4, 5, 6]]
    whole[[2, 5]] += over.whole.T[[3, 7]]
    angle = np.sqrt(over.stiffness[:leading]) * length
    coupled = np.flatnonzero(angle < FASTEST)
    half_angle = np.maximum(0.5 * angle[coupled], 1e-12)
    stretch = np.tan(half_angle) / half_angle
    per_force = whole[5][coupled] / length
    count = len(coupled)
    return CoupledStep(
        length,
        half=np.ascontiguousarray(middle_of_step(over, length)),
        whole=np.ascontiguousarray(whole),
        coupled=coupled,
        stretch=stretch,
        per_force=per_force,
        own=stretch / per_force,
        root_damping=np.sqrt(0.5 * length * damping[coupled]),
        own_damping=0.5 * damping * whole[5],
        matrix=np.zeros((count, count)),
        rights=np.zeros((3, count)),
        products=np.zeros((7, count)),
    )


@part
def move(
    coefficients: Floats, eta: Floats, rate: Floats, force: Floats, moved: Floats, faster: Floats
) -> None:
    """Write coordinates and rates after a step or half of it under a force, all (m,)."""
    c = coefficients
    for i in range(len(eta)):
        q = eta[i]
        v = rate[i]
        f = force[i]
        moved[i] = c[0, i] * q + c[1, i] * v + c[2, i] * f
        faster[i] = c[3, i] * q + c[4, i] * v + c[5, i] * f


@part
def find_force(
    law: CoupledStep, wanted: Floats, eta: Floats, rate: Floats, last: Floats, change: Floats,
    drag: float, across: Floats, momentum: Floats, found: Floats,
) -> None:  # fmt: skip
    """
    Find the constant force of the step.

    Parameters
    ----------
    law
        Coefficients of the step.
    wanted
        Force F at the middle of the step, (m,).
    eta, rate, last
        Coordinates and rates before the step, and the force of the last one, (m,).
    change
        Inertia of the leading coordinates beyond their own, M - 1, (q, q).
    drag
        Drag of the air on the coordinates, a factor of their damping.
    across, momentum
        Force s at right angles to the motion, and r, (q,) both.
    found
        The force, (m,), written.

    """
    for i in range(len(found)):
        own_drag = drag * law.own_damping[i]
        found[i] = (wanted[i] + own_drag * last[i]) / (1.0 + own_drag)

    free, last_pull, turning, along = _sides(law, wanted, eta, rate, last, across, momentum)
    take_block(change, law.coupled, law.matrix)
    inertial = law.products[2]
    dragged = law.products[3]
    rooted = law.products[6]
    multiply(law.matrix, free, inertial)
    root = law.root_damping
    right = law.rights[0]
    np.multiply(root, last_pull, rooted)
    multiply(law.matrix, rooted, dragged)
    for k in range(len(right)):
        right[k] += drag * root[k] * (dragged[k] + rooted[k]) - inertial[k]
        for j in range(len(right)):
            law.matrix[k, j] *= 1.0 + drag * root[k] * root[j]
        law.matrix[k, k] += law.own[k] + drag * root[k] * root[k]
    if solve_positive(law.matrix, law.rights):
        _turn_with_motion(law, turning, along)
        for k in range(len(right)):
            found[law.coupled[k]] = right[k] / law.per_force[k]


@part
def _sides(
    law: CoupledStep, wanted: Floats, eta: Floats, rate: Floats, last: Floats, across: Floats,
    momentum: Floats,
) -> tuple[Floats, Floats, Floats, Floats]:  # fmt: skip
    """
    Write the right-hand sides without inertia and drag.

    Returns the accelerations without force, those by the last force, s and r, each (c,).
    """
    half = 0.5 * law.length
    whole = law.whole
    free = law.products[0]
    last_pull = law.products[1]
    turning = law.products[4]
    along = law.products[5]
    right = law.rights[0]
    by_turning = law.rights[1]
    by_along = law.rights[2]
    turning_rate = 0.0
    along_rate = 0.0
    for k in range(len(right)):
        i = law.coupled[k]
        free[k] = (whole[3, i] * eta[i] + (whole[4, i] - 1.0) * rate[i]) / law.length
        last_pull[k] = law.per_force[k] * last[i]
        turning[k] = by_turning[k] = across[i]
        along[k] = by_along[k] = momentum[i]
        steered = rate[i] + half * free[k]
        turning_rate += turning[k] * steered
        along_rate += along[k] * steered
    for k in range(len(right)):
        forced = law.stretch[k] * wanted[law.coupled[k]]
        right[k] = forced + turning[k] * along_rate - along[k] * turning_rate
    return free, last_pull, turning, along


@part
def _turn_with_motion(law: CoupledStep, turning: Floats, along: Floats) -> None:
    """Add ``h G / 2``, of rank two, to the solved equation by Woodbury's formula."""
    half = 0.5 * law.length
    solved = law.rights[0]
    by_turning = law.rights[1]
    by_along = law.rights[2]
    # The matrix of two that is left, and its right-hand sides.
    one_one = 1.0 - half * dot(along, by_turning)
    one_two = half * dot(along, by_along)
    two_one = -half * dot(turning, by_turning)
    two_two = 1.0 + half * dot(turning, by_along)
    one = dot(along, solved)
    two = dot(turning, solved)
    determinant = one_one * two_two - one_two * two_one
    share_along = (two_two * one - one_two * two) / determinant
    share_turning = (one_one * two - two_one * one) / determinant
    for k in range(len(solved)):
        solved[k] += half * (by_turning[k] * share_along - by_along[k] * share_turning)
