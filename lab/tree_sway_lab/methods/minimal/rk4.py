# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The classical Runge-Kutta method on the angles."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal_form import acceleration

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Four evaluations at 0, 1/2, 1/2 and 1."""
    theta, omega = state[0].copy(), state[1].copy()
    a1 = acceleration(table, theta, omega, load[0])
    v2 = omega + a1 * (0.5 * dt)
    a2 = acceleration(table, theta + omega * (0.5 * dt), v2, load[1])
    v3 = omega + a2 * (0.5 * dt)
    a3 = acceleration(table, theta + v2 * (0.5 * dt), v3, load[1])
    v4 = omega + a3 * dt
    a4 = acceleration(table, theta + v3 * dt, v4, load[2])
    state[0, :] = theta + (omega + v4 + (v2 + v3) * 2.0) * (dt / 6.0)
    state[1, :] = omega + (a1 + a4 + (a2 + a3) * 2.0) * (dt / 6.0)
    return 0


class RungeKutta4(MinimalMethod):
    """Accurate while it lasts: gone beyond its limit."""

    name: ClassVar[str] = 'rk4'
    order: ClassVar[int] = 4
    nodes: ClassVar[tuple[float, ...]] = (0.0, 0.5, 1.0)
    limit: ClassVar[float] = 2.828
    notes: ClassVar[str] = (
        'stable for w h < 2 sqrt(2) without damping, 2.785 for an overdamped mode'
    )
    source: ClassVar[str] = 'Hairer and Wanner 1996, Solving ODEs II, IV.2'
    kernel = staticmethod(step)
