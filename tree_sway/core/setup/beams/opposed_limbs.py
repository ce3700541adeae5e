# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Fields of a branch whose limbs swing against each other.

Limbs in antiphase bend and twist a stem between their bases, unlike any motion of the whole crown.
Few limbs swing one after the other, many at random (random vectors find what matters: Halko,
Martinsson & Tropp 2011, SIAM Review 53(2), 217-288).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.beams.beam import BranchBeam
from tree_sway.core.setup.beams.energy_basis import curvature_of, energy_vector, EnergyBasis
from tree_sway.core.setup.beams.subtree_sums import SubtreeSums

_CASES = 24
"""Number of cases up to which each motion of each limb is its own; random ones of more."""

_LEFT_OUT = 1e-4
"""Largest share of the energy of all cases that the fields may miss."""


def missed_curvatures(basis: EnergyBasis, subtrees: SubtreeSums, most: int) -> Iterator[Floats]:
    """
    Yield curvatures by limbs in antiphase that a basis misses, that of the most energy first.

    Parameters
    ----------
    basis
        Fields of the branch so far; what is added meanwhile does not count.
    subtrees
        Sums over the subtrees of the children.
    most
        Largest number of curvatures (p, 5, 3).

    """
    beam = basis.beam
    shear_ratio = basis.shear_ratio
    curvatures = beam.curvature_in_space(_opposed_moments(beam, subtrees), shear_ratio)
    vectors = energy_vector(beam, np.moveaxis(curvatures, 2, 0), shear_ratio)
    whole_energy = float(np.square(vectors).sum())
    missed = _beyond(np.array(basis.vectors), vectors)
    _, amounts, directions = np.linalg.svd(missed, full_matrices=False)
    energies = np.square(amounts)
    # Energy that is still missed if this direction and all weaker ones are left out.
    left_out = np.cumsum(energies[::-1])[::-1]
    needed = directions[left_out > _LEFT_OUT * whole_energy]
    for direction in needed[:most]:
        yield curvature_of(beam, direction, shear_ratio)


def _beyond(orthonormal: Floats, vectors: Floats) -> Floats:
    """Return the parts of vectors (k, v) that are orthogonal to others, (f, v)."""
    rest = vectors
    for _ in range(2):  # twice, as rounding spoils the first pass of Gram and Schmidt
        rest = rest - (rest @ orthonormal.T) @ orthonormal
    return rest


def _opposed_moments(beam: BranchBeam, subtrees: SubtreeSums) -> Floats:
    """Return the internal moments as subtrees swing against each other, (p, 5, k, 3)."""
    base = beam.child_point[: len(subtrees.area)]
    cases = _cases_of(len(base))
    # Each limb moves in a case by three displacements of its base, and by three rotations.
    moved, turn = np.moveaxis(cases, 0, 2)
    turn = turn / _radius_of_gyration(base, subtrees)[:, None, None]
    force, moment = subtrees.inertial_wrench(base, turn, moved)
    no_load = np.zeros((*beam.weight.shape, len(cases), 3))
    return beam.moment_in_space(no_load, force, moment)


def _cases_of(n_limbs: int) -> Floats:
    """Return accelerations of limbs in k cases, (k, 2, c, 3): displacements, then rotations."""
    n_motions = 6 * n_limbs
    if n_motions <= _CASES:
        cases = np.eye(n_motions)
    else:
        cases = np.random.default_rng(0).choice((-1.0, 1.0), (_CASES, n_motions))
    return cases.reshape(-1, 2, n_limbs, 3)


def _radius_of_gyration(base: Floats, subtrees: SubtreeSums) -> Floats:
    """
    Return the radius of gyration of each subtree about its base in [m], (c,).

    Of the base b, masses m at r and their sums about the root, the second moment about the base is
    ``sum m |r - b|^2 = sum m |r|^2 - b . (2 sum m r - m b)``.
    """
    first = subtrees.mass_moment
    about_base = first - subtrees.mass[:, None] * base
    about_root = np.trace(subtrees.mass_second, axis1=1, axis2=2)
    second = about_root - (base * (about_base + first)).sum(axis=1)
    return np.sqrt(np.maximum(second, 1e-12) / np.maximum(subtrees.mass, 1e-300))
