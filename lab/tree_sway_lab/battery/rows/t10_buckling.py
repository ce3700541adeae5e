# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T10: wind head-on, towards the root: the branch buckles where the load passes the stiffness."""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.branch_runs import Branch
from tree_sway_lab.battery.row import holds, Row

TITLE = 'head-on wind'


def grows(size: float) -> bool:
    """Whether a deflection of 1e-6 rad grows in a minute under a load of s along the branch."""
    states = Branch().run(np.tile([-size, 0.0, 0.0], (3600, 1)), np.array([1e-6, 0.0, 0.0, 0.0]))
    return bool(abs(states[-1, 0]) > 1e-6)


def run(full: bool = False) -> list[Row]:
    """Find the load at which it buckles."""
    low, high = 0.5, 2.0
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    rows = [
        holds(
            'exact_foh kernel',
            'buckles within 1 % of s = 1',
            f's = {high:.4f}',
            abs(high - 1) <= 0.01,
        )
    ]
    for size in (1.05, 1.3, 2.0):
        states = Branch().run(
            np.tile([-size, 0.0, 0.0], (3600, 1)), np.array([1e-3, 0.0, 0.0, 0.0])
        )
        angle = abs(states[-1, 0])
        gap = abs(angle - size * np.sin(angle))
        rows.append(
            holds(
                f'buckled at s = {size}',
                'theta = s sin theta to 1e-6',
                f'{np.degrees(angle):.1f} deg, {gap:.0e}',
                gap <= 1e-6 and angle > 0.3,
            )
        )
    return rows
