# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Radau IIA(5) on the GGL form: the reference that the others are measured against."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.chain import PlanarChain
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.method import MultiplierMethod
from tree_sway_lab.methods.multiplier_form import (
    add_joints,
    add_masses,
    constraint,
    forces,
    jacobian,
    jacobian_rate,
    multiplier_slope,
)

Array = NDArray[Any]

_ROOT = np.sqrt(6.0)
NODES = ((4.0 - _ROOT) / 10.0, (4.0 + _ROOT) / 10.0, 1.0)
WEIGHTS = np.array(
    [
        [(88 - 7 * _ROOT) / 360, (296 - 169 * _ROOT) / 1800, (-2 + 3 * _ROOT) / 225],
        [(296 + 169 * _ROOT) / 1800, (88 + 7 * _ROOT) / 360, (-2 - 3 * _ROOT) / 225],
        [(16 - _ROOT) / 36, (16 + _ROOT) / 36, 1 / 9],
    ]
)
MAX_ITERATIONS = 12
TOLERANCE = 1e-14


@kernel
def step(table: Array, state: Array, load: Array, dt: float, options: Array) -> int:
    """
    Three stages of q' = v - G^T mu, M v' = F - G^T lam, phi = 0, G v = 0 by Newton's method.

    The unknowns of a stage are q, v, h lam and h mu, 10n of them; options hold the weights row by
    row.

    """
    n = len(table)
    width = 10 * n
    x = np.zeros(3 * width, state.dtype)
    for stage in range(3):
        at = stage * width
        x[at : at + 3 * n] = state[0] + state[1] * (
            dt * (options[3 * stage] + options[3 * stage + 1] + options[3 * stage + 2])
        )
        x[at + 3 * n : at + 6 * n] = state[1]
        x[at + 6 * n : at + 8 * n] = state[3, : 2 * n] * dt
    last = 0.0 * abs(x[0])
    for iteration in range(MAX_ITERATIONS):
        a, rhs = _system(table, state, load, dt, options, x)
        if not solve(a, rhs):
            return -1
        change = 0.0 * abs(x[0])
        for stage in range(3):
            for i in range(width):
                at = stage * width + i
                if (
                    not abs(rhs[at, 0]) < 1e100
                ):  # a comparison would pass over what is not a number
                    return -1
                x[at] = x[at] + rhs[at, 0]
                if i < 3 * n:
                    change = max(change, abs(rhs[at, 0]))
        settled = iteration > 1 and change < 1e-4 and change > 0.5 * last  # rounding is reached
        if change <= TOLERANCE or settled:
            at = 2 * width
            state[0] = x[at : at + 3 * n]
            state[1] = x[at + 3 * n : at + 6 * n]
            state[3, : 2 * n] = x[at + 6 * n : at + 8 * n] * (1.0 / dt)
            return iteration + 1
        last = change
    return -1


@kernel
def _system(
    table: Array, state: Array, load: Array, dt: float, options: Array, x: Array
) -> tuple[Array, Array]:
    """Newton matrix and negative residual of the three stages."""
    n = len(table)
    width = 10 * n
    a, rhs = np.zeros((3 * width, 3 * width), x.dtype), np.zeros((3 * width, 1), x.dtype)
    for j in range(3):
        at = j * width
        q, v = x[at : at + 3 * n], x[at + 3 * n : at + 6 * n]
        lam, mu = x[at + 6 * n : at + 8 * n], x[at + 8 * n : at + 10 * n]
        g, rate, gap = jacobian(table, q), jacobian_rate(table, q, v), constraint(table, q)
        force = forces(table, q, v, load[j])
        slope, bend = multiplier_slope(table, q, lam), multiplier_slope(table, q, mu)
        kinetic, elastic = np.zeros((3 * n, 3 * n), x.dtype), np.zeros((3 * n, 3 * n), x.dtype)
        damping = np.zeros((3 * n, 3 * n), x.dtype)
        add_masses(table, 1.0, kinetic)
        add_joints(table, 4, dt, elastic)
        add_joints(table, 5, dt, damping)
        for i in range(n):
            elastic[3 * i + 2, 3 * i + 2] = elastic[3 * i + 2, 3 * i + 2] + slope[i]
        for i in range(3 * n):
            pull, slip = 0.0 * x[0], 0.0 * x[0]
            for row in range(2 * n):
                if g[row, i] != 0.0:
                    pull = pull + g[row, i] * lam[row]
                    slip = slip + g[row, i] * mu[row]
                    a[at + 6 * n + row, at + i] = g[row, i]
                    a[at + 8 * n + row, at + 3 * n + i] = g[row, i]
                    rhs[at + 8 * n + row, 0] = rhs[at + 8 * n + row, 0] - g[row, i] * v[i]
                if i % 3 == 2:
                    a[at + 8 * n + row, at + i] = rate[row, i // 3]
            a[at + i, at + i] = a[at + i, at + i] + 1.0
            rhs[at + i, 0] = rhs[at + i, 0] + state[0, i] - q[i]
            rhs[at + 3 * n + i, 0] = rhs[at + 3 * n + i, 0] + kinetic[i, i] * (state[1, i] - v[i])
            a[at + 3 * n + i, at + 3 * n + i] = a[at + 3 * n + i, at + 3 * n + i] + kinetic[i, i]
            for stage in range(3):
                w, to = options[3 * stage + j], stage * width
                rhs[to + i, 0] = rhs[to + i, 0] + w * (dt * v[i] - slip)
                rhs[to + 3 * n + i, 0] = rhs[to + 3 * n + i, 0] + w * (dt * force[i] - pull)
                a[to + i, at + 3 * n + i] = a[to + i, at + 3 * n + i] - w * dt
                if i % 3 == 2:
                    a[to + i, at + i] = a[to + i, at + i] + w * bend[i // 3]
                for k in range(3 * n):
                    if elastic[i, k] != 0.0 or damping[i, k] != 0.0:
                        a[to + 3 * n + i, at + k] = a[to + 3 * n + i, at + k] + w * elastic[i, k]
                        here = to + 3 * n + i
                        a[here, at + 3 * n + k] = a[here, at + 3 * n + k] + w * damping[i, k]
                for row in range(2 * n):
                    if g[row, i] != 0.0:
                        a[to + i, at + 8 * n + row] = w * g[row, i]
                        a[to + 3 * n + i, at + 6 * n + row] = w * g[row, i]
        for row in range(2 * n):
            rhs[at + 6 * n + row, 0] = -gap[row]
    return a, rhs


class RadauGgl(MultiplierMethod):
    """Fifth order, L-stable, constraints of position and velocity met to rounding."""

    name: ClassVar[str] = 'radau_ggl'
    order: ClassVar[int] = 5
    nodes: ClassVar[tuple[float, ...]] = NODES
    notes: ClassVar[str] = 'stable for any w h; multipliers to eps / h, not eps / h^2'
    source: ClassVar[str] = 'Gear, Leimkuhler, Gupta 1985; Hairer and Wanner 1996, VII.5, IV.8'
    kernel = staticmethod(step)

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return the weights row by row."""
        return WEIGHTS.ravel().copy()
