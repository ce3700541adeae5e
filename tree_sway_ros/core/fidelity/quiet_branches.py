# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Which branches hardly move on their parents: those that may be frozen.

A branch is judged with all it carries: by how far the tips of its subtree go in a turbulent wind
from any side, less what they would go as one body with its base. Sets of branches are nested; each
is the largest whose freezing costs no more than a given share of the motion of the whole tree.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tree_sway_ros.core.arrays import Floats, Records
from tree_sway_ros.core.motion.response import base_motion, carried_to, Complexes, tip_motion
from tree_sway_ros.core.reduction.pruning import Bools, Pruning
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.climate import WindClimate


def quiet_sets(
    tree: Tree,
    branches: Records,
    rotations: Complexes,
    frequencies: Floats,
    shares: Sequence[float],
) -> list[Bools]:
    """
    Find the branches (b,) to freeze for each share of the tips' motion that the error may be.

    With each branch goes all that it carries. Rotations are the `key_response` (N, 2, f) at
    frequencies in [Hz], (f,), the first of them 0.
    """
    swing, motion = _swings(tree, branches, rotations * np.sqrt(_weights(frequencies)))
    per_tip = swing / (tree.subtree_end - np.arange(tree.n_branches))
    order = np.sort(per_tip[1:])
    return [_largest(tree, swing, per_tip, order, share**2 * motion) for share in shares]


def _largest(tree: Tree, swing: Floats, per_tip: Floats, order: Floats, allowed: float) -> Bools:
    """Bisect for the highest threshold per tip at which the frozen subtrees swing as allowed."""
    low, high = 0, len(order)  # so many of the quietest may surely, may perhaps be frozen
    quiet = np.zeros(tree.n_branches, dtype=np.bool_)
    while low < high:
        middle = (low + high + 1) // 2
        pruning = Pruning(tree, per_tip <= order[middle - 1])
        if swing[pruning.tops].sum() <= allowed:
            low, quiet = middle, pruning.frozen
        else:
            high = middle - 1
    return quiet


def _swings(tree: Tree, branches: Records, rotations: Complexes) -> tuple[Floats, float]:
    """Sum squared displacements of tips: of each subtree from its base, (b,), of all in space."""
    base, tips = base_motion(branches, rotations), tip_motion(branches, rotations)
    swing = np.zeros(tree.n_branches)
    for branch in range(tree.n_branches):
        those = slice(branch, int(tree.subtree_end[branch]))
        body = np.broadcast_to(base[branch], (those.stop - branch, *base.shape[1:]))
        own = tips[those] - carried_to(body, branches['tip'][those])
        swing[branch] = np.square(np.abs(own)).sum()
    return swing, float(swing[0])


def _weights(frequencies: Floats) -> Floats:
    """Mean square (f,) of the load at each frequency, in a wind of intensity 0.2 from any side."""
    climate = WindClimate.steady(1.0, 0.2)
    weights: Floats = np.trace(climate.power(frequencies), axis1=1, axis2=2)
    weights[0] += np.square(climate.mean).sum()
    return weights
