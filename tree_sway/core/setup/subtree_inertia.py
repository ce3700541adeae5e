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
from tree_sway.core.tree import Tree


def subtree_inertia(tree: Tree, reduction: Reduction) -> Floats:
    """
    Return the inertia of each coordinate with its flexible subtree in [kg m^2], (N,).

    It is never less than the diagonal of the mass matrix. Both axes of a branch with children have
    one inertia, so that it does not depend on the choice of the axes.
    """
    mass = reduction.mass.tocsc()
    stiffness = reduction.stiffness.tocsc()
    first = reduction.first
    inertia = np.array(mass.diagonal())
    of_axes = np.asarray(stiffness.diagonal()).reshape(-1, 2)
    spring = np.repeat(of_axes.mean(axis=1), 2)
    size = tree.subtree_end - np.arange(tree.n_branches)
    for branch in np.flatnonzero(size > 1):
        own = slice(first[branch], first[branch + 1])
        subtree = slice(first[branch], first[tree.subtree_end[branch]])
        q = mass[subtree, own].toarray() / spring[subtree, None]
        strain = np.vdot(q, stiffness[subtree, subtree] @ q)
        kinetic = np.vdot(q, mass[subtree, subtree] @ q)
        inertia[own] = spring[own] * kinetic / strain
    return inertia
