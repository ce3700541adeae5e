# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Twigs that copy: of many alike, the necessary few are solved and the others reuse their solution.

The paper's rule (Kanda & Ohya, 3.3) made definite: a branch of one segment that carries nothing
copies another such on the same parent whose length, thickness and direction agree with its own to
a tolerance.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Ints
from tree_sway.core.tree import Tree


def twig_sources(tree: Tree, tolerance: float) -> Ints:
    """
    Find for each branch the one, at or before it, whose motion it copies; its own if solved, (b,).

    The tolerance is the relative difference in length and diameter, and the angle between
    directions in [rad], up to which two twigs are alike; 0 copies only equals, a negative one
    nothing.
    """
    source = np.arange(tree.n_branches, dtype=np.int64)
    if tolerance < 0.0:
        return source
    direction, solved = tree.direction, dict[int, list[int]]()
    for branch in range(1, tree.n_branches):
        first = int(tree.branch_first[branch])
        if tree.branch_first[branch + 1] - first > 1 or tree.subtree_end[branch] - branch > 1:
            continue
        models = solved.setdefault(int(tree.branch_parent[branch]), [])
        for model in models:
            other = int(tree.branch_first[model])
            if (
                _alike(tree.length[first], tree.length[other], tolerance)
                and _alike(tree.base_diameter[first], tree.base_diameter[other], tolerance)
                and _alike(tree.tip_diameter[first], tree.tip_diameter[other], tolerance)
                and np.linalg.norm(direction[first] - direction[other]) <= tolerance + 1e-12
            ):
                source[branch] = model
                break
        else:
            models.append(branch)
    return source


def _alike(a: float, b: float, tolerance: float) -> bool:
    return bool(abs(a - b) <= (tolerance + 1e-12) * max(a, b))
