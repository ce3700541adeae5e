# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A bank of single two-axis branches in arrays, to set the step that runs beside others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.oscillators import LOAD_MAX
from tree_sway_lab.kernel import fused
from tree_sway_lab.methods.two_axis import fill_guards, step_branch


def single_precision(coefficients: Floats) -> NDArray[np.float32]:
    """
    Round coefficients to float32 so that free motion cannot grow.

    c0, c1, c4, c5 are rounded towards zero: the determinant c0 c5 - c1 c4, a sum of two positive
    terms for a lightly damped oscillator, then never passes the exact one, which is at most 1.

    Parameters
    ----------
    coefficients
        Rows of `propagator`, (n, 8).

    Returns
    -------
    NDArray[np.float32]
        The same in single precision, (n, 8).

    """
    out = coefficients.astype(np.float32)
    over = np.abs(out.astype(float)) > np.abs(coefficients)
    over[..., [2, 3, 6, 7]] = False
    out[over] = np.nextafter(out[over], np.float32(0.0))
    return out


def guards(inertia: Floats, stiffness: Floats, dt: float, load_max: float = LOAD_MAX) -> Floats:
    """Guards of each branch as `fill_guards` describes them, (n, 3)."""
    out = np.empty((len(inertia), 3))
    fill_guards(inertia, stiffness, dt, load_max, out)
    return out


@fused
def step_bank(state: Floats, load: Floats, coefficients: Floats, guard: Floats) -> int:
    """
    Step a bank of branches in place.

    Parameters
    ----------
    state
        x, y, vx, vy of each branch as rows, (4, n), float64 or float32.
    load
        wb, w1, w2 in [N m] as rows, (3, n), of the same kind.
    coefficients, guard
        `propagator` and `guards`, (n, 8) and (n, 3), of the same kind.

    Returns
    -------
    int
        Number of loads that were clamped.

    """
    clamped = 0
    for i in range(state.shape[1]):
        c, g = coefficients[i], guard[i]
        x, y, vx, vy, over = step_branch(
            state[0, i], state[1, i], state[2, i], state[3, i],
            load[0, i], load[1, i], load[2, i],
            c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], g[0], g[1], g[2],
        )  # fmt: skip
        state[0, i], state[1, i], state[2, i], state[3, i] = x, y, vx, vy
        clamped += over
    return clamped
