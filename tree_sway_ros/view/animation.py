# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A moving picture of a tree, as a file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.leaves.flutter import air_speed, flutter_angle, leaf_poses
from tree_sway_ros.core.leaves.foliage import LeafClusters
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import FormatError, MissingDependencyError, ParameterError
from tree_sway_ros.files.whole_file import whole_file
from tree_sway_ros.view.plotting import new_figure
from tree_sway_ros.view.projection import Camera, ends_of_poses
from tree_sway_ros.view.tree_drawing import Frame, draw_tree, draw_wind, frame_around

_KINDS = {".gif": "GIF", ".png": "PNG", ".apng": "PNG"}
_GIF_COLORS = 64


def animate_poses(
    tree: Tree,
    frames: Sequence[ArrayLike],
    winds: ArrayLike,
    path: str | Path,
    *,
    rate: float = 20.0,
    leaves: LeafClusters | None = None,
    camera: Camera | None = None,
    pixels: int = 480,
) -> Path:
    """
    Draw a moving picture: a GIF, or an animated PNG, by the suffix.

    Parameters
    ----------
    tree
        At rest.
    frames
        Pose block of each frame, (n, 7).
    winds
        Wind of each frame in [m/s], (f, 3).
    path
        File to write: ``.gif``, ``.png`` or ``.apng``.
    rate
        Frames a second in [Hz].
    leaves
        Its leaves; none are drawn if None.
    camera
        From where; from the south if None.
    pixels
        Height in [px].

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ParameterError
        If there are no frames, or not as many winds.
    FormatError
        If the suffix names no moving picture, or the file cannot be written.
    MissingDependencyError
        If matplotlib or pillow is not there.

    """
    target = Path(path)
    kind = _KINDS.get(target.suffix.lower())
    if kind is None:
        raise FormatError(
            f"'{target.suffix}' is no moving picture",
            where=str(target),
            cure=f"end the name with one of: {', '.join(_KINDS)}",
        )
    blowing = np.asarray(winds, dtype=np.float64)
    if len(frames) == 0 or blowing.shape != (len(frames), 3):
        raise ParameterError(
            f"{len(frames)} frames and winds {blowing.shape} do not go together",
            cure="give one wind (3,) a frame, and at least one frame",
        )
    try:
        from PIL import Image
    except ImportError:
        raise MissingDependencyError(
            "moving pictures need pillow", cure="pip install pillow"
        ) from None
    camera = camera or Camera()
    blocks = [np.asarray(poses, dtype=np.float64) for poses in frames]
    frame = _frame_of_all(tree, blocks, camera)
    images = []
    for i, (block, wind) in enumerate(zip(blocks, blowing, strict=True)):
        foliage = None
        if leaves is not None:
            foliage = _fluttering(leaves, block, blocks[max(i - 1, 0)], wind, i, rate), leaves.size
        start, end = ends_of_poses(block, tree.length)
        images.append(
            Image.fromarray(_rendered(tree, start, end, wind, foliage, camera, frame, pixels))
        )
    if kind == "GIF":
        palette = images[len(images) // 2].quantize(_GIF_COLORS)
        images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    with whole_file(target) as partial:
        images[0].save(
            partial, kind, save_all=True, append_images=images[1:], duration=1000.0 / rate, loop=0
        )
    return target


def _frame_of_all(tree: Tree, blocks: list[Floats], camera: Camera) -> Frame:
    """Frame that holds the tree at rest and in every frame."""
    corners = [_box(tree.start), _box(tree.end)]
    for block in blocks:
        corners += [_box(points) for points in ends_of_poses(block, tree.length)]
    return frame_around(np.vstack(corners), camera, headroom=0.1)


def _box(points: Floats) -> Floats:
    """Points that touch each side of the cloud, so that many clouds are framed at little cost."""
    return points[[*points.argmin(axis=0), *points.argmax(axis=0)]]


def _fluttering(
    leaves: LeafClusters, block: Floats, before: Floats, wind: Floats, step: int, rate: float
) -> Floats:
    """Pose block of the leaves in the air that passes them."""
    now, then = (leaf_poses(leaves, poses)[:, :3] for poses in (block, before))
    speed = air_speed(now, then, 1.0 / rate, wind)
    return leaf_poses(leaves, block, flutter_angle(leaves, speed, step / rate))


def _rendered(
    tree: Tree,
    start: Floats,
    end: Floats,
    wind: Floats,
    foliage: tuple[Floats, Floats] | None,
    camera: Camera,
    frame: Frame,
    pixels: int,
) -> NDArray[np.uint8]:
    figure = new_figure(pixels * frame.aspect / 100.0, pixels / 100.0)
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_tree(axes, tree, start, end, camera, frame, foliage)
    draw_wind(axes, frame, camera, wind)
    figure.set_dpi(100.0)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
