# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The two-step backward difference formula on index 3."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway.core.kernel import kernel
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index3_newton import solve_index3

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """3 y1 - 4 y0 + y(-1) = 2 h y'(1), with phi(q1) = 0."""
    n = len(table)
    h = dt * (2.0 / 3.0)
    v = (state[1] * 4.0 - state[5]) * (1.0 / 3.0)
    q = (state[0] * 4.0 - state[4]) * (1.0 / 3.0) + v * h
    accel, lam = state[2].copy(), state[3, : 2 * n].copy()
    iterations = solve_index3(table, q, h * h, v, h, q, h * h, load[0], accel, lam)
    if iterations < 0:  # a failed step leaves the state as it was
        return iterations
    state[4] = state[0]
    state[5] = state[1]
    state[0] = q + accel * (h * h)
    state[1] = v + accel * h
    state[2] = accel
    state[3, : 2 * n] = lam
    return iterations


class MultiplierBdf2(MultiplierMethod):
    """Positions on the constraint; velocities near it."""

    name: ClassVar[str] = 'multiplier_bdf2'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (1.0,)
    notes: ClassVar[str] = 'convergent on index 3 at a constant step; damps fast motion'
    source: ClassVar[str] = 'Lotstedt and Petzold 1986, Math. Comp. 46, 491'
    kernel = staticmethod(step)
