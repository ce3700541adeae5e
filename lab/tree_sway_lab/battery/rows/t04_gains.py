# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
T4: gain of Baumgarte's stabilisation of a constraint, alpha = beta.

Two figures for each method beneath it: the gain alpha h beyond which it is unstable, and the one
that leaves the smallest gap in gusts.
"""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.row import holds, Row
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.multiplier.baumgarte import Baumgarte

TITLE = "gain of Baumgarte's stabilisation"
DT = 1 / 60


def largest_gap(base: str, gain: float, gusts_of: float = 10.0, steps: int = 1200) -> float:
    """Largest gap [m] in gusts of a size [N] at a gain alpha h = beta h; infinite if unstable."""
    chain, method = single_segment(2.0, 0.05), Baumgarte(gain, gain, base)
    gusts = np.repeat(np.random.default_rng(0).normal(0.0, gusts_of, steps // 12), 12)
    loads = np.empty((steps, 3, 1, 2))
    loads[..., 0, :] = (gusts[:, None] * [0.3, 1.0])[:, None, :]
    state = method.start(chain, np.array([0.3]), np.zeros(1), loads[0, 0], DT)
    options, worst = method.options(chain, DT), 0.0
    for load in loads:
        Baumgarte.kernel(chain.table, state, load, DT, options)
        worst = max(worst, method.gap(chain, state))
        if not worst < 1.0:
            return float(np.inf)
    return worst


def run(full: bool = False) -> list[Row]:
    """Find the limit of the gain by bisection and the gain with the smallest gap by a scan."""
    rows = []
    for base, limit, best in (
        ('semi_implicit_euler', 0.828, (0.7, 0.83)),
        ('rk4', 2.785, (0.1, 0.4)),
    ):
        low, high = 0.3, 4.0
        while high - low > 0.01:
            middle = 0.5 * (low + high)
            low, high = (
                (middle, high) if np.isfinite(largest_gap(base, middle, 1.0)) else (low, middle)
            )
        rows.append(
            holds(
                f'{base}, limit of alpha h',
                f'within 10 % of {limit}',
                f'{low:.3f}',
                abs(low / limit - 1) <= 0.1,
            )
        )
        scan = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2, 2.0])
        found = float(scan[np.argmin([largest_gap(base, gain) for gain in scan])])
        rows.append(
            holds(
                f'{base}, best alpha h',
                f'{best[0]} to {best[1]}',
                f'{found:g}',
                best[0] <= found <= best[1],
            )
        )
    return rows
