# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Picture of a tree or several in wind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.leaves import LeafClusters
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.pictures.plotting import new_figure
from tree_sway.pictures.tree_drawing import draw_trees, limits_around

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_HEIGHT = 6.0
"""Height of a picture in [inch]."""


def figure_in_wind(
    trees: Sequence[Tree],
    poses: ArrayLike,
    wind: ArrayLike,
    *,
    leaves: LeafClusters | None = None,
) -> Figure:
    """
    Draw trees in wind over their shape at rest.

    Parameters
    ----------
    trees, poses
        Trees, and the pose block of all their segments, one tree after the other, (n, 7).
    wind
        Wind in [m/s], (3,).
    leaves
        Leaves on these segments; none are drawn if None.

    Raises
    ------
    MissingDependencyError
        If matplotlib is not installed.

    """
    rest = np.vstack([each.rest_poses for each in trees])
    length = np.concatenate([each.length for each in trees])
    limits = limits_around(
        np.vstack([*ends_of_poses(rest, length), *ends_of_poses(poses, length)])
    )
    (left, right), (bottom, top) = limits
    figure = new_figure(_HEIGHT * (right - left) / (top - bottom), _HEIGHT)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_trees(axes, trees, poses, limits, wind=wind, leaves=leaves, has_ghost=True)
    return figure
