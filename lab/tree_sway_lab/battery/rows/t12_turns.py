# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T12: the wind reverses through zero, and turns by 90 and 180 degrees at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.battery.branch_runs import Branch, chord
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.rebuilt_plane import run_in_rebuilt_plane

TITLE = 'reversal and turns of the wind'
STEPS = 300
TURN_AT = 2.0
# Goals: largest error over the length, at 10, 30 and 60 degrees of deflection after the turn.
CASES = ((0.10, 1.5e-3), (0.30, 4e-3), (0.60, 1.5e-2))


def turning(size: float, degrees: float) -> Any:
    """Steady load across the branch that turns at once."""

    def wind(t: NDArray[np.float64]) -> NDArray[np.float64]:
        angle = np.radians(degrees) * (t >= TURN_AT)
        return size * np.stack([0 * t, np.cos(angle), np.sin(angle)], 1)

    return wind


def reversing(size: float) -> Any:
    """Load that swings through zero in its own line, with a whiff across."""

    def wind(t: NDArray[np.float64]) -> NDArray[np.float64]:
        swing = size * np.cos(2 * np.pi * 0.25 * t)
        return np.stack([0 * t, swing, 0 * t + 1e-3 * size], 1)

    return wind


def run(full: bool = False) -> list[Row]:
    """Compare with the ball joint; then the planar form that keeps its angle."""
    branch, rows = Branch(), []
    for size, bound in CASES:
        for name, wind in (
            ('90 degree turn', turning(size, 90)),
            ('180 degree turn', turning(size, 180)),
            ('reversal', reversing(size)),
        ):
            truth = branch.truth(wind, STEPS)
            ours = chord(branch.run(branch.means(wind, STEPS)))
            error = float(np.linalg.norm(ours - truth, axis=1).max())
            jump = _largest(ours) / _largest(truth)
            peak = np.degrees(np.arccos(truth[int(60 * TURN_AT) :, 0].min()))
            rows.append(
                holds(
                    f'exact_foh, {name}, s = {size} (peak {peak:.0f} deg)',
                    f'error <= {bound:g} L, no jump',
                    f"{error:.1e} L, frame step {jump:.3f} of truth's",
                    error <= bound and jump <= 1.05,
                )
            )
    wind = turning(0.17, 90)
    truth = branch.truth(wind, 180)[121:]
    planar = run_in_rebuilt_plane(branch.means(wind, 180) * branch.stiffness, branch.row)[121:]
    rms = float(np.sqrt(((planar - truth) ** 2).sum(1).mean()))
    rows.append(
        fails(
            'rebuilt plane that keeps theta, 90 degree turn at 10 degrees',
            'errs .09 L (rms of the next second)',
            f'{rms:.3f} L',
            0.08 <= rms <= 0.10,
        )
    )
    return rows


def _largest(chords: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.diff(chords, axis=0), axis=1).max())
