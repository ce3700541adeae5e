# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Velocity Verlet on the angles."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal_form import acceleration

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Kick, drift, kick; the second kick sees the rate predicted for the end."""
    accel = acceleration(table, state[0], state[1], load[0])
    half, guess = np.empty_like(accel), np.empty_like(accel)
    for i in range(len(accel)):
        half[i] = state[1, i] + 0.5 * dt * accel[i]
        guess[i] = half[i] + 0.5 * dt * accel[i]
        state[0, i] = state[0, i] + dt * half[i]
    accel = acceleration(table, state[0], guess, load[1])
    for i in range(len(accel)):
        state[1, i] = half[i] + 0.5 * dt * accel[i]
    return 0


class Verlet(MinimalMethod):
    """Second order at two evaluations, symplectic without damping."""

    name: ClassVar[str] = 'verlet'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, 1.0)
    limit: ClassVar[float] = 2.0
    notes: ClassVar[str] = (
        'stable for w h < 2; damping lowers it, the predicted rate acts explicitly'
    )
    source: ClassVar[str] = 'Swope, Andersen, Berens, Wilson 1982, J. Chem. Phys. 76, eq. 11'
    kernel = staticmethod(step)
