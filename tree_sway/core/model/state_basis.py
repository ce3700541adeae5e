# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The shape of a tree as a few numbers: a basis of the key rotations.

Wind moves all branches of a tree together, so that few coordinates describe its shapes in any
wind: ``x = B c``, ``c = P x``. A coordinate is weighted by the motion of the tips of all branches,
so that the error is the least visible motion (proper orthogonal decomposition; Holmes et al. 2012,
*Turbulence, Coherent Structures, Dynamical Systems and Symmetry*, 3.1).
"""

from __future__ import annotations

from dataclasses import dataclass
import hashlib

import numpy as np

from tree_sway.core.arrays import Floats

FULL_SCALE = 32767
"""Largest int16 of a coordinate that is sent."""

MARGIN = 5.0
"""
Full scale of a coordinate over its largest value in the winds of the error; beyond these the error
of the basis is unknown.

"""


@dataclass(frozen=True)
class StateBasis:
    """
    Coordinates of the shape of one tree on one model.

    Parameters
    ----------
    matrix
        Key rotations per unit of each in [rad], (N, m).
    projection
        Inverse of the matrix, (m, N).
    scale
        Value of each coordinate at `FULL_SCALE`, (m,).
    error
        Largest error of the tip of a branch in [m], with coordinates as int16, in a wind of 13 m/s
        and its gusts (`setup.stream_basis`).

    """

    matrix: Floats
    projection: Floats
    scale: Floats
    error: float

    @property
    def n_coordinates(self) -> int:
        """Number of coordinates, m."""
        return len(self.scale)

    @property
    def digest(self) -> str:
        """Digest of matrix and scale, 16 hexadecimal digits, that identifies the basis."""
        parts = self.matrix.tobytes() + self.scale.tobytes()
        return hashlib.sha256(parts).hexdigest()[:16]

    def coordinates(self, rotations: Floats) -> Floats:
        """Coordinates (m,) that fit key rotations (N,) in [rad] best."""
        return np.asarray(self.projection @ rotations)

    def rotations(self, coordinates: Floats) -> Floats:
        """Key rotations in [rad], (N,), of coordinates (m,)."""
        return np.asarray(self.matrix @ coordinates)


def rounded(coordinates: Floats, scale: Floats) -> Floats:
    """Coordinates (..., m) after rounding to int16, of values at full scale (m,)."""
    steps = np.rint(coordinates * (FULL_SCALE / scale))
    return np.asarray(np.clip(steps, -FULL_SCALE, FULL_SCALE) * (scale / FULL_SCALE))
