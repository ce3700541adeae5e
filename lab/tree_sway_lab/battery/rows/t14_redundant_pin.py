# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T14: a redundant constraint, the same pin stated twice: regularised solve against plain LU."""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods import multiplier_form
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.dense import solve
from tree_sway_lab.methods.redundant import solve_regularised

TITLE = 'redundant constraint'


def run(full: bool = False) -> list[Row]:
    """Accelerations with the last pin stated twice: regularised, then by plain elimination."""
    chain = uniform_chain(3, 2.0, 0.05)
    theta, omega = np.array([0.3, 0.5, 0.8]), np.array([1.0, -2.0, 0.5])
    load = np.array([[1.0, 2.0], [0.5, 1.0], [0.2, 0.4]])
    q, v = multiplier_form.place(chain.table, theta, omega)
    single, _ = multiplier_form.index1(chain.table, q, v, load, 0.0, 0.0)
    g = multiplier_form.jacobian(chain.table, q)
    bias = -multiplier_form.jacobian_rate(chain.table, q, v) @ omega
    g, bias = np.vstack([g, g[-2:]]), np.concatenate([bias, bias[-2:]])
    mass = np.repeat(chain.table[:, :2], [2, 1], axis=1).ravel()
    force = multiplier_form.forces(chain.table, q, v, load)
    accel, _ = solve_regularised(mass, g, force, bias)
    change = float(np.abs(accel - single).max() / np.abs(single).max())
    n, m = g.shape[1], g.shape[0]
    matrix = np.zeros((n + m, n + m))
    matrix[:n, :n], matrix[:n, n:], matrix[n:, :n] = np.diag(mass), g.T, g
    rhs = np.concatenate([force, bias])[:, None]
    solved = solve(matrix, rhs)
    wild = (
        not solved
        or not np.abs(rhs[:n, 0] - single).max() <= 1e-6 * np.abs(single).max()
        or bool(np.abs(rhs[n:]).max() > 1e6)
    )
    found = f'multipliers up to {np.abs(rhs[n:]).max():.0e} N' if solved else 'singular'
    return [
        holds(
            'regularised solve', 'acceleration changes <= 1e-6', f'{change:.0e}', change <= 1e-6
        ),
        fails('plain LU', 'fails', found, wild),
    ]
