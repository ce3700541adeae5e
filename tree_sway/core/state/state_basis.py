# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree's shape as a few numbers: a basis of the key rotations.

However many branches a tree has, wind moves them together. A handful of coordinates holds all
shapes that it takes in any wind: ``x = B c``, ``c = P x``. A coordinate is measured by what it
does to the tips of all branches, so that what is left out is what is seen least (proper orthogonal
decomposition; Holmes et al. 2012, *Turbulence, Coherent Structures, Dynamical Systems and
Symmetry*, 3.1).
"""

from __future__ import annotations

from dataclasses import dataclass
import hashlib

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import fused
from tree_sway.core.state.full_scale import FULL_SCALE


@dataclass(frozen=True)
class BasisError:
    """
    How far segments are from where the model has them, over a run the basis was not made from.

    Of all segments and times in [m]: what the basis leaves out, the same with coordinates as
    int16, and the motion of the segments from rest.
    """

    rms: float
    greatest: float
    quantised_rms: float
    quantised_greatest: float
    motion_rms: float
    motion_greatest: float


@dataclass(frozen=True)
class StateBasis:
    """
    Coordinates that hold the shape of one tree on one model.

    The matrix is key rotations per unit of each in [rad], (N, m), the projection its inverse, (m,
    N), the scale the value of each at `FULL_SCALE`, (m,), the error what is left out, on a run of
    its own.
    """

    matrix: Floats
    projection: Floats
    scale: Floats
    error: BasisError

    @property
    def n_coordinates(self) -> int:
        """How many coordinates there are, m."""
        return len(self.scale)

    @property
    def digest(self) -> str:
        """Digest of matrix and scale, 16 hexadecimal digits: frames belong to one basis."""
        parts = self.matrix.tobytes() + self.scale.tobytes()
        return hashlib.sha256(parts).hexdigest()[:16]

    def coordinates(self, rotations: Floats) -> Floats:
        """Coordinates (m,) that come nearest to key rotations (N,) in [rad]."""
        out = np.empty(self.n_coordinates)
        _products(self.projection, rotations, out)
        return out

    def rotations(self, coordinates: Floats) -> Floats:
        """Key rotations in [rad], (N,), of coordinates (m,); the same bits on machines alike."""
        out = np.empty(len(self.matrix))
        _products(self.matrix, coordinates, out)
        return out

    def quantised(self, coordinates: Floats) -> tuple[NDArray[np.int16], int]:
        """Coordinates (m,) as int16, and how many were held at full scale."""
        steps = np.rint(coordinates * (FULL_SCALE / self.scale))
        held = np.clip(steps, -FULL_SCALE, FULL_SCALE)
        return held.astype(np.int16), int((held != steps).sum())

    def from_quantised(self, steps: NDArray[np.int16]) -> Floats:
        """Coordinates (m,) that int16 encode."""
        return steps * (self.scale / FULL_SCALE)


@fused
def _products(matrix: Floats, vector: Floats, out: Floats) -> None:
    for i in range(len(matrix)):
        total = 0.0
        for k in range(len(vector)):
            total += matrix[i, k] * vector[k]
        out[i] = total
