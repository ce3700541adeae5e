# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The classical Runge-Kutta method on the index-1 form."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index1_steps import runge_kutta

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """No stabilisation: the gap grows with the square of time."""
    runge_kutta(table, state, load, dt, 0.0, 0.0)
    return 0


class MultiplierRungeKutta4(MultiplierMethod):
    """The paper's form with no stabilisation."""

    name: ClassVar[str] = 'multiplier_rk4'
    order: ClassVar[int] = 4
    nodes: ClassVar[tuple[float, ...]] = (0.0, 0.5, 1.0)
    limit: ClassVar[float] = 2.828
    notes: ClassVar[str] = 'stable for w h < 2 sqrt(2); the constraint drifts quadratically'
    source: ClassVar[str] = 'Hairer and Wanner 1996, Solving ODEs II, VII.2 (drift-off)'
    kernel = staticmethod(step)
