# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Running a method over a wind: loads at its nodes, angles after each step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.method import Method

Array = NDArray[Any]


@dataclass
class Trajectory:
    """
    What `integrate` returns.

    Parameters
    ----------
    theta
        Angles after each step in [rad], (steps + 1, n).
    iterations
        Newton iterations summed over all steps (0 for explicit methods).
    failed
        Number of steps whose iteration did not converge.
    state
        The last state.

    """

    theta: NDArray[np.float64]
    iterations: int = 0
    failed: int = 0
    state: Array = field(default_factory=lambda: np.empty(0))


def sample(
    wind: Callable[[NDArray[np.float64]], Array], nodes: tuple[float, ...], dt: float, steps: int
) -> Array:
    """Sample loads at a method's nodes: wind(time (k,)) -> (k, n, 2) as (steps, nodes, n, 2)."""
    times = dt * (np.arange(steps)[:, None] + np.asarray(nodes)[None, :])
    values = wind(times.ravel())
    return np.ascontiguousarray(values.reshape(steps, len(nodes), *values.shape[1:]))


def integrate(
    method: Method, chain: PlanarChain, loads: Array, dt: float,
    theta: Array | None = None, omega: Array | None = None, first: Array | None = None,
) -> Trajectory:  # fmt: skip
    """
    Run a method over loads, (steps, nodes, n, 2), from rest or from given angles and rates.

    A state that is no longer finite stops the run; the rest of the angles is NaN.

    """
    n, kind = chain.n_segments, chain.table.dtype
    theta = np.zeros(n, kind) if theta is None else np.asarray(theta, kind)
    omega = np.zeros(n, kind) if omega is None else np.asarray(omega, kind)
    state = method.start(chain, theta, omega, loads[0, 0] if first is None else first, dt)
    options = method.options(chain, dt).astype(kind)
    step, angles = type(method).kernel, method.angles
    out = np.full((len(loads) + 1, n), np.nan)
    out[0] = theta
    result = Trajectory(out, state=state)
    for k in range(len(loads)):
        iterations = step(chain.table, state, loads[k], dt, options)
        result.iterations += max(iterations, 0)
        result.failed += iterations < 0
        values = angles(state)
        if not np.all(np.abs(values) < 1e6):
            break
        out[k + 1] = values
    return result
