# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Runs of the two-axis kernel that the cases share: one branch, many frames."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.oscillators import propagator
from tree_sway_lab.kernel import kernel
from tree_sway_lab.methods.ball_joint import swing
from tree_sway_lab.methods.branch_bank import guards, single_precision
from tree_sway_lab.methods.two_axis import step_branch

Array = NDArray[Any]


class Branch:
    """A branch of unit inertia about its node, by frequency in [Hz] and damping ratio."""

    def __init__(
        self, frequency: float = 2.0, damping_ratio: float = 0.05, dt: float = 1 / 60
    ) -> None:
        self.dt = dt
        self.w = 2.0 * np.pi * frequency
        self.stiffness = self.w**2
        self.damping = 2.0 * damping_ratio * self.w
        self.row = propagator(1.0, self.damping, self.stiffness, dt)[0]
        self.guard = guards(np.ones(1), np.array([self.stiffness]), dt)[0]

    def run(self, loads: Array, state: Array | None = None, dtype: Any = np.float64) -> Array:
        """States after each frame, (steps + 1, 4), from frame means of W / k1, (steps, 3)."""
        start = np.zeros(4) if state is None else np.asarray(state)
        row = self.row if dtype == np.float64 else single_precision(self.row)
        return run_branch(
            (loads * self.stiffness).astype(dtype),
            row,
            self.guard.astype(dtype),
            start.astype(dtype),
        )

    def truth(
        self, wind: Any, steps: int, state: Array | None = None, substeps: int = 32
    ) -> Array:
        """Chord after each frame, (steps + 1, 3), from s-loads of time (k,) -> (k, 3)."""
        start = np.zeros(4) if state is None else np.asarray(state, float)
        fraction = np.arange(2 * substeps + 1) / (2 * substeps)
        times = self.dt * (np.arange(steps)[:, None] + fraction)
        # inside its frame a load that jumps at a frame's edge has one value
        inside = times + 1e-9 * self.dt * (1 - 2 * fraction)
        loads = wind(inside.ravel()).reshape(steps, -1, 3) * self.stiffness
        return np.asarray(
            swing(
                loads, self.dt, 1.0, self.damping, self.stiffness, start[:2], start[2:], substeps
            )[0]
        )

    def means(self, wind: Any, steps: int, points: int = 16) -> Array:
        """Mean of a load over each frame, (steps, 3)."""
        middles = (np.arange(points) + 0.5) / points
        times = self.dt * (np.arange(steps)[:, None] + middles)
        return np.asarray(wind(times.ravel()).reshape(steps, points, 3).mean(1))


def chord(states: Array) -> Array:
    """Return the unit vector of the branch from its rotation vector, (k, 3)."""
    theta = np.hypot(states[:, 0], states[:, 1]).astype(float)
    sinc = np.sinc(theta / np.pi)
    return np.stack([np.cos(theta), sinc * states[:, 0], sinc * states[:, 1]], 1)


@kernel
def run_branch(loads: Array, row: Array, guard: Array, start: Array) -> Array:
    """Step one branch through loads (steps, 3) in [N m]; states (steps + 1, 4)."""
    out = np.empty((len(loads) + 1, 4), start.dtype)
    out[0] = start
    c, g = row, guard
    for n in range(len(loads)):
        s, w = out[n], loads[n]
        out[n + 1, 0], out[n + 1, 1], out[n + 1, 2], out[n + 1, 3], _ = step_branch(
            s[0], s[1], s[2], s[3], w[0], w[1], w[2],
            c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], g[0], g[1], g[2],
        )  # fmt: skip
    return out
