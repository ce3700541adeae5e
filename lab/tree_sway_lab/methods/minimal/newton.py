# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one implicit equation that the implicit methods on the angles share."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.minimal_form import linearised

Array = NDArray[Any]

TOLERANCE = 1e-12
MAX_ITERATIONS = 20


@kernel
def solve_stage(
    table: Array, base: Array, base_rate: Array, load: Array, step: float,
    theta: Array, omega: Array,
) -> int:  # fmt: skip
    """
    Solve theta = base + s omega, omega = base_rate + s a(theta, omega) by Newton's method.

    Parameters
    ----------
    table
        The chain.
    base, base_rate
        Known parts of angles and rates, (n,).
    load
        Loads in [N], (n, 2).
    step
        The stage's step s in [s].
    theta, omega
        Guess, overwritten with the solution, (n,).

    Returns
    -------
    int
        Iterations taken, or -1 where they do not converge.

    """
    n = len(theta)
    matrix, rhs = np.empty((n, n), theta.dtype), np.empty((n, 1), theta.dtype)
    for iteration in range(MAX_ITERATIONS):
        for i in range(n):
            theta[i] = base[i] + step * omega[i]
        lin = linearised(table, theta, omega, load)
        size = 0.0 * abs(omega[0])
        for i in range(n):
            rhs[i, 0] = base_rate[i] + step * lin[i, 0] - omega[i]
            for j in range(n):
                matrix[i, j] = -step * (step * lin[i, 1 + j] + lin[i, 1 + n + j])
            matrix[i, i] = matrix[i, i] + 1.0
            size = max(size, abs(omega[i]))
        if not solve(matrix, rhs):
            return -1
        change = 0.0 * size
        for i in range(n):
            omega[i] = omega[i] + rhs[i, 0]
            change = max(change, abs(rhs[i, 0]))
        if change <= TOLERANCE * (1.0 + size):
            for i in range(n):
                theta[i] = base[i] + step * omega[i]
            return iteration + 1
    return -1
