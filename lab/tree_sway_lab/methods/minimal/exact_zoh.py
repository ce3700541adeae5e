# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The exact propagator with a moment that is constant over the step."""

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
    """Hold the moment of the start over the step."""
    moment = rest_moment(table, state[0], state[1], load[0])
    state[:2] = apply(options, 1, state[:2], moment)
    return 0


class ExactZeroOrderHold(MinimalMethod):
    """The cheapest exact propagator: half a step late in what the load does."""

    name: ClassVar[str] = 'exact_zoh'
    order: ClassVar[int] = 1
    nodes: ClassVar[tuple[float, ...]] = (0.0,)
    notes: ClassVar[str] = 'exact for the linear part at any w h; first order in the load'
    source: ClassVar[str] = (
        'Hochbruck and Ostermann 2010, Acta Numerica 19, 2.1 (exponential Euler)'
    )
    kernel = staticmethod(step)

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return the propagator of the straight chain, (2n, 4n)."""
        return chain.first_order_hold(dt)
