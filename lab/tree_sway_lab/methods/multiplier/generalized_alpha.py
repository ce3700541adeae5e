# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Generalised-alpha on index 3."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index3_newton import solve_index3

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """
    (1 - am) a1 + am a0 = (1 - af) q1'' + af q0'', then Newmark's formulas with a.

    Rows 4 of the state is a; options are am, af, beta, gamma and whether the iteration starts from
    the old acceleration (not advised) or from q + h v.

    """
    n = len(table)
    am, af, beta, gamma = options[0], options[1], options[2], options[3]
    old = (state[2] * af - state[4] * am) / (1.0 - am)
    gain = (1.0 - af) / (1.0 - am)
    q = state[0] + state[1] * dt + (state[4] * (0.5 - beta) + old * beta) * (dt * dt)
    v = state[1] + (state[4] * (1.0 - gamma) + old * gamma) * dt
    to_q, to_v = beta * gain * dt * dt, gamma * gain * dt
    lam = state[3, : 2 * n].copy()
    accel = state[2].copy()
    if options[4] == 0.0:  # such that the first guess of q is q + h v
        accel = (state[0] + state[1] * dt - q) / to_q
    iterations = solve_index3(table, q, to_q, v, to_v, q, to_q, load[0], accel, lam)
    if iterations < 0:  # a failed step leaves the state as it was
        return iterations
    state[4] = old + accel * gain
    state[0] = q + accel * to_q
    state[1] = v + accel * to_v
    state[2] = accel
    state[3, : 2 * n] = lam
    return iterations


@dataclass(frozen=True)
class GeneralizedAlpha(MultiplierMethod):
    """
    Second order with damping of what the step cannot follow, by choice.

    Parameters
    ----------
    rho
        Spectral radius at infinite frequency [-], 0 to 1: 0.8 keeps slow motion nearly undamped.
    from_old_acceleration
        Start Newton's iteration from the old acceleration: here to show why not.

    """

    rho: float = 0.8
    from_old_acceleration: bool = False

    name: ClassVar[str] = 'generalized_alpha'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (1.0,)
    notes: ClassVar[str] = 'stable for any w h; multipliers carry rounding as eps / h^2'
    source: ClassVar[str] = 'Chung and Hulbert 1993, J. Appl. Mech. 60; Arnold and Bruls 2007'
    kernel = staticmethod(step)

    def weights(self) -> tuple[float, float, float, float]:
        """Return am, af, beta, gamma."""
        am = (2.0 * self.rho - 1.0) / (self.rho + 1.0)
        af = self.rho / (self.rho + 1.0)
        return am, af, 0.25 * (1.0 - am + af) ** 2, 0.5 - am + af

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return the four weights and the choice of the first guess."""
        return np.array([*self.weights(), float(self.from_old_acceleration)])

    def start(
        self, chain: PlanarChain, theta: Array, omega: Array, load: Array, dt: float
    ) -> Array:
        """State with the auxiliary acceleration equal to the true one."""
        state = super().start(chain, theta, omega, load, dt)
        state[4] = state[2]
        return state
