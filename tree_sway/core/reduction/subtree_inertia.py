# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The inertia a branch feels when what it carries gives way: what model 2 knows of coupling.

Taken as rigid, a crown makes its stem too quick, for its branches bend back as the stem
accelerates. One step of inverse iteration from the stem's own coordinate lets them: ``q = K^-1 M
e_i`` within the subtree, and Rayleigh's quotient of q is the square of the frequency at which
branch i really swings (Rayleigh, 1877; K is diagonal but for gravity).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.reduction.matrices import Reduction
from tree_sway.core.tree.tree import Tree


def subtree_inertia(tree: Tree, reduction: Reduction) -> Floats:
    """
    Inertia of each coordinate with its subtree giving way, in [kg m^2], (N,).

    It is never less than the diagonal of the mass matrix. Both axes of a branch that carries
    others are taken as one, so that it does not matter how they are laid.
    """
    mass, stiffness = reduction.mass.tocsc(), reduction.stiffness.tocsc()
    inertia = np.asarray(mass.diagonal()).copy()
    spring = np.repeat(np.asarray(stiffness.diagonal()).reshape(-1, 2).mean(axis=1), 2)
    for branch in np.flatnonzero(tree.subtree_end - np.arange(tree.n_branches) > 1):
        first, end = reduction.first[branch], reduction.first[tree.subtree_end[branch]]
        below = slice(int(first), int(end))
        its_mass, its_stiffness = mass[below, below], stiffness[below, below]
        own = int(reduction.first[branch + 1] - first)
        follow = its_mass[:, :own].toarray() / spring[below, None]
        energy = np.einsum('ni,ni->', follow, its_stiffness @ follow)
        kinetic = np.einsum('ni,ni->', follow, its_mass @ follow)
        inertia[first : first + own] = spring[first : first + own] * kinetic / energy
    return inertia
