# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""TR-BDF2 on the angles: a trapezoidal stage and a backward difference, one step."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal.newton import solve_stage
from tree_sway_lab.methods.minimal_form import acceleration

Array = NDArray[Any]

GAMMA = 2.0 - 2.0**0.5
"""Where the trapezoidal stage ends, in steps."""

HALF = 0.5 * GAMMA
"""Step over which both stages are implicit, in steps."""

OLD = (1.0 - GAMMA) ** 2 / (GAMMA * (2.0 - GAMMA))
MIDDLE = 1.0 / (GAMMA * (2.0 - GAMMA))
"""Weights of the old state and of the state at gamma."""


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """To gamma by the trapezoidal rule, to 1 by the backward difference through 0 and gamma."""
    accel = acceleration(table, state[0], state[1], load[0])
    theta, omega = state[0].copy(), state[1].copy()
    h = HALF * dt
    first = solve_stage(
        table, state[0] + state[1] * h, state[1] + accel * h, load[1], h, theta, omega
    )
    if first < 0:  # a failed step leaves the state as it was
        return first
    base, base_rate = theta * MIDDLE - state[0] * OLD, omega * MIDDLE - state[1] * OLD
    second = solve_stage(table, base, base_rate, load[2], h, theta, omega)
    if second < 0:
        return second
    state[0, :] = theta
    state[1, :] = omega
    return first + second


class TrBdf2(MinimalMethod):
    """L-stable in one step, at the price of two implicit stages."""

    name: ClassVar[str] = 'tr_bdf2'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, GAMMA, 1.0)
    notes: ClassVar[str] = 'A- and L-stable; light damping of slow modes'
    source: ClassVar[str] = 'Hosea and Shampine 1996, Appl. Numer. Math. 20; Bank et al. 1985'
    kernel = staticmethod(step)
