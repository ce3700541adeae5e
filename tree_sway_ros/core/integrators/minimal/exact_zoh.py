"""The exact propagator with a held moment."""

from __future__ import annotations

from typing import Any, ClassVar

from numpy.typing import NDArray

from tree_sway_ros.core.integrators.chain import PlanarChain
from tree_sway_ros.core.integrators.method import MinimalMethod, Oscillator
from tree_sway_ros.core.integrators.minimal.exact_foh import ExactFirstOrderHold
from tree_sway_ros.core.integrators.minimal.held_moment import apply, rest_moment
from tree_sway_ros.core.kernel import kernel

Array = NDArray[Any]


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """The moment of the start, held over the step."""
    moment = rest_moment(table, state[0], state[1], load[0])
    state[:2] = apply(options, 1, state[:2], moment)
    return 0


class ExactZeroOrderHold(MinimalMethod):
    """The cheapest exact propagator: half a step late in what the load does."""

    name: ClassVar[str] = "exact_zoh"
    order: ClassVar[int] = 1
    nodes: ClassVar[tuple[float, ...]] = (0.0,)
    real_time: ClassVar[bool] = True
    notes: ClassVar[str] = "exact for the linear part at any w h; first order in the load"
    source: ClassVar[str] = "Hochbruck and Ostermann 2010, Acta Numerica 19, 2.1 (exponential Euler)"
    kernel = staticmethod(step)

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return the propagator of the straight chain, (2n, 4n)."""
        return chain.first_order_hold(dt)

    def advance(self, x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> tuple[Array, Array]:
        """Step the linear oscillator."""
        return ExactFirstOrderHold().advance(x, v, m0, m0, body)
