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

from tree_sway.core.tree.tree import Tree


def corrected_twigs(tree: Tree, twig_diameter: float, trusted_diameter: float) -> Tree:
    """
    Make what is thinner than a scan can see taper to the diameter of a twig, both in [m].

    From the place where a branch is for good thinner than is trusted, its diameter falls in a
    straight line to that of a twig at its tip, if it is not thinner; it begins no thicker than
    what it sits on. After the idea of Morales & MacFarlane (2024, Forestry), which replaces the
    radii of untrusted cylinders by a taper towards twigs measured by hand.
    """
    base, tip = tree.base_diameter.copy(), tree.tip_diameter.copy()
    for branch in range(tree.n_branches):
        part = tree.segments_of(branch)
        reach = np.concatenate([[0.0], np.cumsum(tree.length[part])])
        trusted = np.flatnonzero(base[part] >= trusted_diameter)
        first = int(trusted[-1]) + 1 if len(trusted) else 0
        if first == len(reach) - 1:
            continue
        widest = float(base[part][first])
        if first > 0:
            widest = min(widest, float(tip[part][first - 1]))
        elif tree.segment_parent[part.start] >= 0:
            widest = min(widest, float(base[tree.segment_parent[part.start]]))
        twig = min(twig_diameter, float(tip[part][-1]))
        widest = max(widest, twig)
        along = (reach - reach[first]) / (reach[-1] - reach[first])
        line = widest + (twig - widest) * along
        base[part][first:], tip[part][first:] = line[first:-1], line[first + 1 :]
    return replace(tree, base_diameter=base, tip_diameter=tip)
