# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Correction of diameters of branches in scans.

The diameter of a twig in a scan is that of the laser spot; cylinders thinner than some 5 cm are
too thick. Two ashes that were felled had 1/1.45 of the wood of their scans (Demol et al. 2022,
Silva Fennica 56, 10550).
"""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import breast_height_diameter, Tree, wood_volume
from tree_sway.growth import is_cut

SCAN_WEIGHT = 0.2
"""
Weight of the wood of a scan beside that of trees of its size [-], by their variances: logarithm of
1.45 and 0.3 for repeated scans, beside 0.24 for one temperate tree of given diameter and height.
"""

_FEWEST = 10
"""Number of branches by which the end of a scan is known [-]."""
_SMALLEST = 0.07, 5.0
"""Diameter and height in [m] from which on the volume of a tree is known by them."""
_THINNEST = 0.5
"""Smallest ratio by which branches are made thinner [-]."""


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

    base = thinned(tree.base_diameter)
    tip = thinned(tree.tip_diameter)
    return replace(tree, base_diameter=base, tip_diameter=tip)


def of_usual_wood(tree: Tree) -> Tree:
    """
    Return a broadleaf whose scan was cut with the wood of trees of its diameter and height.

    The logarithm of its volume is the mean of the scanned and of the usual one, and all branches
    are thinner by one ratio, so that limbs keep theirs; the stem stays, and nothing grows. A scan
    of few branches, a small tree and one whose scan ends in twigs are not changed.
    """
    diameter = breast_height_diameter(tree)
    if diameter is None or diameter < _SMALLEST[0] or tree.height < _SMALLEST[1]:
        return tree
    if tree.n_branches < _FEWEST or not is_cut(tree):
        return tree
    first = tree.branch_first[1]
    scanned = float(tree.volume.sum())
    wanted = scanned**SCAN_WEIGHT * wood_volume(diameter, tree.height) ** (1.0 - SCAN_WEIGHT)
    left = wanted - float(tree.volume[:first].sum())
    ratio = math.sqrt(max(left, 0.0) / float(tree.volume[first:].sum()))
    of_segment = np.where(np.arange(tree.n_segments) < first, 1.0, min(max(ratio, _THINNEST), 1.0))
    return replace(
        tree,
        base_diameter=of_segment * tree.base_diameter,
        tip_diameter=of_segment * tree.tip_diameter,
    )
