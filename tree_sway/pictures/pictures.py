# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a tree or several, as files: at rest, and beside themselves in wind."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.leaves.flutter import flutter_angle
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.pictures.painter import Painter
from tree_sway.pictures.plotting import DOTS_PER_INCH, new_figure, save_figure, show_image
from tree_sway.pictures.projection import Camera, frame_around

_PIXELS, _WIDEST, _TITLE = 660, 990, 48
"""Height of a tree's image, width of a wide one, and height of the title above them [px]."""
_WIDE = 1.3
"""Width over height from which a tree in wind is drawn below what rests, not beside."""


def picture_in_wind(
    trees: Sequence[Tree],
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
    trees
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
    blowing = np.asarray(wind, dtype=np.float64)
    rest = np.vstack([each.rest_poses for each in trees])
    length = np.concatenate([each.length for each in trees])
    nodes = [*ends_of_poses(rest, length), *ends_of_poses(poses, length)]
    frame = frame_around(np.vstack(nodes), camera, headroom=0.1)
    is_wide = frame.aspect > _WIDE
    pixels = round(_WIDEST / frame.aspect) if is_wide else _PIXELS
    painter = Painter(trees, camera, frame, pixels)
    angle = 0.0 if leaves is None else flutter_angle(leaves, float(np.linalg.norm(blowing)), 0.0)
    still = painter.image(rest, leaves=leaves, has_scale=True)
    moved = painter.image(poses, blowing, leaves, angle, has_ghost=True)
    width, height = painter.size
    columns, rows = (1, 2) if is_wide else (2, 1)
    whole = rows * height + _TITLE
    figure = new_figure(columns * width / DOTS_PER_INCH, whole / DOTS_PER_INCH)
    share = height / whole
    for place, (image, text) in enumerate(((still, 'at rest'), (moved, 'in wind'))):
        left = 0.0 if is_wide else 0.5 * place
        low = share * (1 - place) if is_wide else 0.0
        axes = figure.add_axes((left, low, 1.0 / columns, share))
        show_image(axes, image)
        axes.text(0.97, 0.97, text, transform=axes.transAxes, ha='right', va='top', color='0.33')
    figure.suptitle(title if title is not None else _caption(trees), y=0.985)
    return save_figure(figure, path)


def _caption(trees: Sequence[Tree]) -> str:
    segments = sum(each.n_segments for each in trees)
    if len(trees) > 1:
        return f'{len(trees)} trees: {segments} segments'
    return f'{trees[0].name}: {segments} segments, {trees[0].height:.2f} m'
