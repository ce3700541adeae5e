# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Linearly implicit Euler: one solve a step, the constraint linearised at its end."""

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
    """(M + h C + h^2 K) v1 + h G^T lam = M v + h F(q, 0),  G v1 = -phi / h."""
    n = len(table)
    a = saddle(table, jacobian(table, state[0]), dt)
    add_joints(table, 5, dt, a)
    add_joints(table, 4, dt * dt, a)
    force, gap = forces(table, state[0], state[1] * 0.0, load[0]), constraint(table, state[0])
    rhs = np.empty((5 * n, 1), state.dtype)
    for i in range(n):
        for k in range(3):
            m = table[i, 0] if k < 2 else table[i, 1]
            rhs[3 * i + k, 0] = m * state[1, 3 * i + k] + dt * force[3 * i + k]
    for row in range(2 * n):
        rhs[3 * n + row, 0] = -gap[row] / dt
    if not solve(a, rhs):
        return -1
    state[1] = rhs[: 3 * n, 0]
    state[0] = state[0] + state[1] * dt
    state[3, : 2 * n] = rhs[3 * n :, 0]
    return 1


class LinearlyImplicitEuler(MultiplierMethod):
    """What large-step cloth and engine solvers do."""

    name: ClassVar[str] = 'linearly_implicit_euler'
    order: ClassVar[int] = 1
    nodes: ClassVar[tuple[float, ...]] = (1.0,)
    notes: ClassVar[str] = 'unconditionally stable, damps strongly: z .02 looks like .12 at 2 Hz'
    source: ClassVar[str] = 'Baraff and Witkin 1998, SIGGRAPH, eq. 6; Lubich et al. 1992 (MEXX)'
    kernel = staticmethod(step)
