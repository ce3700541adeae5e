# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T13: deflection past 90 degrees."""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.branch_runs import Branch, chord
from tree_sway_lab.battery.row import holds, Row

TITLE = 'past 90 degrees'


def run(full: bool = False) -> list[Row]:
    """Push a branch over with wind from ahead and aside; compare with the ball joint."""
    branch, rows = Branch(2.0, 0.2), []

    def wind(t: np.ndarray) -> np.ndarray:
        ramp = np.minimum(t / 3.0, 1.0)
        return 1.9 * np.stack([-0.9 * ramp, 0.4 * ramp, 0.1 * ramp * np.sin(2 * t)], 1)

    truth = branch.truth(wind, 600)
    for kind in (np.float64, np.float32):
        states = branch.run(branch.means(wind, 600), dtype=kind)
        error = float(np.linalg.norm(chord(states) - truth, axis=1).max())
        peak = float(np.degrees(np.arccos(truth[:, 0].min())))
        step = np.linalg.norm(np.diff(chord(states), axis=0), axis=1).max()
        theirs = np.linalg.norm(np.diff(truth, axis=0), axis=1).max()
        rows.append(
            holds(
                f'exact_foh kernel to {peak:.0f} degrees, {kind.__name__}',
                "regular: <= 1e-2 L, frame step <= 1.05 of truth's",
                f'{error:.1e} L, {step / theirs:.3f}',
                peak > 95 and error <= 1e-2 and step <= 1.05 * theirs,
            )
        )
    return rows
