# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The chain in its own angles: the paper's equation with the multipliers eliminated.

For one segment ``I theta'' + k2 theta' + k1 theta = c (Py cos theta - Px sin theta)``; for a
chain, with A_ij = l_i (m_j c_j + l_j * mass beyond j) for i < j and the moments of inertia about
the nodes on the diagonal::

    sum_j A_ij (cos(theta_i - theta_j) theta_j'' + sin(theta_i - theta_j) theta_j'^2)
        + K theta + C theta' = n_i . (c_i P_i + l_i * sum of P beyond i),   n = (-sin, cos)

"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve

Array = NDArray[Any]


@kernel
def moments(table: Array, theta: Array, load: Array) -> Array:
    """Moment of the loads about each node in [N m], (n,); load (n, 2) in [N]."""
    n = len(table)
    out = np.empty(n, theta.dtype)
    px, py = load[n - 1, 0] * 0.0, load[n - 1, 1] * 0.0
    for i in range(n - 1, -1, -1):
        c, length = table[i, 2], table[i, 3]
        fx, fy = c * load[i, 0], c * load[i, 1]
        if i < n - 1:
            px, py = px + load[i + 1, 0], py + load[i + 1, 1]
            fx, fy = fx + length * px, fy + length * py
        out[i] = fy * np.cos(theta[i]) - fx * np.sin(theta[i])
    return out


@kernel
def _moment_slope(table: Array, theta: Array, load: Array) -> Array:
    """Return the derivative of each moment by its angle in [N m / rad], (n,)."""
    return moments(table, theta + 0.5 * np.pi, load)


@kernel
def joint(table: Array, column: int, angle: Array) -> Array:
    """Product of the stiffness (column 4) or damping (5) matrix with angles or rates, (n,)."""
    n = len(table)
    out = np.empty(n, angle.dtype)
    for i in range(n):
        twist = angle[i] - angle[i - 1] if i > 0 else angle[i]
        out[i] = table[i, column] * twist
        if i > 0:
            out[i - 1] = out[i - 1] - out[i]
    return out


@kernel
def coupling(table: Array) -> Array:
    """Matrix A of the module's text, (n, n)."""
    n = len(table)
    a = np.empty((n, n), table.dtype)
    beyond = 0.0 * table[0, 0]
    for j in range(n - 1, -1, -1):
        m, c, length = table[j, 0], table[j, 2], table[j, 3]
        a[j, j] = table[j, 1] + m * c * c
        first = m * c
        if j < n - 1:
            a[j, j] = a[j, j] + length * length * beyond
            first = first + length * beyond
        for i in range(j):
            a[i, j] = table[i, 3] * first
            a[j, i] = a[i, j]
        beyond = beyond + m
    return a


@kernel
def acceleration(table: Array, theta: Array, omega: Array, load: Array) -> Array:
    """Angular accelerations in [rad/s^2], (n,)."""
    n = len(table)
    a = coupling(table)
    rhs = np.empty((n, 1), theta.dtype)
    force, spring = moments(table, theta, load), joint(table, 4, theta)
    damper = joint(table, 5, omega)
    for i in range(n):
        rhs[i, 0] = force[i] - spring[i] - damper[i]
        for j in range(n):
            if j != i:
                turn = theta[i] - theta[j]
                rhs[i, 0] = rhs[i, 0] - a[i, j] * np.sin(turn) * omega[j] * omega[j]
                a[i, j] = a[i, j] * np.cos(turn)
    solve(a, rhs)
    return rhs[:, 0].copy()


@kernel
def linearised(table: Array, theta: Array, omega: Array, load: Array) -> Array:
    """Return accelerations and their derivatives: columns a, da/dtheta, da/domega, (n, 1 + 2n)."""
    n = len(table)
    accel = acceleration(table, theta, omega, load)
    a = coupling(table)
    out = np.empty((n, 1 + 2 * n), theta.dtype)
    slope = _moment_slope(table, theta, load)
    for i in range(n):
        for j in range(1 + 2 * n):
            out[i, j] = 0.0
    for i in range(n):
        out[i, 1 + i] = slope[i]
        for column in (4, 5):
            at = 1 + (column - 4) * n
            k = table[i, column]
            out[i, at + i] = out[i, at + i] - k
            if i > 0:
                out[i, at + i - 1] = out[i, at + i - 1] + k
                out[i - 1, at + i] = out[i - 1, at + i] + k
                out[i - 1, at + i - 1] = out[i - 1, at + i - 1] - k
        for j in range(n):
            if j != i:
                turn = theta[i] - theta[j]
                s, c = a[i, j] * np.sin(turn), a[i, j] * np.cos(turn)
                term = c * omega[j] * omega[j] - s * accel[j]
                out[i, 1 + i] = out[i, 1 + i] - term
                out[i, 1 + j] = out[i, 1 + j] + term
                out[i, 1 + n + j] = out[i, 1 + n + j] - 2.0 * s * omega[j]
                a[i, j] = c
    solve(a, out[:, 1:])
    for i in range(n):
        out[i, 0] = accel[i]
    return out


@kernel
def reactions(table: Array, theta: Array, omega: Array, load: Array) -> Array:
    """
    Force that each joint carries, the paper's multipliers, in [N], (n, 2).

    Sum of load minus mass times acceleration over the segments from the joint outwards.

    """
    n = len(table)
    accel = acceleration(table, theta, omega, load)
    out = np.empty((n, 2), theta.dtype)
    ax, ay = 0.0 * theta[0], 0.0 * theta[0]
    for i in range(n):
        cos, sin = np.cos(theta[i]), np.sin(theta[i])
        tangent, centre = accel[i], omega[i] * omega[i]
        bx, by = -sin * tangent - cos * centre, cos * tangent - sin * centre
        m, c, length = table[i, 0], table[i, 2], table[i, 3]
        out[i, 0] = load[i, 0] - m * (ax + c * bx)
        out[i, 1] = load[i, 1] - m * (ay + c * by)
        ax, ay = ax + length * bx, ay + length * by
    for i in range(n - 2, -1, -1):
        out[i, 0] = out[i, 0] + out[i + 1, 0]
        out[i, 1] = out[i, 1] + out[i + 1, 1]
    return out
