# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one nonlinear system that the implicit index-3 methods share."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.multiplier_form import (
    add_joints,
    constraint,
    forces,
    jacobian,
    multiplier_slope,
    saddle,
)

Array = NDArray[Any]

MAX_ITERATIONS = 20
TOLERANCE = 1e-13


@kernel
def solve_index3(
    table: Array, q0: Array, to_q: float, v0: Array, to_v: float, end0: Array, to_end: float,
    load: Array, accel: Array, lam: Array,
) -> int:  # fmt: skip
    """
    Solve M a = F(q, v) - G(q)^T lam, phi(end) = 0 by Newton's method.

    The three points hang on the unknown accelerations: q = q0 + to_q a, v = v0 + to_v a, end =
    end0 + to_end a. Constraint rows are divided by to_end, so that the matrix stays regular as the
    step shrinks; the gap's rounding error then shows in the multipliers as eps / h^2.

    Parameters
    ----------
    table
        The chain.
    q0, to_q, v0, to_v, end0, to_end
        The points, as above.
    load
        Loads in [N], (n, 2).
    accel, lam
        Guess, overwritten with the solution, (3n,) and (2n,).

    Returns
    -------
    int
        Iterations taken, or -1 where they do not converge.

    """
    n = len(table)
    for iteration in range(MAX_ITERATIONS):
        q, v = q0 + accel * to_q, v0 + accel * to_v
        end = end0 + accel * to_end
        g, g_end = jacobian(table, q), jacobian(table, end)
        force, gap, slope = (
            forces(table, q, v, load),
            constraint(table, end),
            multiplier_slope(table, q, lam),
        )
        a = saddle(table, g, 1.0)
        add_joints(table, 4, to_q, a)
        add_joints(table, 5, to_v, a)
        rhs = np.empty((5 * n, 1), q.dtype)
        for i in range(3 * n):
            m = table[i // 3, 0] if i % 3 < 2 else table[i // 3, 1]
            total = force[i] - m * accel[i]
            for row in range(2 * n):
                if g[row, i] != 0.0:
                    total = total - g[row, i] * lam[row]
                    a[3 * n + row, i] = g_end[row, i]
            if i % 3 == 2:
                a[i, i] = a[i, i] + to_q * slope[i // 3]
            rhs[i, 0] = total
        for row in range(2 * n):
            rhs[3 * n + row, 0] = -gap[row] / to_end
        if not solve(a, rhs):
            return -1
        change = 0.0 * abs(rhs[0, 0])
        for i in range(3 * n):
            accel[i] = accel[i] + rhs[i, 0]
            change = max(change, abs(rhs[i, 0]))
        for row in range(2 * n):
            lam[row] = lam[row] + rhs[3 * n + row, 0]
        if not change < 1e100:
            return -1
        if change * to_end <= TOLERANCE and iteration > 0:
            return iteration + 1
    return -1
