# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forces on the wood at the sensors, by which they push the coordinates of hanging twigs."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats

_LEAST_TOLD = 0.1
"""What coordinates tell of a force of which half is believed, over the mean of all forces [-]."""


def push_of(moved: Floats, stiffness: Floats, trust: Floats, share: Floats) -> Floats:
    """
    Find the force on each coordinate of a model by those that are known of the first, (n, m).

    The forces at some places are those that cause most of the lean of the corrected coordinates,
    whose squared misses count by their stiffness.

    Parameters
    ----------
    moved
        Ways of the places by each coordinate, one row each, (p, m).
    stiffness
        Stiffness of the coordinates [1/s^2], (m,).
    trust
        Share of the correction of the first coordinates that is applied, (n,).
    share
        Share of the push that each coordinate takes, (m,).

    """
    leant = moved[:, : len(trust)] / stiffness[: len(trust)]
    told = leant @ (trust[:, None] * moved[:, : len(trust)].T)
    least = _LEAST_TOLD * np.trace(told) / len(told)
    if not least:
        return np.zeros((len(trust), len(stiffness)))
    forces = np.linalg.solve(told + least * np.eye(len(told)), leant)
    return forces.T @ moved * share
