# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The exponential Rosenbrock-Euler method: exact about the state at the beginning of the step."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.kernel import kernel
from tree_sway_lab.methods.dense import exponential
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal_form import acceleration, linearised

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """y1 = y0 + h phi1(h J) f + h^2 phi2(h J) df/dt, both from one augmented exponential."""
    n = len(table)
    theta, omega = state[0], state[1]
    lin = linearised(table, theta, omega, load[0])
    later = acceleration(table, theta, omega, load[1])
    a = np.zeros((2 * n + 2, 2 * n + 2), state.dtype)
    for i in range(n):
        a[i, n + i] = dt
        a[i, 2 * n + 1] = dt * omega[i]
        for j in range(2 * n):
            a[n + i, j] = dt * lin[i, 1 + j]
        a[n + i, 2 * n] = dt * (later[i] - lin[i, 0])
        a[n + i, 2 * n + 1] = dt * lin[i, 0]
    a[2 * n, 2 * n + 1] = 1.0
    e = exponential(a)
    for i in range(n):
        state[0, i] = state[0, i] + e[i, 2 * n + 1]
        state[1, i] = state[1, i] + e[n + i, 2 * n + 1]
    return 0


class ExponentialRosenbrock(MinimalMethod):
    """Sees the load's own stiffness; pays a matrix exponential a step."""

    name: ClassVar[str] = 'exponential_rosenbrock'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, 1.0)
    notes: ClassVar[str] = 'exact for the equation linearised at each step, stable as it is'
    source: ClassVar[str] = 'Hochbruck, Ostermann, Schweitzer 2009, SIAM J. Numer. Anal. 47, 786'
    kernel = staticmethod(step)
