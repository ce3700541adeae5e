# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a tree or several, as files: at rest, and beside themselves in wind."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.flutter import flutter_angle, leaf_poses
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.pose_ends import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.pictures.plotting import new_figure, save_figure
from tree_sway.pictures.projection import Camera
from tree_sway.pictures.tree_drawing import (
    draw_ghost,
    draw_scale,
    draw_tree,
    draw_wind,
    Frame,
    frame_around,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_INCHES_HIGH = 6.0
_INCHES_WIDE = 9.0
_WIDE = 1.3
"""Width over height from which a tree in wind is drawn below what rests, not beside."""


def picture_in_wind(
    tree: Tree | Sequence[Tree],
    poses: ArrayLike,
    wind: ArrayLike,
    path: str | Path,
    *,
    leaves: LeafClusters | None = None,
    camera: Camera | None = None,
    title: str | None = None,
) -> Path:
    """
    Draw a tree, or several, at rest and beside it in wind, there with the shape at rest behind it.

    Parameters
    ----------
    tree
        The tree or trees.
    poses
        Pose block in wind of all of them, (n, 7): x y z [m], and the quaternion's x y z w.
    wind
        Where it blows to in [m/s], (3,).
    path
        File to write; the suffix names the format.
    leaves
        Their leaves, on segments counted through all trees; none are drawn if None.
    camera
        From where; from the south, east to the right, if None.
    title
        Above the picture; the trees' name and counts if None.

    """
    camera = camera or Camera()
    trees = _listed(tree)
    block, blowing = (np.asarray(each, dtype=np.float64) for each in (poses, wind))
    start, end = _nodes(trees)
    moved = ends_of_poses(block, np.concatenate([each.length for each in trees]))
    frame = frame_around(np.vstack([start, end, *moved]), camera, headroom=0.1)
    figure, rest, windy = _two_axes(frame)
    _draw(rest, trees, np.vstack([each.rest_poses for each in trees]), camera, frame, leaves)
    for each in trees:
        draw_ghost(windy, each, camera)
    angle = 0.0 if leaves is None else flutter_angle(leaves, float(np.linalg.norm(blowing)), 0.0)
    _draw(windy, trees, block, camera, frame, leaves, angle)
    draw_scale(rest, frame)
    draw_wind(windy, frame, camera, blowing)
    rest.text(0.03, 0.97, 'at rest', transform=rest.transAxes, va='top', color='#555555')
    windy.text(
        0.97, 0.97, 'in wind', transform=windy.transAxes, ha='right', va='top', color='#555555'
    )
    figure.suptitle(title if title is not None else _caption(trees), y=0.985)
    return save_figure(figure, path)


def _two_axes(frame: Frame) -> tuple[Figure, Axes, Axes]:
    """Beside each other, or what is wide one above the other."""
    if frame.aspect <= _WIDE:
        figure = new_figure(max(2.0 * _INCHES_HIGH * frame.aspect, 6.0), _INCHES_HIGH + 0.4)
        left, right = (figure.add_axes((x, 0.0, 0.5, 0.93)) for x in (0.0, 0.5))
        return figure, left, right
    figure = new_figure(_INCHES_WIDE, 2.0 * _INCHES_WIDE / frame.aspect + 0.4)
    upper, lower = figure.add_axes((0.0, 0.47, 1.0, 0.47)), figure.add_axes((0.0, 0.0, 1.0, 0.47))
    return figure, upper, lower


def _draw(
    axes: Axes,
    trees: tuple[Tree, ...],
    poses: Floats,
    camera: Camera,
    frame: Frame,
    leaves: LeafClusters | None,
    flutter: ArrayLike = 0.0,
) -> None:
    """Draw every tree in its poses, those in front last."""
    ends = list(accumulate((each.n_segments for each in trees), initial=0))
    blocks = None if leaves is None else (leaf_poses(leaves, poses, flutter), leaves.size)
    far_first = sorted(range(len(trees)), key=lambda i: -float(camera.distance(trees[i].start[0])))
    for i in far_first:
        own = None
        if leaves is not None and blocks is not None:
            of_this = (leaves.segment >= ends[i]) & (leaves.segment < ends[i + 1])
            own = blocks[0][of_this], blocks[1][of_this]
        start, end = ends_of_poses(poses[ends[i] : ends[i + 1]], trees[i].length)
        draw_tree(axes, trees[i], start, end, camera, frame, own)


def _listed(tree: Tree | Sequence[Tree]) -> tuple[Tree, ...]:
    return (tree,) if isinstance(tree, Tree) else tuple(tree)


def _nodes(trees: tuple[Tree, ...]) -> tuple[Floats, Floats]:
    """Root-side and tip-side nodes of all segments at rest in [m], (n, 3) each."""
    start = np.concatenate([each.start for each in trees])
    return start, np.concatenate([each.end for each in trees])


def _caption(trees: tuple[Tree, ...]) -> str:
    segments = sum(each.n_segments for each in trees)
    if len(trees) > 1:
        return f'{len(trees)} trees: {segments} segments'
    return f'{trees[0].name}: {segments} segments, {trees[0].height:.2f} m'
