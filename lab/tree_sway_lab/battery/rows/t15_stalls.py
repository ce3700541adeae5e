# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T15: late and uneven steps, and a stall of half a second every 60 frames."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.battery.branch_runs import Branch
from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.chain import single_segment
from tree_sway_lab.methods.registry import method_named
from tree_sway_lab.methods.stability import free_step

TITLE = 'late and uneven steps'
STALL = 0.5


def uneven_steps(frames: int) -> NDArray[np.float64]:
    """Return steps in [s] that jitter by half, with a stall every 60."""
    dt = (1 + 0.5 * np.sin(1.7 * np.arange(1, frames + 1))) / 60
    dt[59::60] = STALL
    return np.asarray(dt)


def run(full: bool = False) -> list[Row]:
    """Compare uneven steps with one step of the same total; count what stalls cost the others."""
    rows = []
    steps = uneven_steps(180)
    for kind, bound in ((np.float64, 1e-12), (np.float32, 1e-5)):
        worst = 0.0
        for frequency in (0.3, 2.0, 8.0):
            start = np.array([0.3, 0.0, -0.5, 0.0])
            state = start
            for dt in steps:
                branch = Branch(frequency, 0.002, float(dt))
                state = branch.run(np.zeros((1, 3)), state, kind)[-1]
            once = Branch(frequency, 0.002, float(steps.sum()))
            whole = once.run(np.zeros((1, 3)), start, kind)[-1]
            scale = np.array([0.3, 1, 0.3 * once.w, 1])
            worst = max(worst, float(np.abs((state - whole) / scale).max()))
        rows.append(
            holds(
                f'exact_foh kernel, 180 uneven frames, {kind.__name__}',
                f'equals one step of the same total, {bound:.0e}',
                f'{worst:.1e}',
                worst <= bound,
            )
        )
    for name in ('verlet', 'rk4'):
        gain = energy_gain(name)
        rows.append(
            fails(f'{name}, 2 Hz, three stalls', 'energy x 1e8', f'x {gain:.1e}', gain >= 1e8)
        )
    return rows


def energy_gain(name: str) -> float:
    """Energy after three stalls over energy at the start, small free motion, as the linear map."""
    method, chain = method_named(name), single_segment(2.0, 0.0)
    inertia, stiffness = chain.mass_matrix[0, 0], chain.stiffness_matrix[0, 0]
    state = np.array([0.01, 0.0])
    energy = stiffness * state[0] ** 2
    for dt in uneven_steps(180):
        state = free_step(method, chain, float(dt)) @ state
    return float((inertia * state[1] ** 2 + stiffness * state[0] ** 2) / energy)
