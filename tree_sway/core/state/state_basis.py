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

from tree_sway.core.arrays import Floats

FULL_SCALE = 32767
"""Greatest int16 that a coordinate is sent as."""

MARGIN = 5.0
"""
Full scale of a coordinate over its greatest value in the runs that a basis was made from: beyond
that the error of the basis is not known.

"""


@dataclass(frozen=True)
class StateBasis:
    """
    Coordinates that hold the shape of one tree on one model.

    Parameters
    ----------
    matrix
        Key rotations per unit of each in [rad], (N, m).
    projection
        Its inverse, (m, N).
    scale
        Value of each coordinate at `FULL_SCALE`, (m,).
    error
        Farthest that a segment was from where the model has it in [m], with coordinates as int16,
        over a run that the basis was not made from.

    """

    matrix: Floats
    projection: Floats
    scale: Floats
    error: float

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
        return np.asarray(self.projection @ rotations)

    def rotations(self, coordinates: Floats) -> Floats:
        """Key rotations in [rad], (N,), of coordinates (m,)."""
        return np.asarray(self.matrix @ coordinates)

    def rounded(self, coordinates: Floats) -> Floats:
        """Coordinates (m,) as they are once sent as int16."""
        steps = np.rint(coordinates * (FULL_SCALE / self.scale))
        return np.clip(steps, -FULL_SCALE, FULL_SCALE) * (self.scale / FULL_SCALE)
