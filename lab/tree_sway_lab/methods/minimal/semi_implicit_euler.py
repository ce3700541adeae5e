# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Semi-implicit (symplectic) Euler on the angles."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal_form import acceleration

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Find new rates from the old angles, new angles from the new rates."""
    accel = acceleration(table, state[0], state[1], load[0])
    for i in range(len(accel)):
        state[1, i] = state[1, i] + dt * accel[i]
        state[0, i] = state[0, i] + dt * state[1, i]
    return 0


class SemiImplicitEuler(MinimalMethod):
    """The usual method of games and of many engines."""

    name: ClassVar[str] = 'semi_implicit_euler'
    order: ClassVar[int] = 1
    nodes: ClassVar[tuple[float, ...]] = (0.0,)
    limit: ClassVar[float] = 2.0
    notes: ClassVar[str] = (
        'stable for w h < 2 without damping; damping lowers it to 2 (sqrt(1+z^2) - z)'
    )
    source: ClassVar[str] = 'Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, I.1.2'
    kernel = staticmethod(step)
