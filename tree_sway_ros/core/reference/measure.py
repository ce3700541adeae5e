# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How far one model of a tree is from another: tip error over tip motion.

Anything that steps and places will do: the reduced model at any model, and the articulated truth.

"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.tree.tree import Tree


class Swaying(Protocol):
    """What a model of a tree offers to be measured."""

    def step(self, wind: ArrayLike, dt: float, /) -> Any:
        """Advance by dt in [s] under a wind in [m/s], (3,)."""

    def place(self, out: Floats, /) -> Any:
        """Fill the pose block, (n, 7)."""


def tips_of_poses(tree: Tree, poses: Floats, branches: Ints | slice = slice(None)) -> Floats:
    """Tips of some branches, or of all, in [m], (k, 3), from a pose block (n, 7)."""
    last = tree.branch_first[1:][branches] - 1
    x, y, z, w = poses[last, 3:].T
    along = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    tips: Floats = poses[last, :3] + tree.length[last, None] * along
    return tips


def record_tips(
    model: Swaying, tree: Tree, wind: Floats, dt: float, *, substeps: int = 1
) -> Floats:
    """
    Tips over time in [m], (t, b, 3).

    Parameters
    ----------
    model
        What steps and places.
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


def frame_means(time: ArrayLike, velocity: ArrayLike, dt: float) -> Floats:
    """
    Means of a wind record over frames, its samples joined by straight lines, (t, 3).

    Parameters
    ----------
    time
        Of the samples in [s], rising, (m,).
    velocity
        The samples in [m/s], (m, 3).
    dt
        Length of a frame in [s]; the first begins with the first sample, the last ends by the last.

    """
    t, v = np.asarray(time, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    slope = np.diff(v, axis=0) / np.diff(t)[:, None]
    whole = np.vstack(
        [np.zeros(3), np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t)[:, None], axis=0)]
    )
    edge = t[0] + dt * np.arange(int((t[-1] - t[0]) / dt + 1e-9) + 1)
    k = np.clip(np.searchsorted(t, edge, side="right") - 1, 0, len(slope) - 1)
    past = (edge - t[k])[:, None]
    means: Floats = np.diff(whole[k] + v[k] * past + 0.5 * slope[k] * past**2, axis=0) / dt
    return means


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
