# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T9: wind from the side, up to ten thousand times the stiffness."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from tree_sway_lab.battery.branch_runs import Branch
from tree_sway_lab.battery.row import holds, Row
from tree_sway_lab.methods.two_axis import limit_load

TITLE = 'strong wind from the side'
SIZES = (0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1e3, 1e4)


def run(full: bool = False) -> list[Row]:
    """Blow at a branch of 2 Hz for a minute at each size; check angle, bound and count."""
    branch, rows = Branch(), []
    limit = branch.guard[1]
    for kind in (np.float64, np.float32):
        error, peak, counted = 0.0, 0.0, True
        for size in SIZES:
            states = branch.run(np.tile([0.0, size, 0.0], (3600, 1)), dtype=kind).astype(float)
            peak = max(peak, float(np.abs(states[:, :2]).max()))
            static = brentq(lambda x, s=size: x - s * np.cos(x), 0, np.pi / 2)
            if size <= 10:
                error = max(error, abs(states[-1, 0] / static - 1))
            load = size * branch.stiffness
            counted = counted and limit_load(0.0, load, 0.0, limit)[3] == (load > limit)
        rows.append(
            holds(
                f's = .1 to 1e4, {kind.__name__}',
                'bounded, below pi',
                f'peak {peak:.2f} rad',
                peak < np.pi,
            )
        )
        rows.append(
            holds(
                f's <= 10, {kind.__name__}',
                'static angle right to 2 %',
                f'{error:.1e}',
                error <= 0.02,
            )
        )
        rows.append(
            holds(
                f'clamped loads, {kind.__name__}',
                'counted, each one and no other',
                'counted' if counted else 'miscounted',
                counted,
            )
        )
    return rows
