# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How loads bend a branch whose weight moves with it.

Weight that is moved sideways bends and twists a limp branch further; it straightens a hanging one
(second-order theory: Timoshenko & Gere, 1961).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import cross
from tree_sway.core.setup.beams.beam import BranchBeam, one_of
from tree_sway.core.setup.beams.energy_basis import curvature_of, energy_vector
from tree_sway.core.setup.beams.subtree_sums import SubtreeSums

_LIMP = 0.1
"""Weight over stiffness from which a branch is limp."""

_KRYLOV_BLOCKS = 3
"""Blocks of responses to weight beside the block of loads."""

_BUCKLED = 0.05
"""Smallest share of its stiffness that weight may leave a branch."""

_DOWN = np.array([0.0, 0.0, -1.0])


def bent_by_weight(
    beam: BranchBeam,
    mass: Floats,
    subtrees: SubtreeSums,
    curvatures: Floats,
    shear_ratio: float,
    gravity: float,
) -> Floats:
    """
    Find how far loads bend a branch whose weight moves with it.

    The response is a Galerkin solution in the block Krylov space of the curvatures by the loads
    and the response to weight.

    Parameters
    ----------
    beam, mass, subtrees, shear_ratio
        The same as in `shape_fields`.
    curvatures
        Curvatures by the loads without weight, (p, 5, k, 3).
    gravity
        Gravity over Young's modulus in [m/s^2/Pa].

    Returns
    -------
    Floats
        Curvatures (p, 5, k, 3), unchanged where weight matters little or would buckle the branch.

    """
    mass_beyond = _mass_beyond(beam, mass, subtrees)
    is_limp = _over_stiffness(beam, mass_beyond, gravity) >= _LIMP
    if not is_limp.any():
        return curvatures
    if is_limp.ndim:
        bent = curvatures.copy()
        for k in np.flatnonzero(is_limp).tolist():
            bent[k] = bent_by_weight(
                one_of(beam, k), mass[k], subtrees, curvatures[k], shear_ratio, gravity
            )
        return bent

    def by_weight(vectors: Floats) -> Floats:
        """Curvatures by the weight of a branch that has these curvatures, as energy vectors."""
        curvature = curvature_of(beam, vectors, shear_ratio)
        bent = np.moveaxis(curvature, 0, 2)
        moments = gravity * _moment_of_weight(beam, mass, subtrees, bent, mass_beyond)
        response = beam.curvature_in_space(moments, shear_ratio)
        return energy_vector(beam, np.moveaxis(response, 2, 0), shear_ratio)

    loads = energy_vector(beam, np.moveaxis(curvatures, 2, 0), shear_ratio)
    blocks = [loads]
    for _ in range(_KRYLOV_BLOCKS):
        block = by_weight(blocks[-1])
        size = max(float(np.linalg.norm(block)), 1e-300)
        blocks.append(block / size)
    basis = np.linalg.qr(np.vstack(blocks).T)[0]
    stiffness = np.eye(basis.shape[1]) - basis.T @ by_weight(basis.T).T
    if np.linalg.eigvalsh(stiffness + stiffness.T)[0] < 2.0 * _BUCKLED:
        return curvatures
    amounts = np.linalg.solve(stiffness, basis.T @ loads.T)
    vectors = basis @ amounts
    curvature = curvature_of(beam, vectors.T, shear_ratio)
    return np.moveaxis(curvature, 0, 2)


def weight_over_stiffness(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, gravity: float
) -> Floats:
    """
    Return the weight of a branch and its subtrees over its stiffness in bending [-].

    That is ``w L^3 / (2 E I)`` for a weight per length of w; the arguments are as in
    `bent_by_weight`.
    """
    return _over_stiffness(beam, _mass_beyond(beam, mass, subtrees), gravity)


def _over_stiffness(beam: BranchBeam, mass_beyond: Floats, gravity: float) -> Floats:
    bent = gravity * beam.integral(mass_beyond / beam.second_moment)
    return np.asarray(bent * beam.node[..., -1])


def _mass_beyond(beam: BranchBeam, mass: Floats, subtrees: SubtreeSums) -> Floats:
    """Return the mass of branch and subtrees beyond each point in [kg], (p, 5)."""
    before, nodes, _ = beam.from_base(mass)
    beyond = nodes[..., -1:, None] - before
    if len(subtrees.mass):
        beyond += beam.child_lever[1] @ subtrees.mass
    return np.asarray(beyond)


def _moment_of_weight(
    beam: BranchBeam, mass: Floats, subtrees: SubtreeSums, curvature: Floats, mass_beyond: Floats
) -> Floats:
    """
    Return the change of the internal moment by weight as a branch bends, for a gravity of 1.

    The moment is in the frame of the cross-section, which rotates from that at rest. Curvatures
    are (p, 5, k, 3).
    """
    slope, _, child_slope = beam.from_base(curvature)
    moved, _, child_moved = beam.from_base(cross(slope, beam.tangent[:, None, None]))
    places = np.concatenate([moved, beam.point[:, :, None]], axis=2)
    before, nodes, _ = beam.from_base(places * mass[..., None, None])
    mass_moment = nodes[-1] - before
    if len(subtrees.mass):
        base = beam.child_point[: len(subtrees.mass)]
        lever = subtrees.mass_moment - subtrees.mass[:, None] * base
        weighed = subtrees.mass[:, None, None] * child_moved + cross(child_slope, lever[:, None])
        sums = np.concatenate([weighed, subtrees.mass_moment[:, None]], axis=1)
        mass_moment += np.tensordot(beam.child_lever[1], sums, axes=1)
    moments = cross(mass_moment - mass_beyond[..., None, None] * places, _DOWN)
    # The last case is the branch at rest, whose moment turns with the section.
    moved_moments = moments[:, :, :-1]
    at_rest = moments[:, :, -1:]
    return np.asarray(moved_moments - cross(slope, at_rest))
