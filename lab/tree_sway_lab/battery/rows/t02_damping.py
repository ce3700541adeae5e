# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T2: numerical damping and frequency at 60 steps per second, true damping ratio 0.02."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.battery.branch_runs import Branch
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.trajectory import integrate

TITLE = 'numerical damping and frequency'
DT = 1 / 60
RATIO = 0.02


def fit(samples: NDArray[np.float64], dt: float) -> tuple[float, float]:
    """
    Frequency in [Hz] and damping ratio of a free decay, from its two-term recurrence.

    Two real samples per period do not show a sign: the frequency must stay below half the sample
    rate.

    """
    x = np.asarray(samples, dtype=float)
    lhs = np.stack([x[1:-1], x[:-2]], 1)
    b, c = np.linalg.lstsq(lhs, x[2:], rcond=None)[0]
    root = np.log(np.roots([1.0, -b, -c]).astype(complex)[0]) / dt
    w = abs(root)
    return float(w / (2 * np.pi)), float(-root.real / w)


def run(full: bool = False) -> list[Row]:
    """Fit the decay of the kernel at 0.5 to 16 Hz and of implicit Euler at 2 Hz."""
    rows = []
    for kind, bound in ((np.float64, 1e-9), (np.float32, 1e-4)):
        worst = 0.0
        for frequency in (0.5, 1, 2, 4, 8, 16):
            branch = Branch(frequency, RATIO, DT)
            states = branch.run(np.zeros((60, 3)), np.array([0.2, 0.0, 0.0, 0.0]), kind)
            found, ratio = fit(states[:, 0], DT)
            worst = max(worst, abs(found / frequency - 1), abs(ratio - RATIO))
        rows.append(
            holds(
                f'exact_foh kernel, .5-16 Hz, {kind.__name__}',
                f'f/f0 - 1 and z - .02 <= {bound:.0e}',
                f'{worst:.1e}',
                worst <= bound,
            )
        )
    for frequency in (2.0,):
        chain = single_segment(frequency, RATIO)
        calm = np.zeros((240, 1, 1, 2))
        theta = integrate(
            method_named('linearly_implicit_euler'), chain, calm, DT, theta=np.array([1e-4])
        ).theta[20:, 0]
        ratio = fit(theta, DT)[1]
        rows.append(
            fails(
                f'implicit Euler at {frequency:.0f} Hz',
                'shows z .120-.126',
                f'{ratio:.3f}',
                0.120 <= ratio <= 0.126,
            )
        )
    return rows
