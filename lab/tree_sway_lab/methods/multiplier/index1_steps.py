# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The explicit steps that the index-1 methods share."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.multiplier_form import index1

Array = NDArray[Any]


@kernel
def euler(
    table: Array, state: Array, load: Array, dt: float, alpha: float, beta: float, implicit: int
) -> None:
    """One Euler step; the new velocity moves the positions where implicit is set."""
    accel, lam = index1(table, state[0], state[1], load, alpha, beta)
    if implicit:
        state[1] = state[1] + accel * dt
        state[0] = state[0] + state[1] * dt
    else:
        state[0] = state[0] + state[1] * dt
        state[1] = state[1] + accel * dt
    state[2] = accel
    state[3, : len(lam)] = lam


@kernel
def runge_kutta(
    table: Array, state: Array, load: Array, dt: float, alpha: float, beta: float
) -> None:
    """One classical Runge-Kutta step; loads at 0, 1/2 and 1."""
    q, v = state[0].copy(), state[1].copy()
    a1, lam = index1(table, q, v, load[0], alpha, beta)
    v2 = v + a1 * (0.5 * dt)
    a2, _ = index1(table, q + v * (0.5 * dt), v2, load[1], alpha, beta)
    v3 = v + a2 * (0.5 * dt)
    a3, _ = index1(table, q + v2 * (0.5 * dt), v3, load[1], alpha, beta)
    v4 = v + a3 * dt
    a4, _ = index1(table, q + v3 * dt, v4, load[2], alpha, beta)
    state[0] = q + (v + v4 + (v2 + v3) * 2.0) * (dt / 6.0)
    state[1] = v + (a1 + a4 + (a2 + a3) * 2.0) * (dt / 6.0)
    state[2] = a1
    state[3, : len(lam)] = lam
