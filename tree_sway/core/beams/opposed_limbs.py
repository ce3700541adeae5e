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
from tree_sway.core.beams.beam import BranchBeam
from tree_sway.core.beams.energy_basis import curvature_of, energy_vector, EnergyBasis
from tree_sway.core.beams.subtree_sums import SubtreeSums

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
    beam, shear_ratio = basis.beam, basis.shear_ratio
    curvatures = beam.curvature_in_space(_opposed_moments(beam, subtrees), shear_ratio)
    cases = np.moveaxis(curvatures, 2, 0)
    missed = np.array([energy_vector(beam, each, shear_ratio) for each in cases])
    whole = float(np.square(missed).sum())
    vectors = np.array(basis.vectors)
    for _ in range(2):
        missed -= (missed @ vectors.T) @ vectors
    sizes, directions = np.linalg.svd(missed, full_matrices=False)[1:]
    # Energy that is still missed if this direction and all weaker ones are left out.
    left_out = np.cumsum(np.square(sizes[::-1]))[::-1]
    for direction in directions[left_out > _LEFT_OUT * whole][:most]:
        yield curvature_of(beam, direction, shear_ratio)


def _opposed_moments(beam: BranchBeam, subtrees: SubtreeSums) -> Floats:
    """Return the internal moments as subtrees swing against each other, (p, 5, k, 3)."""
    base = beam.child_point[: len(subtrees.area)]
    n_limbs = len(base)
    n_motions = 6 * n_limbs
    if n_motions <= _CASES:
        cases = np.eye(n_motions)
    else:
        cases = np.random.default_rng(0).choice((-1.0, 1.0), (_CASES, n_motions))
    moved, turn = np.moveaxis(cases.reshape(-1, 2, n_limbs, 3), 0, 2)
    turn = turn / _radius_of_gyration(base, subtrees)[:, None, None]
    own_load = np.zeros((*beam.weight.shape, len(cases), 3))
    force, moment = subtrees.inertial_wrench(base, turn, moved)
    return beam.moment_in_space(own_load, force, moment)


def _radius_of_gyration(base: Floats, subtrees: SubtreeSums) -> Floats:
    """Return that of each subtree about its base in [m], (c,)."""
    about_base = subtrees.mass_moment - subtrees.mass[:, None] * base
    trace = np.trace(subtrees.mass_second, axis1=1, axis2=2)
    second = trace - (base * (about_base + subtrees.mass_moment)).sum(axis=1)
    return np.sqrt(np.maximum(second, 1e-12) / np.maximum(subtrees.mass, 1e-300))
