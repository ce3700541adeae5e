# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T11: wind along the branch, where the plane of branch and wind does not exist."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.battery.branch_runs import Branch, chord
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.rebuilt_plane import run_in_rebuilt_plane

TITLE = 'wind parallel to the branch'
STEPS = 600


def _wind(along: float, off: float, turbulence: float) -> Any:
    """Return a load along b with a constant part off it and smooth turbulence about it."""

    def wind(t: NDArray[np.float64]) -> NDArray[np.float64]:
        size = abs(along) * turbulence
        e1 = along * off + size * (np.sin(2.1 * t) + np.sin(7.3 * t + 1) + np.sin(13.7 * t + 2))
        e2 = size * (np.cos(3.7 * t) + np.sin(5.9 * t + 2) + np.cos(11.3 * t))
        return np.stack([along * (1 + turbulence * np.sin(1.3 * t)), e1, e2], 1)

    return wind


def run(full: bool = False) -> list[Row]:
    """Compare the largest step with the ball joint's, from tip and root, then the plane."""
    branch, rows = Branch(), []
    for kind in (np.float64, np.float32):
        for name, off, turbulence in (
            ('parallel', 0.0, 0.0),
            ('1e-8 off', 1e-8, 0.0),
            ('1 % turbulence', 0.0, 0.01),
        ):
            worst, finite = 0.0, True
            for along in (-0.9, -0.3, 0.5, 2.0):
                wind = _wind(along, off, turbulence)
                truth = branch.truth(wind, STEPS)
                states = branch.run(branch.means(wind, STEPS), dtype=kind)
                finite = finite and bool(np.isfinite(states).all())
                ours, theirs = _largest(chord(states)), _largest(truth)
                floor = 1e-12 if kind == np.float64 else 1e-7
                worst = max(worst, (ours + floor) / (theirs + floor))
            rows.append(
                holds(
                    f'exact_foh, {name}, {kind.__name__}',
                    "frame step <= 1.05 of truth's",
                    f'{worst:.4f}',
                    finite and worst <= 1.05,
                )
            )
    loads = branch.means(_wind(-0.5, 0.0, 0.0), 60) * branch.stiffness
    seen = bool(np.isnan(run_in_rebuilt_plane(loads, branch.row)).any())
    rows.append(fails('rebuilt plane, parallel', 'NaN', 'NaN' if seen else 'finite', seen))
    return rows


def _largest(chords: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.diff(chords, axis=0), axis=1).max())
