# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The two-step backward difference formula on the angles."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal.newton import solve_stage

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """3 y1 - 4 y0 + y(-1) = 2 h f(y1)."""
    theta, omega = state[0].copy(), state[1].copy()
    base = (state[0] * 4.0 - state[2]) * (1.0 / 3.0)
    base_rate = (state[1] * 4.0 - state[3]) * (1.0 / 3.0)
    iterations = solve_stage(table, base, base_rate, load[0], dt * (2.0 / 3.0), theta, omega)
    if iterations < 0:  # a failed step leaves the state as it was
        return iterations
    state[2, :] = state[0]
    state[3, :] = state[1]
    state[0, :] = theta
    state[1, :] = omega
    return iterations


class Bdf2(MinimalMethod):
    """Damps what it cannot follow, and some of what it should."""

    name: ClassVar[str] = 'bdf2'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (1.0,)
    notes: ClassVar[str] = (
        'A- and L-stable at a constant step; a changing step needs other coefficients'
    )
    source: ClassVar[str] = 'Hairer and Wanner 1996, Solving ODEs II, V.1'
    kernel = staticmethod(step)
