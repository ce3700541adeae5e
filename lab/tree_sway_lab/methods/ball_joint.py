# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The truth for a branch on two axes: a rod on a ball joint, as a unit vector in space.

With u the chord, b its rest direction and W the force times its lever in [N m]::

    I (u'' + |u'|^2 u) = W_t - k2 u' + k1 (theta / sin theta) b_t,   x_t = x - (x.u) u

A sphere has no chart here, hence none of the terms of `two_axis`: an independent statement of the
same mechanics. Integrated by the classical Runge-Kutta method at a fraction of the step.

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel

Array = NDArray[Any]


@kernel
def _acceleration(
    u: Array, v: Array, w: Array, inertia: float, damping: float, stiffness: float
) -> Array:
    sine = np.sqrt(u[1] * u[1] + u[2] * u[2])
    theta = np.arctan2(sine, u[0])
    pull = w.copy()
    pull[0] += stiffness * (theta / sine if sine > 1e-12 else 1.0)
    radial = pull[0] * u[0] + pull[1] * u[1] + pull[2] * u[2]
    speed = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    accel: Array = (pull - radial * u - damping * v) / inertia - speed * u
    return accel


@kernel
def swing(
    loads: Array, dt: float, inertia: float, damping: float, stiffness: float,
    e: Array, rate: Array, substeps: int,
) -> tuple[Array, Array]:  # fmt: skip
    """
    Swing under any loads, sampled as the method needs them.

    Parameters
    ----------
    loads
        W along b, e1, e2 in [N m]: (steps, 2 substeps + 1, 3), at the ends and middles of the
        substeps.
    dt
        Step between frames in [s].
    inertia, damping, stiffness
        I [kg m^2], k2 [N m s], k1 [N m].
    e, rate
        Rotation vector [rad], (2,), and the chord's velocity across b at the start [1/s], (2,);
        the latter is the vector's own rate only at rest position.
    substeps
        Runge-Kutta steps per frame.

    Returns
    -------
    chord, velocity
        Unit vector u and u' at each frame, (steps + 1, 3).

    """
    theta = np.sqrt(e[0] * e[0] + e[1] * e[1])
    sinc = np.sin(theta) / theta if theta > 0.0 else 1.0
    u = np.array([np.cos(theta), sinc * e[0], sinc * e[1]])
    v = np.array([0.0, rate[0], rate[1]])
    v -= (v[0] * u[0] + v[1] * u[1] + v[2] * u[2]) * u
    steps = len(loads)
    chord, velocity = np.empty((steps + 1, 3)), np.empty((steps + 1, 3))
    chord[0], velocity[0] = u, v
    h = dt / substeps
    for n in range(steps):
        for k in range(substeps):
            w0, w1, w2 = loads[n, 2 * k], loads[n, 2 * k + 1], loads[n, 2 * k + 2]
            a1 = _acceleration(u, v, w0, inertia, damping, stiffness)
            v2 = v + 0.5 * h * a1
            a2 = _acceleration(u + 0.5 * h * v, v2, w1, inertia, damping, stiffness)
            v3 = v + 0.5 * h * a2
            a3 = _acceleration(u + 0.5 * h * v2, v3, w1, inertia, damping, stiffness)
            v4 = v + h * a3
            a4 = _acceleration(u + h * v3, v4, w2, inertia, damping, stiffness)
            u = u + h / 6.0 * (v + 2.0 * (v2 + v3) + v4)
            v = v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)
            u /= np.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
            v -= (v[0] * u[0] + v[1] * u[1] + v[2] * u[2]) * u
        chord[n + 1], velocity[n + 1] = u, v
    return chord, velocity
