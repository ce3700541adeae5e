# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Picture of a tree or several in wind, as a file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.leaves.flutter import flutter_angle
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError
from tree_sway.files.whole_file import whole_file
from tree_sway.pictures.painter import Painter
from tree_sway.pictures.projection import Camera, frame_around

_PIXELS = 660


def picture_in_wind(
    trees: Sequence[Tree],
    poses: ArrayLike,
    wind: ArrayLike,
    path: str | Path,
    *,
    leaves: LeafClusters | None = None,
) -> Path:
    """
    Draw a tree, or several, in wind, with the shape at rest behind it.

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

    """
    blowing = np.asarray(wind, dtype=np.float64)
    rest = np.vstack([each.rest_poses for each in trees])
    length = np.concatenate([each.length for each in trees])
    nodes = [*ends_of_poses(rest, length), *ends_of_poses(poses, length)]
    camera = Camera()
    painter = Painter(trees, camera, frame_around(np.vstack(nodes), camera, headroom=0.1), _PIXELS)
    angle = 0.0 if leaves is None else flutter_angle(leaves, float(np.linalg.norm(blowing)), 0.0)
    image = painter.image(poses, blowing, leaves, angle, has_ghost=True)
    target = Path(path)
    with whole_file(target) as partial:
        try:
            image.save(partial)
        except ValueError:
            what = f"'{target.suffix}' is no picture format"
            raise FormatError(what, where=str(target), cure='name a .png, .jpg or .pdf') from None
    return target
