# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The exact propagator with a first-order hold: the default."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.method import MinimalMethod
from tree_sway_lab.methods.minimal.held_moment import apply, rest_moment

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """One predictor with the moment of the start, one corrector with the moment of its end."""
    n = len(table)
    first = rest_moment(table, state[0], state[1], load[0])
    base = apply(options, 0, state[:2], first)
    guess = base.copy()
    _add_end(options, first, guess)
    last = rest_moment(table, guess[0], guess[1], load[1])
    _add_end(options, last, base)
    for i in range(n):
        state[0, i] = base[0, i]
        state[1, i] = base[1, i]
    return 0


@kernel
def _add_end(options: Array, moment: Array, out: Array) -> None:
    """Add what the moment at the end of the step moves."""
    n = len(moment)
    for i in range(n):
        for j in range(n):
            out[0, i] = out[0, i] + options[i, 3 * n + j] * moment[j]
            out[1, i] = out[1, i] + options[n + i, 3 * n + j] * moment[j]


class ExactFirstOrderHold(MinimalMethod):
    """Frequency and damping exact at any step; bounded motion under any wind."""

    name: ClassVar[str] = 'exact_foh'
    order: ClassVar[int] = 2
    nodes: ClassVar[tuple[float, ...]] = (0.0, 1.0)
    notes: ClassVar[str] = "exact for the linear part at any w h; the load's own slope is explicit"
    source: ClassVar[str] = 'Hochbruck and Ostermann 2010, Acta Numerica 19, 2.2 (ETD2RK form)'
    kernel = staticmethod(step)

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return the propagator of the straight chain, (2n, 4n)."""
        return chain.first_order_hold(dt)
