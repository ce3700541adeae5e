# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Coordinates of a tree, and the arrays by which they are stepped and placed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.setup.damping import stiffness_by_weight
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.setup.modes import Modes
from tree_sway.core.setup.tree_motion import centre_motion


@dataclass(frozen=True)
class Coordinates:
    """
    Coordinates of a tree that a table loads.

    Parameters
    ----------
    shapes
        Key rotations per unit of each coordinate, (N, m).
    stiffness, damping
        Stiffness in [1/s^2] and damping by the wood in [1/s], (m,).
    inertia_slopes
        Change of the inertia of the leading coordinates, (q, q, q), as `inertia_slopes`.
    participation
        Mean square motion of the load centre of each branch per unit of each, (b, m).
    area
        Drag area of each branch in [m^2], (b,).

    """

    shapes: Floats
    stiffness: Floats
    damping: Floats
    inertia_slopes: Floats
    participation: Floats
    area: Floats

    @property
    def mean_square_motion(self) -> Floats:
        """Mean square motion of the loaded pieces, per unit of each coordinate, (m,)."""
        total = max(float(self.area.sum()), 1e-300)
        return np.asarray(2.0 * self.area @ self.participation / total)


def modal_arrays(branches: Records, reduction: Reduction, modes: Modes) -> dict[str, Floats]:
    """Find what is known of coordinates beside their shapes and frequencies."""
    # One mode after the other, so that loops over coordinates are vectorised.
    shapes = np.ascontiguousarray(modes.shapes.T)
    return {
        'diagonal': np.asarray(reduction.stiffness.diagonal()),
        'weight': stiffness_by_weight(reduction.gravity, shapes.T),
        'momentum': reduction.mass @ modes.shapes,
        # Mean squared motion of each load centre, over three directions, (b, m).
        'participation': np.square(centre_motion(branches, modes.shapes)).sum(axis=1) / 2.0,
        'branch_compliance': reduction.compliance,
        'mode_compliance': np.linalg.inv(shapes @ (reduction.branchwise @ shapes.T)),
    }
