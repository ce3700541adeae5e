# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Back to the constraint: positions by Newton's method, velocities by one solve, both by mass."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.multiplier_form import constraint, jacobian, saddle

Array = NDArray[Any]


@kernel
def project_position(table: Array, state: Array) -> int:
    """Move q to phi(q) = 0; iterations taken, or -1."""
    n = len(table)
    for iteration in range(10):
        gap = constraint(table, state[0])
        rhs = np.zeros((5 * n, 1), state.dtype)
        size = 0.0 * abs(gap[0])
        for row in range(2 * n):
            rhs[3 * n + row, 0] = -gap[row]
            size = max(size, abs(gap[row]))
        if size < 1e-14 * n and iteration > 0:
            return iteration
        if not solve(saddle(table, jacobian(table, state[0]), 1.0), rhs):
            return -1
        for k in range(3 * n):
            state[0, k] = state[0, k] + rhs[k, 0]
    return 10


@kernel
def project_velocity(table: Array, state: Array) -> None:
    """Move v to G v = 0."""
    n = len(table)
    g = jacobian(table, state[0])
    rhs = np.zeros((5 * n, 1), state.dtype)
    for row in range(2 * n):
        total = 0.0 * state[1, 0]
        for col in range(3 * n):
            if g[row, col] != 0.0:
                total = total - g[row, col] * state[1, col]
        rhs[3 * n + row, 0] = total
    solve(saddle(table, g, 1.0), rhs)
    for k in range(3 * n):
        state[1, k] = state[1, k] + rhs[k, 0]
