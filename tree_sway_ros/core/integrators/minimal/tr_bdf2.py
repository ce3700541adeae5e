"""TR-BDF2 on the angles: a trapezoidal stage and a backward difference, one step."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.integrators.method import MinimalMethod, Oscillator
from tree_sway_ros.core.integrators.minimal.newton import solve_stage
from tree_sway_ros.core.integrators.minimal_form import acceleration
from tree_sway_ros.core.kernel import kernel

Array = NDArray[Any]

GAMMA = 2.0 - np.sqrt(2.0)
HALF = 0.5 * GAMMA  # both stages are then implicit over the same step
OLD = (1.0 - GAMMA) ** 2 / (GAMMA * (2.0 - GAMMA))
MIDDLE = 1.0 / (GAMMA * (2.0 - GAMMA))


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

    name: ClassVar[str] = "tr_bdf2"
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, GAMMA, 1.0)
    real_time: ClassVar[bool] = True
    notes: ClassVar[str] = "A- and L-stable; light damping of slow modes"
    source: ClassVar[str] = "Hosea and Shampine 1996, Appl. Numer. Math. 20; Bank et al. 1985"
    kernel = staticmethod(step)

    def advance(self, x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> tuple[Array, Array]:
        """Step the linear oscillator."""
        h = HALF * body.dt
        x1, v1 = x + h * v, v + h * body.acceleration(x, v, m0)
        x1, v1 = body.implicit(x1, v1, m0 + GAMMA * (m1 - m0), h)
        return body.implicit(MIDDLE * x1 - OLD * x, MIDDLE * v1 - OLD * v, m1, h)
