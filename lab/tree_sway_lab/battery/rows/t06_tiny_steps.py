# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
T6: noise of the Lagrange multipliers at tiny steps.

A method on index 3 finds the multipliers (joint forces) from positions, whose rounding it divides
by h^2: their noise must grow by 100 from h = 1e-6 to 1e-7. Radau on the GGL form must have none.
"""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.registry import method_named

TITLE = 'multipliers at tiny steps'


def noise(name: str, dt: float, steps: int = 60) -> float:
    """Largest relative error of the multipliers, row 3 of the state, over the last steps."""
    chain = single_segment(2.0, 0.05)
    method = method_named(name)
    load = np.array([[1.0, 3.0]])
    loads = np.broadcast_to(load, (len(method.nodes), 1, 2)).copy()
    state = method.start(chain, np.array([0.3]), np.array([1.0]), load, dt)
    options = method.options(chain, dt)
    error = []
    for _ in range(steps):
        type(method).kernel(chain.table, state, loads, dt, options)
        true = method.reactions(chain, state, load)[0]
        error.append(np.abs(state[3, :2] - true).max() / np.abs(true).max())
    return float(max(error[steps // 2 :]))


def run(full: bool = False) -> list[Row]:
    """Measure the growth of index-3 noise from h = 1e-6 to 1e-7, and GGL at 1e-6."""
    coarse = noise('generalized_alpha', 1e-6)
    fine = noise('generalized_alpha', 1e-7)
    slope = np.log10(fine / coarse)
    seen = fails(
        'generalized_alpha on index 3',
        'noise ~ eps / h^2',
        f'{coarse:.1e} at 1e-6, {fine:.1e} at 1e-7: h^-{slope:.1f}',
        1.5 <= slope <= 2.5,
    )
    error = noise('radau_ggl', 1e-6)
    return [seen, holds('radau_ggl at h = 1e-6', '<= 1e-9', f'{error:.1e}', error <= 1e-9)]
