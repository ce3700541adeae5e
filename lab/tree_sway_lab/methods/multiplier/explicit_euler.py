# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Explicit Euler on the index-1 form."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index1_steps import euler

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Old accelerations, old velocities."""
    euler(table, state, load[0], dt, 0.0, 0.0, 0)
    return 0


class MultiplierExplicitEuler(MultiplierMethod):
    """Here to be seen failing: it feeds energy to every oscillation."""

    name: ClassVar[str] = 'multiplier_explicit_euler'
    order: ClassVar[int] = 1
    nodes: ClassVar[tuple[float, ...]] = (0.0,)
    limit: ClassVar[float] = 0.0
    notes: ClassVar[str] = 'unstable at any step without damping; needs 2 z > w h'
    source: ClassVar[str] = 'Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, I.1.2'
    kernel = staticmethod(step)
