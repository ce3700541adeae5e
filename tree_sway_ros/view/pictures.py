"""Pictures of a tree, as files: at rest, and beside itself in wind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.leaf_flutter import flutter_angle, leaf_poses
from tree_sway_ros.core.leaves import LeafClusters
from tree_sway_ros.core.tree import Floats, Tree
from tree_sway_ros.view.plotting import new_figure, save_figure
from tree_sway_ros.view.projection import Camera, ends_of_poses, rest_poses
from tree_sway_ros.view.tree_drawing import (
    draw_ghost,
    draw_scale,
    draw_tree,
    draw_wind,
    frame_around,
)

_INCHES_HIGH = 6.0


def picture_at_rest(
    tree: Tree,
    path: str | Path,
    *,
    leaves: LeafClusters | None = None,
    camera: Camera | None = None,
    title: str | None = None,
) -> Path:
    """
    Draw a tree at rest.

    Parameters
    ----------
    tree
        What to draw.
    path
        File to write; the suffix names the format.
    leaves
        Its leaves; none are drawn if None.
    camera
        From where; from the south, east to the right, if None.
    title
        Above the picture; the tree's name and counts if None.

    Returns
    -------
    Path
        The file.

    """
    camera = camera or Camera()
    frame = frame_around(np.vstack([tree.start, tree.end]), camera)
    figure = new_figure(max(_INCHES_HIGH * frame.aspect, 3.6), _INCHES_HIGH + 0.4)
    axes = figure.add_axes((0.0, 0.0, 1.0, 0.93))
    draw_tree(axes, tree, tree.start, tree.end, camera, frame, _leaves_at_rest(tree, leaves))
    draw_scale(axes, frame)
    figure.suptitle(title if title is not None else _caption(tree), y=0.985)
    return save_figure(figure, path)


def picture_in_wind(
    tree: Tree,
    poses: ArrayLike,
    wind: ArrayLike,
    path: str | Path,
    *,
    leaves: LeafClusters | None = None,
    camera: Camera | None = None,
    title: str | None = None,
) -> Path:
    """
    Draw a tree at rest and, beside it, in wind; there with its shape at rest behind it.

    Parameters
    ----------
    tree
        At rest.
    poses
        Pose block in wind, (n, 7): x y z [m], and the quaternion's x y z w.
    wind
        Where it blows to in [m/s], (3,).
    path, leaves, camera, title
        As in `picture_at_rest`.

    Returns
    -------
    Path
        The file.

    """
    camera = camera or Camera()
    start, end = ends_of_poses(poses, tree.length)
    frame = frame_around(np.vstack([tree.start, tree.end, start, end]), camera, headroom=0.1)
    figure = new_figure(max(2.0 * _INCHES_HIGH * frame.aspect, 6.0), _INCHES_HIGH + 0.4)
    left = figure.add_axes((0.0, 0.0, 0.5, 0.93))
    right = figure.add_axes((0.5, 0.0, 0.5, 0.93))
    blowing = np.asarray(wind, dtype=np.float64)
    fluttering = _leaves_in_wind(leaves, np.asarray(poses, dtype=np.float64), blowing, 0.0)
    draw_tree(left, tree, tree.start, tree.end, camera, frame, _leaves_at_rest(tree, leaves))
    draw_ghost(right, tree, camera)
    draw_tree(right, tree, start, end, camera, frame, fluttering)
    draw_scale(left, frame)
    draw_wind(right, frame, camera, blowing)
    left.text(0.03, 0.97, "at rest", transform=left.transAxes, va="top", color="#555555")
    right.text(0.97, 0.97, "in wind", transform=right.transAxes, ha="right", va="top", color="#555555")
    figure.suptitle(title if title is not None else _caption(tree), y=0.985)
    return save_figure(figure, path)


def _leaves_at_rest(tree: Tree, leaves: LeafClusters | None) -> tuple[Floats, Floats] | None:
    poses = rest_poses(tree.start, tree.end)
    return None if leaves is None else (leaf_poses(leaves, poses), leaves.size)


def _leaves_in_wind(
    leaves: LeafClusters | None, poses: Floats, wind: Floats, time: float
) -> tuple[Floats, Floats] | None:
    if leaves is None:
        return None
    angle = flutter_angle(leaves, float(np.linalg.norm(wind)), time)
    return leaf_poses(leaves, poses, angle), leaves.size


def _caption(tree: Tree) -> str:
    return f"{tree.name}: {tree.n_segments} segments, {tree.height:.2f} m"
