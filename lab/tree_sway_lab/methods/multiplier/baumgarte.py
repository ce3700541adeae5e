# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Baumgarte's stabilisation of the index-1 form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier.index1_steps import euler, runge_kutta

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """One step with the constraint as a damped oscillator."""
    if options[2] > 0.0:
        runge_kutta(table, state, load, dt, options[0], options[1])
    else:
        euler(table, state, load[0], dt, options[0], options[1], 1)
    return 0


@dataclass(frozen=True)
class Baumgarte(MultiplierMethod):
    """
    The gap decays as a damped oscillator of the given gains.

    Parameters
    ----------
    alpha, beta
        Gains times the step, alpha h and beta h [-].
    base
        "rk4" or "semi_implicit_euler".

    """

    alpha: float = 0.4
    beta: float = 0.4
    base: str = 'rk4'

    name: ClassVar[str] = 'baumgarte'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, 0.5, 1.0)
    limit: ClassVar[float] = 2.828
    notes: ClassVar[str] = (
        'with alpha = beta the gain must stay below 2.785 / h on Runge-Kutta 4, .828 / h on '
        'semi-implicit '
        'Euler; a gain that grows as 1 / h lowers the order from 4 to 2, seen once the error is '
        'small'
    )
    source: ClassVar[str] = (
        'Baumgarte 1972, Comput. Methods Appl. Mech. Eng. 1, 1; Ascher et al. 1994'
    )
    kernel = staticmethod(step)

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return alpha, beta in [1/s] and whether the base is Runge-Kutta."""
        return np.array([self.alpha / dt, self.beta / dt, float(self.base == 'rk4')])
