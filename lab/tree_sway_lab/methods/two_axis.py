# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A branch on two axes: its force, its gyroscopic term and one guarded step of the exact propagator.

The state is the rotation vector (x, y) in [rad] in the branch's own rest frame (b along the chord,
e1 and e2 across): the chord points along ``u = cos|e| b + sinc|e| (x e1 + y e2)``. In steady wind
it moves in one plane, the paper's; in other winds it has no singular direction. With t = x^2 + y^2
and W the force times its lever, in [N m], Lagrange's equations on the sphere are::

    I (e'' - gyroscopic) + k2 e' + k1 e = true_force
    true_force = W_perp / sinc + e (e.W)(cos - 1 / sinc) / t - W_b sinc e
    gyroscopic = E L^2 e + 2 B L (-vy, vx),   L = x vy - y vx

The second line of the kinetic energy, T = I/2 (|v|^2 + (sinc^2 - 1) L^2 / t), is analytic in (x,
y), and so are its derivatives, which in this form have no division by t. With sinc = 1 + t s and
cos = 1 + t c: A = s + c + t s c, B = (s - c) / sinc, E = (A + 2 B) / t.

**Series.** s and c are polynomials in t (Chebyshev fits, degree 4 after their first term), with
errors up to 3e-9 within the guard; there is no root, sine or cosine. **Guard.** For these terms
(x, y) is clamped to sinc >= 0.3 (2.36 rad): beyond it they have their values on the circle. The
load is clamped to |W| <= s_max k1 (counted by the caller), the whole moment at 1.5 s_max k1, and
the gyroscopic term is left out where w h >= 0.5, where a step does not resolve the motion. A
bounded moment on an exact, stable propagator gives a bounded motion, for any wind and step. s_max
= 3 / (w h)^2 between 0.8 and 10: within it one corrector converges, and a steady load gives the
right angle; at 4 / (w h)^2 it does not.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import fused, part

Floats = NDArray[np.float64]

T_MAX = 5.5528  # square of the angle [rad^2] at which sinc = 0.3
LOAD_FINE, LOAD_COARSE = 10.0, 0.8  # bounds on it at long and at short steps
MOMENT_MARGIN = 1.5  # the whole moment is clamped to this number of times s_max k1
GYRO_STEP = 0.5  # w h from which the gyroscopic term is left out


@part
def within_guard(x: float, y: float) -> tuple[float, float, float]:
    """Return x, y and t, clamped to the circle of the guard."""
    t = x * x + y * y
    limit = T_MAX
    if t > limit:
        shrink = math.sqrt(limit / t)
        return x * shrink, y * shrink, limit
    return x, y, t


@part
def _series(t: float) -> tuple[float, float, float, float]:
    """Return s, c of the module's text, tails s', c' too: s = -1/6 + t s', c = -1/2 + t c'."""
    s = 1.5032424712277569e-10
    s = s * t - 2.5002780465942419e-8
    s = s * t + 2.7556346133638428e-6
    s = s * t - 1.9841263105038876e-4
    s = s * t + 8.3333333258591991e-3
    c = 1.9343564401159469e-9
    c = c * t - 2.7483756547269252e-7
    c = c * t + 2.4800137070434030e-5
    c = c * t - 1.3888878852585004e-3
    c = c * t + 4.1666666555315840e-2
    return s * t - 1.0 / 6.0, c * t - 0.5, s, c


@part
def true_force(x: float, y: float, wb: float, w1: float, w2: float) -> tuple[float, float]:
    """
    Generalised force [N m] on the two axes at any deflection; (w1, w2) at zero.

    Parameters
    ----------
    x, y
        Rotation vector in [rad].
    wb, w1, w2
        Force times lever along b, e1, e2 in [N m].

    """
    x, y, t = within_guard(x, y)
    s, c, _, _ = _series(t)
    one = 1.0
    sinc = one + t * s
    inverse = one / sinc
    along = (x * w1 + y * w2) * (s + c + t * s * c) * inverse - wb * sinc
    return w1 * inverse + x * along, w2 * inverse + y * along


@part
def gyroscopic(x: float, y: float, vx: float, vy: float) -> tuple[float, float]:
    """
    Acceleration [rad/s^2] of motion along great circles of the sphere at constant speed.

    It follows from the rotation vector [rad] and its rate [rad/s], and is zero for motion in one
    plane.
    """
    x, y, t = within_guard(x, y)
    s, c, s1, c1 = _series(t)
    one = 1.0
    two = 2.0
    three = 3.0
    inverse = one / (one + t * s)
    b = (s - c) * inverse
    e = (three * s1 - c1 + s * c + s * (s + c + t * s * c)) * inverse
    spin = x * vy - y * vx
    radial = e * spin * spin
    turn = two * b * spin
    return radial * x - turn * vy, radial * y + turn * vx


@part
def limit_load(wb: float, w1: float, w2: float, limit: float) -> tuple[float, float, float, int]:
    """
    Clamp the length of a load to a limit in [N m]; the last value is whether it was clamped.

    A load that is not a number, or whose square overflows, counts as clamped and becomes zero.
    """
    square = wb * wb + w1 * w1 + w2 * w2
    if square <= limit * limit:
        return wb, w1, w2, 0
    if not square < math.inf:
        none = 0.0
        return none, none, none, 1
    scale = limit / math.sqrt(square)
    return wb * scale, w1 * scale, w2 * scale, 1


@part
def moment(
    x: float, y: float, vx: float, vy: float, wb: float, w1: float, w2: float,
    gyro_inertia: float, limit: float,
) -> tuple[float, float]:  # fmt: skip
    """Return true force and gyroscopic term together in [N m], clamped to a limit."""
    mx, my = true_force(x, y, wb, w1, w2)
    ax, ay = gyroscopic(x, y, vx, vy)
    mx += gyro_inertia * ax
    my += gyro_inertia * ay
    square = mx * mx + my * my
    scale = limit / math.sqrt(square) if square > limit * limit else 1.0
    return mx * scale, my * scale


@part
def step_branch(
    x: float, y: float, vx: float, vy: float, wb: float, w1: float, w2: float,
    c0: float, c1: float, c2: float, c3: float, c4: float, c5: float, c6: float, c7: float,
    gyro_inertia: float, load_limit: float, moment_limit: float,
) -> tuple[float, float, float, float, int]:  # fmt: skip
    """
    Step one branch under a force that is constant over the step: predictor and corrector.

    Parameters
    ----------
    x, y, vx, vy
        Rotation vector in [rad] and its rate in [rad/s].
    wb, w1, w2
        Mean force over the step times lever, along b, e1, e2, in [N m].
    c0, c1, c2, c3, c4, c5, c6, c7
        Row of the branch in `oscillators.propagator`.
    gyro_inertia, load_limit, moment_limit
        Row of the branch in `guards`.

    Returns
    -------
    x, y, vx, vy, clamped
        State at the end of the step, and 1 where the load was clamped.

    """
    wb, w1, w2, clamped = limit_load(wb, w1, w2, load_limit)
    mx, my = moment(x, y, vx, vy, wb, w1, w2, gyro_inertia, moment_limit)
    px = c0 * x + c1 * vx + c2 * mx
    py = c0 * y + c1 * vy + c2 * my
    ux = c4 * x + c5 * vx + c6 * mx
    uy = c4 * y + c5 * vy + c6 * my
    mx, my = moment(
        px + c3 * mx, py + c3 * my, ux + c7 * mx, uy + c7 * my, wb, w1, w2,
        gyro_inertia, moment_limit,
    )  # fmt: skip
    return px + c3 * mx, py + c3 * my, ux + c7 * mx, uy + c7 * my, clamped


@fused
def fill_guards(
    inertia: Floats, stiffness: Floats, dt: float, load_max: float, out: Floats
) -> None:
    """
    Refill the guards in place, for a new step.

    Parameters
    ----------
    inertia, stiffness
        I in [kg m^2] and k1 in [N m], (n,).
    dt
        Time step in [s].
    load_max
        Largest load over stiffness at w h = 1 in [rad]: `LOAD_MAX`.
    out
        gyro_inertia in [kg m^2], load_limit and moment_limit in [N m], (n, 3). A branch without
        stiffness has no limits.

    """
    for row in range(len(inertia)):
        i = inertia[row]
        k = stiffness[row]
        square = k * dt * dt  # (w h)^2 I
        out[row, 0] = i if square < GYRO_STEP * GYRO_STEP * i else 0.0
        limit = math.inf
        if k > 0.0:
            limit = k * min(max(load_max * i / square, LOAD_COARSE), LOAD_FINE)
        out[row, 1] = limit
        out[row, 2] = MOMENT_MARGIN * limit
