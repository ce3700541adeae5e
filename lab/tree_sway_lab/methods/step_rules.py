# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Step rules that a solver could run, each as a function of a linear oscillator's state and load.

Every rule is linear in angle, rate and the moments at both ends of a step, so eight coefficients
per oscillator hold it. The product steps with the last of them, `exact_foh`; the others stand
beside it here.
"""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.oscillators.propagator import propagator
from tree_sway.errors import ParameterError

Array = NDArray[Any]


class Oscillator(NamedTuple):
    """I x'' + k2 x' + k1 x = M over a step: I [kg m^2], k2 [N m s], k1 [N m], h [s]."""

    inertia: Array
    damping: Array
    stiffness: Array
    dt: float

    def acceleration(self, x: Array, v: Array, m: Array) -> Array:
        """Angular acceleration in [rad/s^2]."""
        force = m - self.damping * v - self.stiffness * x
        return force / self.inertia  # type: ignore[no-any-return]

    def implicit(self, x: Array, v: Array, m: Array, step: float) -> tuple[Array, Array]:
        """Solve x1 = x + s v1, v1 = v + s a(x1, v1, m)."""
        i, c, k = self.inertia, self.damping, self.stiffness
        v1 = (i * v + step * (m - k * x)) / (i + step * c + step * step * k)
        return x + step * v1, v1


State = tuple[Array, Array]
StepRule = Callable[[Array, Array, Array, Array, Oscillator], State]
"""
``(x, v, m0, m1, body) -> (x, v)`` at the end of the step, under a moment that runs from m0 to m1.

"""


def exact_foh(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """Exact for a moment that is linear over the step."""
    i, c, k = body.inertia.ravel(), body.damping.ravel(), body.stiffness.ravel()
    c0, c1, c2, c3, c4, c5, c6, c7 = propagator(i, c, k, body.dt).T[:, :, None]
    return c0 * x + c1 * v + c2 * m0 + c3 * m1, c4 * x + c5 * v + c6 * m0 + c7 * m1


def exact_zoh(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """Exact for the moment at the start, constant over the step."""
    return exact_foh(x, v, m0, m0, body)


def implicit_midpoint(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """Second order, without numerical damping."""
    x1, v1 = body.implicit(x, v, 0.5 * (m0 + m1), 0.5 * body.dt)
    return 2.0 * x1 - x, 2.0 * v1 - v


GAMMA = 2.0 - np.sqrt(2.0)
"""TR-BDF2: where its trapezoidal part ends, in steps."""
HALF = 0.5 * GAMMA
"""TR-BDF2: step over which both of its stages are implicit."""
OLD = (1.0 - GAMMA) ** 2 / (GAMMA * (2.0 - GAMMA))
MIDDLE = 1.0 / (GAMMA * (2.0 - GAMMA))
"""TR-BDF2: weights of the old state and of the state at gamma."""


def tr_bdf2(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """Second order; damps what the step cannot resolve."""
    h = HALF * body.dt
    x1, v1 = x + h * v, v + h * body.acceleration(x, v, m0)
    x1, v1 = body.implicit(x1, v1, m0 + GAMMA * (m1 - m0), h)
    return body.implicit(MIDDLE * x1 - OLD * x, MIDDLE * v1 - OLD * v, m1, h)


def runge_kutta_4(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """Fourth order, explicit."""
    h, middle = body.dt, 0.5 * (m0 + m1)
    a1 = body.acceleration(x, v, m0)
    v2 = v + 0.5 * h * a1
    a2 = body.acceleration(x + 0.5 * h * v, v2, middle)
    v3 = v + 0.5 * h * a2
    a3 = body.acceleration(x + 0.5 * h * v2, v3, middle)
    v4 = v + h * a3
    a4 = body.acceleration(x + h * v3, v4, m1)
    x = x + h / 6.0 * (v + 2.0 * (v2 + v3) + v4)
    return x, v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)


def semi_implicit_euler(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """First order, explicit."""
    v = v + body.dt * body.acceleration(x, v, m0)
    return x + body.dt * v, v


def verlet(x: Array, v: Array, m0: Array, m1: Array, body: Oscillator) -> State:
    """Second order, explicit; the second kick sees the rate predicted for the end."""
    kick = 0.5 * body.dt * body.acceleration(x, v, m0)
    x = x + body.dt * (v + kick)
    return x, v + kick + 0.5 * body.dt * body.acceleration(x, v + 2.0 * kick, m1)


STEP_RULES: MappingProxyType[str, StepRule] = MappingProxyType(
    {
        'semi_implicit_euler': semi_implicit_euler,
        'verlet': verlet,
        'rk4': runge_kutta_4,
        'implicit_midpoint': implicit_midpoint,
        'tr_bdf2': tr_bdf2,
        'exact_zoh': exact_zoh,
        'exact_foh': exact_foh,
    }
)
"""Step rules by name."""

REAL_TIME = tuple(STEP_RULES)
"""Names of the rules that eight coefficients hold."""


def rule_named(name: str) -> StepRule:
    """Return a step rule by its name; a `ParameterError` if no rule has it."""
    if name not in STEP_RULES:
        raise ParameterError(
            f'no integrator {name!r} of eight coefficients',
            where='integrator',
            cure='take one of ' + ', '.join(REAL_TIME),
        )
    return STEP_RULES[name]


def rule_propagator(
    name: str, inertia: ArrayLike, damping: ArrayLike, stiffness: ArrayLike, dt: float
) -> Array:
    """Coefficients of a rule's own step per oscillator, as `propagator.propagator`, (n, 8)."""
    i, c, k = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(a, float)) for a in (inertia, damping, stiffness))
    )
    body = Oscillator(i[:, None], c[:, None], k[:, None], dt)
    with np.errstate(all='ignore'):
        x0, v0, m0, m1 = np.eye(4)
        x, v = rule_named(name)(x0, v0, m0, m1, body)
    return np.ascontiguousarray(np.hstack(np.broadcast_arrays(x, v)))


def growth(name: str, ratio: float, damping_ratio: float) -> float:
    """Return the largest factor [-] by which one step of w h can multiply free motion."""
    row = rule_propagator(name, 1.0, 2.0 * damping_ratio * ratio, ratio * ratio, 1.0)[0]
    return float(np.max(np.abs(np.linalg.eigvals(row[[0, 1, 4, 5]].reshape(2, 2)))))


def stability_limit(name: str, damping_ratio: float = 0.0) -> float:
    """
    Largest w h [-] at which free motion does not grow, infinite where every step is stable.

    It is the first crossing, found by a scan and bisection on the rule's own step, for an
    oscillator of a damping ratio.
    """
    slack = 1.0 + 1e-9
    scan = np.geomspace(1e-2, 1e4, 600)
    unstable = next((w for w in scan if not growth(name, w, damping_ratio) <= slack), None)
    if unstable is None:
        return float(np.inf)
    low, high = unstable / (scan[1] / scan[0]), unstable
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (
            (middle, high) if growth(name, middle, damping_ratio) <= slack else (low, middle)
        )
    return float(low)
