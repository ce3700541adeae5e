# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Diameters that a scan got wrong: a robust taper per branch, and twigs as thin as they are.

A laser sees a twig as thick as its own spot; cylinders thinner than some 5 cm come out too thick
(Demol et al. 2022, Methods in Ecology and Evolution, review such errors), and single ones are far
off.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.tree import Tree

_MOST_POINTS = 400
"""Points of a branch that are fitted; longer branches are thinned evenly."""
_LEAST_DIAMETER = 1e-4


def fitted_taper(tree: Tree) -> Tree:
    """
    Replace the diameters of each branch by a straight taper along it.

    Fitted by the median of the slopes between all pairs of segments (Theil 1950, Sen 1968), which
    up to 29 % of outliers do not move; never widening to the tip. A branch of one segment is left
    as it is.
    """
    base, tip = tree.base_diameter.copy(), tree.tip_diameter.copy()
    for branch in range(tree.n_branches):
        part = tree.segments_of(branch)
        reach = np.concatenate([[0.0], np.cumsum(tree.length[part])])
        if len(reach) < 3:
            continue
        middle = 0.5 * (reach[:-1] + reach[1:])
        slope, at_base = _median_line(middle, 0.5 * (base[part] + tip[part]))
        line = np.maximum(at_base + slope * reach, _LEAST_DIAMETER)
        base[part], tip[part] = line[:-1], line[1:]
    return replace(tree, base_diameter=base, tip_diameter=tip)


def _median_line(x: Floats, y: Floats) -> tuple[float, float]:
    """Slope, at most 0, and value at 0 of the median line."""
    step = -(-len(x) // _MOST_POINTS)
    x, y = x[::step], y[::step]
    i, j = np.triu_indices(len(x), 1)
    slope = min(float(np.median((y[j] - y[i]) / (x[j] - x[i]))), 0.0)
    return slope, float(np.median(y - slope * x))


def corrected_twigs(tree: Tree, twig_diameter: float, trusted_diameter: float) -> Tree:
    """
    Make what is thinner than a scan can see taper to a measured twig diameter, both in [m].

    From the place where a branch first gets thinner than is trusted, its diameter falls in a
    straight line to that of a twig at its tip; it begins no thicker than what it sits on. After
    the idea of Morales & MacFarlane (2024, Forestry), which replaces the radii of untrusted
    cylinders by a taper towards twigs measured by hand.
    """
    base, tip = tree.base_diameter.copy(), tree.tip_diameter.copy()
    for branch in range(tree.n_branches):
        part = tree.segments_of(branch)
        reach = np.concatenate([[0.0], np.cumsum(tree.length[part])])
        thin = np.flatnonzero(base[part] < trusted_diameter)
        if len(thin) == 0:
            continue
        first = int(thin[0])
        widest = float(base[part][first])
        if first > 0:
            widest = min(widest, float(tip[part][first - 1]))
        elif tree.segment_parent[part.start] >= 0:
            widest = min(widest, float(base[tree.segment_parent[part.start]]))
        widest = max(widest, twig_diameter, _LEAST_DIAMETER)
        along = (reach - reach[first]) / (reach[-1] - reach[first])
        line = np.maximum(widest + (twig_diameter - widest) * along, _LEAST_DIAMETER)
        base[part][first:], tip[part][first:] = line[first:-1], line[first + 1 :]
    return replace(tree, base_diameter=base, tip_diameter=tip)
