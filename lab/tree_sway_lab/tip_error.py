# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How far one model of a tree is from another: tip error over tip motion, and roughness.

Anything that steps and places can be measured: the reduced-order tree on any model, and the
articulated truth.

"""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import tips_of_poses, Tree


class Swaying(Protocol):
    """What a model of a tree offers to be measured."""

    def step(self, wind: ArrayLike, dt: float, /) -> Any:
        """Advance by dt in [s] under a wind in [m/s], (3,)."""

    def place(self, out: Floats, /) -> Any:
        """Fill the pose block, (n, 7)."""


def record_tips(
    model: Swaying, tree: Tree, wind: Floats, dt: float, *, substeps: int = 1
) -> Floats:
    """
    Tips over time in [m], (t, b, 3).

    Parameters
    ----------
    model
        Simulator that steps and places the tree.
    tree
        The tree it is a model of.
    wind
        Mean of the wind over each frame in [m/s], (t, 3).
    dt
        Length of a frame in [s].
    substeps
        Steps per frame, all in the same wind.

    """
    poses = np.empty((tree.n_segments, 7))
    tips = np.empty((len(wind), tree.n_branches, 3))
    for frame, blowing in enumerate(wind):
        for _ in range(substeps):
            model.step(blowing, dt / substeps)
        model.place(poses)
        tips[frame] = tips_of_poses(tree, poses)
    return tips


def tip_error(tree: Tree, tips: Floats, truth: Floats) -> float:
    """
    Tip error over tip motion in [-].

    Root mean square over time and tips of the distance between the two, over that of the true tips
    from rest: a model that does not move at all scores 1.

    Parameters
    ----------
    tree
        The tree at rest.
    tips, truth
        Tips over time in [m], (t, b, 3).

    """
    rest = tree.end[tree.branch_first[1:] - 1]
    motion = np.sum((truth - rest) ** 2)
    return float(np.sqrt(np.sum((tips - truth) ** 2) / motion))


def roughness(tips: Floats, truth: Floats) -> float:
    """Second difference of tips (t, b, 3) over the truth's, both root mean square, in [-]."""
    mine, true = (np.square(np.diff(each, 2, axis=0)).sum() for each in (tips, truth))
    return float(np.sqrt(mine / true)) if true > 0.0 else math.nan
