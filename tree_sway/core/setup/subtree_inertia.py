# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Effective inertia of a branch with a flexible subtree, for the model `branch`.

A rigid crown would make its stem too fast, for branches bend back as the stem accelerates. One
step of inverse iteration from the coordinate of the stem includes that: ``q = K^-1 M e_i`` within
the subtree, and Rayleigh's quotient of q is the squared frequency of branch i (Rayleigh, 1877; K
is diagonal but for gravity).
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.setup.matrices import Reduction
from tree_sway.core.tree.tree import Tree


def subtree_inertia(tree: Tree, reduction: Reduction) -> Floats:
    """
    Return the inertia of each coordinate with its flexible subtree in [kg m^2], (N,).

    It is never less than the diagonal of the mass matrix. Both axes of a branch with children have
    one inertia, so that it does not depend on the choice of the axes.
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
