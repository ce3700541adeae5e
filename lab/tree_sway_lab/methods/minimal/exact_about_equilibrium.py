# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The exact propagator about the equilibrium of the step's mean load."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import exponential, solve
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal_form import acceleration, linearised

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Find the equilibrium, move exactly about it, correct for the curvature that is left."""
    n = len(table)
    mean = (load[0] + load[1]) * 0.5
    centre, still = state[0].copy(), state[0] * 0.0
    matrix, rhs = np.empty((n, n), state.dtype), np.empty((n, 1), state.dtype)
    for _ in range(4):
        lin = linearised(table, centre, still, mean)
        for i in range(n):
            rhs[i, 0] = -lin[i, 0]
            for j in range(n):
                matrix[i, j] = lin[i, 1 + j]
        if not solve(matrix, rhs):
            break
        for i in range(n):
            centre[i] = centre[i] + min(max(rhs[i, 0], -0.5), 0.5)
    lin = linearised(table, centre, still, mean)
    a = np.zeros((2 * n + 2, 2 * n + 2), state.dtype)
    first = _remainder(table, lin, centre, state[0], state[1], load[0])
    for i in range(n):
        a[i, n + i] = dt
        for j in range(2 * n):
            a[n + i, j] = dt * lin[i, 1 + j]
    guess = _advance(a, state, centre, first, first, dt)
    last = _remainder(table, lin, centre, guess[0], guess[1], load[1])
    state[:2] = _advance(a, state, centre, first, last, dt)
    return 0


@kernel
def _remainder(
    table: Array, lin: Array, centre: Array, theta: Array, omega: Array, load: Array
) -> Array:
    """Acceleration that the linearisation about the centre leaves out, (n,)."""
    n = len(theta)
    out = acceleration(table, theta, omega, load)
    for i in range(n):
        for j in range(n):
            out[i] = out[i] - lin[i, 1 + j] * (theta[j] - centre[j]) - lin[i, 1 + n + j] * omega[j]
    return out


@kernel
def _advance(a: Array, state: Array, centre: Array, first: Array, last: Array, dt: float) -> Array:
    """Exact motion about the centre under an acceleration that is linear from first to last."""
    n = len(centre)
    full = a.copy()
    for i in range(n):
        full[n + i, 2 * n] = dt * (last[i] - first[i])
        full[n + i, 2 * n + 1] = dt * first[i]
    full[2 * n, 2 * n + 1] = 1.0
    e = exponential(full)
    out = np.empty((2, n), state.dtype)
    for part in range(2):
        for i in range(n):
            at = part * n + i
            total = e[at, 2 * n + 1]
            for j in range(n):
                total = total + e[at, j] * (state[0, j] - centre[j]) + e[at, n + j] * state[1, j]
            out[part, i] = total + centre[i] if part == 0 else total
    return out


class ExactAboutEquilibrium(MinimalMethod):
    """For loads far beyond the stiffness: the frequency of the bent branch is exact too."""

    name: ClassVar[str] = 'exact_about_equilibrium'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, 1.0)
    notes: ClassVar[str] = 'exact for motion about a steady bent state; curvature is explicit'
    source: ClassVar[str] = (
        'Hochbruck and Ostermann 2010, Acta Numerica 19, 2.2, about another point'
    )
    kernel = staticmethod(step)
