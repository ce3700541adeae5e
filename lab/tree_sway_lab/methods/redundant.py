# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Accelerations under constraints of which some may be redundant."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def solve_regularised(
    mass: Floats, g: Floats, force: Floats, bias: Floats, relative: float = 1e-9, rounds: int = 4
) -> tuple[Floats, Floats]:
    """
    Solve M a + G^T lam = F, G a = b where G may lack rank, by the augmented Lagrangian iteration.

    ``(G M^-1 G^T + eps) d = G a - b`` is positive definite whatever G repeats; each round corrects
    what eps left over (Bayo and Ledesma 1996, Nonlinear Dynamics 9, 113).

    Parameters
    ----------
    mass
        Diagonal of M, (n,).
    g
        Constraint Jacobian, (m, n).
    force, bias
        F (n,) and b (m,).
    relative
        eps over the largest diagonal entry of G M^-1 G^T [-].
    rounds
        Corrections.

    Returns
    -------
    a, lam
        Accelerations (n,) and multipliers (m,), the smallest of those that fit.

    """
    weighted = g / mass
    schur = weighted @ g.T
    regular = schur + relative * schur.diagonal().max() * np.eye(len(g))
    lam = np.zeros(len(g))
    accel = force / mass
    for _ in range(rounds):
        lam = lam + np.linalg.solve(regular, g @ accel - bias)
        accel = (force - g.T @ lam) / mass
    return accel, lam
