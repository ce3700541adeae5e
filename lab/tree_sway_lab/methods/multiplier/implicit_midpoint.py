# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The implicit midpoint rule on the multiplier form, velocities projected."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway.core.kernel import kernel
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index3_newton import solve_index3
from tree_sway_lab.methods.multiplier.project import project_velocity

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Take forces and reaction at the midpoint, the constraint at the end."""
    n = len(table)
    q, v = state[0].copy(), state[1].copy()
    accel, lam = state[2].copy(), state[3, : 2 * n].copy()
    iterations = solve_index3(
        table, q + v * (0.5 * dt), 0.25 * dt * dt, v, 0.5 * dt, q + v * dt, 0.5 * dt * dt,
        load[0], accel, lam,
    )  # fmt: skip
    if iterations < 0:  # a failed step leaves the state as it was
        return iterations
    state[0] = q + v * dt + accel * (0.5 * dt * dt)
    state[1] = v + accel * dt
    state[2] = accel
    state[3, : 2 * n] = lam
    project_velocity(table, state)
    return iterations


class MultiplierImplicitMidpoint(MultiplierMethod):
    """No numerical damping; the projection keeps index 3 from ringing."""

    name: ClassVar[str] = 'multiplier_implicit_midpoint'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.5,)
    notes: ClassVar[str] = "A-stable; without the projection the velocities' constraint rings"
    source: ClassVar[str] = 'Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, VII.1.4'
    kernel = staticmethod(step)
