# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""SHAKE for the positions and RATTLE for the velocities."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier_form import (
    add_joints,
    constraint,
    forces,
    jacobian,
    saddle,
)

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Half a kick that lands positions on the constraint, half a kick that lands velocities."""
    n = len(table)
    q, half, g0 = state[0].copy(), state[1].copy(), jacobian(table, state[0])
    force = forces(table, q, half, load[0])
    for i in range(3 * n):
        half[i] = half[i] + 0.5 * dt * force[i] / _mass(table, i)
    iterations = -1
    for iteration in range(20):
        state[0] = q + half * dt
        gap, g1 = constraint(table, state[0]), jacobian(table, state[0])
        matrix, rhs = np.zeros((2 * n, 2 * n), q.dtype), np.empty((2 * n, 1), q.dtype)
        size = 0.0 * abs(gap[0])
        for row in range(2 * n):
            rhs[row, 0] = gap[row] / dt
            size = max(size, abs(gap[row]))
            for k in range(3 * n):
                if g1[row, k] != 0.0:
                    for col in range(2 * n):
                        if g0[col, k] != 0.0:
                            matrix[row, col] = matrix[row, col] + g1[row, k] * g0[col, k] / _mass(
                                table, k
                            )
        if size < 1e-14 * n:
            iterations = iteration
            break
        if not solve(matrix, rhs):
            break
        for k in range(3 * n):
            for col in range(2 * n):
                if g0[col, k] != 0.0:
                    half[k] = half[k] - g0[col, k] * rhs[col, 0] / _mass(table, k)
    force = forces(table, state[0], half * 0.0, load[1])
    a = saddle(table, jacobian(table, state[0]), 0.5 * dt)
    add_joints(table, 5, 0.5 * dt, a)
    end = np.zeros((5 * n, 1), q.dtype)
    for i in range(3 * n):
        end[i, 0] = _mass(table, i) * half[i] + 0.5 * dt * force[i]
    solve(a, end)
    state[1] = end[: 3 * n, 0]
    state[3, : 2 * n] = end[3 * n :, 0]
    return iterations


@kernel
def _mass(table: Array, i: int) -> float:
    """Mass, mass or moment of inertia of a coordinate."""
    return table[i // 3, 0] if i % 3 < 2 else table[i // 3, 1]  # type: ignore[no-any-return]


class Rattle(MultiplierMethod):
    """Symplectic on the constraint; the damping is taken trapezoidally."""

    name: ClassVar[str] = 'rattle'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, 1.0)
    limit: ClassVar[float] = 2.0
    notes: ClassVar[str] = (
        'stable for w h < 2; positions and velocities on the constraint to rounding'
    )
    source: ClassVar[str] = (
        'Ryckaert et al. 1977 (SHAKE); Andersen 1983, J. Comput. Phys. 52, 24 (RATTLE)'
    )
    kernel = staticmethod(step)
