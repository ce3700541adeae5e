# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The chain as the paper writes it: X, Y, theta of each centre of mass, constrained by multipliers.

::

    M v' = F - G^T lam,   v = q',   phi(q) = 0,   G = d phi / d q          (Kanda and Ohya, eq. 1)

phi_i = X_i - c_i u_i - X_(i-1) - (l - c)_(i-1) u_(i-1), u = (cos theta, sin theta): the root-side
node of a segment is the tip-side node of the one before. q, v and forces have 3n entries, X, Y,
theta a segment; phi and lam have 2n.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.minimal_form import joint

Array = NDArray[Any]


@kernel
def place(table: Array, theta: Array, omega: Array) -> tuple[Array, Array]:
    """Return coordinates and velocities that satisfy the constraints, from angles and rates."""
    n = len(table)
    q, v = np.empty(3 * n, theta.dtype), np.empty(3 * n, theta.dtype)
    x, y, vx, vy = 0.0 * theta[0], 0.0 * theta[0], 0.0 * theta[0], 0.0 * theta[0]
    for i in range(n):
        ux, uy, w = np.cos(theta[i]), np.sin(theta[i]), omega[i]
        c, length = table[i, 2], table[i, 3]
        q[3 * i], q[3 * i + 1], q[3 * i + 2] = x + c * ux, y + c * uy, theta[i]
        v[3 * i], v[3 * i + 1], v[3 * i + 2] = vx - c * uy * w, vy + c * ux * w, w
        x, y = x + length * ux, y + length * uy
        vx, vy = vx - length * uy * w, vy + length * ux * w
    return q, v


@kernel
def forces(table: Array, q: Array, v: Array, load: Array) -> Array:
    """Resultant F = P - K - R of the paper, (3n,)."""
    n = len(table)
    out = np.empty(3 * n, q.dtype)
    spring, damper = joint(table, 4, q[2::3]), joint(table, 5, v[2::3])
    for i in range(n):
        out[3 * i], out[3 * i + 1] = load[i, 0], load[i, 1]
        out[3 * i + 2] = -spring[i] - damper[i]
    return out


@kernel
def constraint(table: Array, q: Array) -> Array:
    """Gap phi at each node in [m], (2n,)."""
    n = len(table)
    out = np.empty(2 * n, q.dtype)
    x, y = 0.0 * q[0], 0.0 * q[0]
    for i in range(n):
        ux, uy = np.cos(q[3 * i + 2]), np.sin(q[3 * i + 2])
        c, rest = table[i, 2], table[i, 3] - table[i, 2]
        out[2 * i] = q[3 * i] - c * ux - x
        out[2 * i + 1] = q[3 * i + 1] - c * uy - y
        x, y = q[3 * i] + rest * ux, q[3 * i + 1] + rest * uy
    return out


@kernel
def jacobian(table: Array, q: Array) -> Array:
    """G = d phi / d q, (2n, 3n)."""
    n = len(table)
    g = np.zeros((2 * n, 3 * n), q.dtype)
    for i in range(n):
        ux, uy = np.cos(q[3 * i + 2]), np.sin(q[3 * i + 2])
        c, rest = table[i, 2], table[i, 3] - table[i, 2]
        g[2 * i, 3 * i] = 1.0
        g[2 * i + 1, 3 * i + 1] = 1.0
        g[2 * i, 3 * i + 2] = c * uy
        g[2 * i + 1, 3 * i + 2] = -c * ux
        if i < n - 1:
            g[2 * i + 2, 3 * i] = -1.0
            g[2 * i + 3, 3 * i + 1] = -1.0
            g[2 * i + 2, 3 * i + 2] = rest * uy
            g[2 * i + 3, 3 * i + 2] = -rest * ux
    return g


@kernel
def jacobian_rate(table: Array, q: Array, v: Array) -> Array:
    """d(G v) / d theta, (2n, n): times the angular velocities it is the gap's own acceleration."""
    n = len(table)
    out = np.zeros((2 * n, n), q.dtype)
    for i in range(n):
        w = v[3 * i + 2]
        ux, uy = np.cos(q[3 * i + 2]) * w, np.sin(q[3 * i + 2]) * w
        c, rest = table[i, 2], table[i, 3] - table[i, 2]
        out[2 * i, i], out[2 * i + 1, i] = c * ux, c * uy
        if i < n - 1:
            out[2 * i + 2, i], out[2 * i + 3, i] = rest * ux, rest * uy
    return out


@kernel
def multiplier_slope(table: Array, q: Array, lam: Array) -> Array:
    """d(G^T lam) / d theta: it is diagonal, (n,)."""
    n = len(table)
    out = np.empty(n, q.dtype)
    for i in range(n):
        ux, uy = np.cos(q[3 * i + 2]), np.sin(q[3 * i + 2])
        c, rest = table[i, 2], table[i, 3] - table[i, 2]
        fx, fy = c * lam[2 * i], c * lam[2 * i + 1]
        if i < n - 1:
            fx, fy = fx + rest * lam[2 * i + 2], fy + rest * lam[2 * i + 3]
        out[i] = fx * ux + fy * uy
    return out


@kernel
def add_masses(table: Array, factor: float, out: Array) -> None:
    """Add factor * M to the corner of a matrix."""
    for i in range(len(table)):
        for k in range(3):
            at, m = 3 * i + k, table[i, 0] if k < 2 else table[i, 1]
            out[at, at] = out[at, at] + factor * m


@kernel
def add_joints(table: Array, column: int, factor: float, out: Array) -> None:
    """Add factor times stiffness (column 4) or damping (5) to the corner of a matrix."""
    for i in range(len(table)):
        at, k = 3 * i + 2, factor * table[i, column]
        out[at, at] = out[at, at] + k
        if i > 0:
            out[at - 3, at - 3] = out[at - 3, at - 3] + k
            out[at, at - 3] = out[at, at - 3] - k
            out[at - 3, at] = out[at - 3, at] - k


@kernel
def saddle(table: Array, g: Array, factor: float) -> Array:
    """Matrix [[M, factor G^T], [G, 0]], (5n, 5n)."""
    n = len(table)
    a = np.zeros((5 * n, 5 * n), g.dtype)
    add_masses(table, 1.0, a)
    for row in range(2 * n):
        for col in range(3 * n):
            if g[row, col] != 0.0:
                a[3 * n + row, col] = g[row, col]
                a[col, 3 * n + row] = factor * g[row, col]
    return a


@kernel
def index1(
    table: Array, q: Array, v: Array, load: Array, alpha: float, beta: float
) -> tuple[Array, Array]:
    """
    Accelerations and multipliers from the twice differentiated constraint.

    ``phi'' + 2 alpha phi' + beta^2 phi = 0`` (Baumgarte 1972); alpha = beta = 0 leaves it bare.

    """
    n = len(table)
    g, rate = jacobian(table, q), jacobian_rate(table, q, v)
    rhs = np.empty((5 * n, 1), q.dtype)
    rhs[: 3 * n, 0] = forces(table, q, v, load)
    for row in range(2 * n):
        total = 0.0 * q[0]
        for i in range(n):
            if rate[row, i] != 0.0:
                total = total - rate[row, i] * v[3 * i + 2]
        rhs[3 * n + row, 0] = total
    if beta != 0.0:
        gap = constraint(table, q)
        for row in range(2 * n):
            speed = 0.0 * q[0]
            for col in range(3 * n):
                if g[row, col] != 0.0:
                    speed = speed + g[row, col] * v[col]
            rhs[3 * n + row, 0] = (
                rhs[3 * n + row, 0] - 2.0 * alpha * speed - beta * beta * gap[row]
            )
    solve(saddle(table, g, 1.0), rhs)
    return rhs[: 3 * n, 0].copy(), rhs[3 * n :, 0].copy()
