# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Diameters that a scan got wrong: twigs as thin as they are.

A laser sees a twig as thick as its own spot; cylinders thinner than some 5 cm come out too thick
(Demol et al. 2022, Methods in Ecology and Evolution, review such errors).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.tree import Tree


def corrected_twigs(tree: Tree, twig_diameter: float, trusted_diameter: float) -> Tree:
    """
    Make what is thinner than a scan can see as thin as it is, diameters in [m].

    What is as thick as the ends of branches are in the scan, in the median, gets the diameter of a
    twig; what is as thick as is trusted stays, and between the two diameters follow in a straight
    line. After the idea of Morales & MacFarlane (2024, Forestry), which lets untrusted cylinders
    taper to twigs measured by hand. Nothing becomes thicker, and a scan that ends in thicker wood
    than is trusted, or in thinner than twigs, stays as it is.
    """
    end = float(np.median(tree.tip_diameter[tree.branch_first[1:] - 1]))
    if not twig_diameter < end < trusted_diameter:
        return tree

    def thinned(diameter: Floats) -> Floats:
        seen = np.interp(diameter, [end, trusted_diameter], [twig_diameter, trusted_diameter])
        return np.where(diameter < trusted_diameter, np.minimum(seen, diameter), diameter)

    base, tip = thinned(tree.base_diameter), thinned(tree.tip_diameter)
    return replace(tree, base_diameter=base, tip_diameter=tip)
