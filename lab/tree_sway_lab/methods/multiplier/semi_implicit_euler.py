# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Semi-implicit Euler on the index-1 form."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway.core.kernel import kernel
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index1_steps import euler

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Move the positions by the new velocities."""
    euler(table, state, load[0], dt, 0.0, 0.0, 1)
    return 0


class MultiplierSemiImplicitEuler(MultiplierMethod):
    """The paper's form as most would first write it."""

    name: ClassVar[str] = 'multiplier_semi_implicit_euler'
    order: ClassVar[int] = 1
    nodes: ClassVar[tuple[float, ...]] = (0.0,)
    limit: ClassVar[float] = 2.0
    notes: ClassVar[str] = 'stable for w h < 2; the constraint drifts, nothing pulls it back'
    source: ClassVar[str] = 'Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, I.1.2'
    kernel = staticmethod(step)
