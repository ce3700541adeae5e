# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Correction of diameters of twigs in scans.

The diameter of a twig in a scan is that of the laser spot; cylinders thinner than some 5 cm are
too thick (Demol et al. 2022, Methods in Ecology and Evolution, review such errors).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree


def corrected_twigs(tree: Tree, twig_diameter: float, trusted_diameter: float) -> Tree:
    """
    Correct the diameters of thin cylinders of a scan, in [m].

    The median diameter of the ends of branches in the scan is mapped to the diameter of a twig;
    trusted diameters stay, and between the two the map is linear. After the idea of Morales &
    MacFarlane (2024, Forestry), which lets untrusted cylinders taper to twigs measured by hand. No
    diameter grows, and a scan that ends in wood thicker than is trusted, or thinner than twigs, is
    not changed.
    """
    end = float(np.median(tree.tip_diameter[tree.branch_first[1:] - 1]))
    if not twig_diameter < end < trusted_diameter:
        return tree

    def thinned(diameter: Floats) -> Floats:
        seen = np.interp(diameter, [end, trusted_diameter], [twig_diameter, trusted_diameter])
        return np.where(diameter < trusted_diameter, np.minimum(seen, diameter), diameter)

    return replace(
        tree,
        base_diameter=thinned(tree.base_diameter),
        tip_diameter=thinned(tree.tip_diameter),
    )
