# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Curvatures of a branch as vectors whose squares are their energy, and fields orthogonal in it.

With Young's modulus 1 and the shear modulus g (`shear_ratio`), twice the energy of a curvature
kappa is the integral of I (kappa_bend^2 + 2 g kappa_twist^2), since J = 2 I. The vector has
``sqrt(w I) (kappa_bend, sqrt(2 g) kappa_twist)`` at each point of quadrature, w its weight.
"""

from __future__ import annotations

from collections.abc import Iterable
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.beams.beam import BranchBeam, RotationField

_NEGLIGIBLE = 1e-4
"""Smallest share of a field that is orthogonal to those before."""


class EnergyBasis:
    """
    Fields of one branch that are orthogonal in energy, added one by one.

    Parameters
    ----------
    beam
        The branch.
    shear_ratio
        Shear modulus over Young's in [-].

    """

    def __init__(self, beam: BranchBeam, shear_ratio: float) -> None:
        self.beam = beam
        self.shear_ratio = shear_ratio
        self.vectors: list[Floats] = []
        """Orthonormal `energy_vector` of each field."""

    def add(self, curvature: Floats) -> RotationField | None:
        """
        Add the part of a curvature, (p, 5, 3), that is orthogonal to the fields before.

        Returns it as a field whose largest rotation, or displacement, is 1; None where the part is
        negligible.
        """
        vector = energy_vector(self.beam, curvature, self.shear_ratio)
        rest = self._orthogonal(vector)
        size = float(np.linalg.norm(rest))
        if not size > _NEGLIGIBLE * float(np.linalg.norm(vector)):
            return None
        self.vectors.append(rest / size)
        kept = curvature_of(self.beam, rest, self.shear_ratio)
        slope, nodes, _ = self.beam.from_base(kept)
        largest = max(np.abs(slope).max(), np.abs(nodes).max())
        return RotationField(self.beam, kept / largest)

    def _orthogonal(self, vector: Floats) -> Floats:
        """Return the part of a vector that is orthogonal to the fields so far."""
        for _ in range(2):  # twice, as rounding spoils the first pass of Gram and Schmidt
            for other in self.vectors:
                vector = vector - (other @ vector) * other
        return vector

    def add_all(self, curvatures: Iterable[Floats]) -> list[RotationField]:
        """Add curvatures one by one; return the fields of those that are not negligible."""
        found = (self.add(curvature) for curvature in curvatures)
        return [field for field in found if field is not None]


def energy_vector(beam: BranchBeam, curvature: Floats, shear_ratio: float) -> Floats:
    """Return curvatures (..., p, 5, 3) as vectors (..., 15 p)."""
    scaled = _with_twist_scaled(beam, curvature, math.sqrt(2.0 * shear_ratio))
    vector = _root_of_stiffness(beam) * scaled
    return np.reshape(vector, (*curvature.shape[:-3], -1))


def curvature_of(beam: BranchBeam, vector: Floats, shear_ratio: float) -> Floats:
    """Return the curvature (..., p, 5, 3) of an `energy_vector`."""
    scaled = np.reshape(vector, (*vector.shape[:-1], *beam.weight.shape, 3))
    curvature = scaled / _root_of_stiffness(beam)
    return _with_twist_scaled(beam, curvature, 1.0 / math.sqrt(2.0 * shear_ratio))


def _root_of_stiffness(beam: BranchBeam) -> Floats:
    """Return ``sqrt(w I)`` at each point, (p, 5, 1)."""
    return np.asarray(np.sqrt(beam.weight * beam.second_moment)[..., None])


def _with_twist_scaled(beam: BranchBeam, curvature: Floats, scale: float) -> Floats:
    """Scale the part of a curvature (..., p, 5, 3) about the branch."""
    along = beam.tangent[:, None, :]
    twist = (curvature * along).sum(axis=-1, keepdims=True) * along
    return np.asarray(curvature + (scale - 1.0) * twist)
