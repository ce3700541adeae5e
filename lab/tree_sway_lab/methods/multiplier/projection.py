# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Projection of position and velocity onto the constraint after each step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index1_steps import runge_kutta
from tree_sway_lab.methods.multiplier.project import project_position, project_velocity

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """Runge-Kutta, then back to the constraint by the shortest way in the mass metric."""
    runge_kutta(table, state, load, dt, 0.0, 0.0)
    iterations = 0
    if options[0] > 0.0:
        iterations = project_position(table, state)
    if options[1] > 0.0:
        project_velocity(table, state)
    return iterations


@dataclass(frozen=True)
class Projection(MultiplierMethod):
    """
    Projects positions, velocities or both.

    Parameters
    ----------
    position, velocity
        Whether to project each of them.

    """

    position: bool = True
    velocity: bool = True

    name: ClassVar[str] = 'projection'
    order: ClassVar[int] = 4
    nodes: ClassVar[tuple[float, ...]] = (0.0, 0.5, 1.0)
    limit: ClassVar[float] = 2.828
    notes: ClassVar[str] = 'no drift with both; with velocity alone the gap grows linearly in time'
    source: ClassVar[str] = (
        'Eich 1993, SIAM J. Numer. Anal. 30, 1467; Hairer and Wanner 1996, VII.2'
    )
    kernel = staticmethod(step)

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return what is projected as two flags."""
        return np.array([float(self.position), float(self.velocity)])
