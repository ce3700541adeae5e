"""Pictures of a tree, as files: at rest, beside itself in wind, and moving."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.tree import Floats, Tree
from tree_sway_ros.view.plotting import new_figure, save_figure
from tree_sway_ros.view.projection import Camera, ends_of_poses
from tree_sway_ros.view.tree_drawing import Frame, draw_scale, draw_tree, draw_wind, frame_around

_INCHES_HIGH = 6.0


def picture_at_rest(
    tree: Tree, path: str | Path, *, camera: Camera | None = None, title: str | None = None
) -> Path:
    """
    Draw a tree at rest.

    Parameters
    ----------
    tree
        What to draw.
    path
        File to write; the suffix names the format.
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
    draw_tree(axes, tree, tree.start, tree.end, camera, frame)
    draw_scale(axes, frame)
    figure.suptitle(title if title is not None else _caption(tree), y=0.985)
    return save_figure(figure, path)


def picture_in_wind(
    tree: Tree,
    poses: ArrayLike,
    wind: ArrayLike,
    path: str | Path,
    *,
    camera: Camera | None = None,
    title: str | None = None,
) -> Path:
    """
    Draw a tree at rest and, beside it, in wind.

    Parameters
    ----------
    tree
        At rest.
    poses
        Pose block in wind, (n, 7): x y z [m], and the quaternion's x y z w.
    wind
        Where it blows to in [m/s], (3,).
    path, camera, title
        As in `picture_at_rest`.

    Returns
    -------
    Path
        The file.

    """
    camera = camera or Camera()
    start, end = ends_of_poses(poses, tree.length)
    frame = frame_around(np.vstack([tree.start, tree.end, start, end]), camera)
    figure = new_figure(max(2.0 * _INCHES_HIGH * frame.aspect, 6.0), _INCHES_HIGH + 0.4)
    left = figure.add_axes((0.0, 0.0, 0.5, 0.93))
    right = figure.add_axes((0.5, 0.0, 0.5, 0.93))
    draw_tree(left, tree, tree.start, tree.end, camera, frame)
    draw_tree(right, tree, start, end, camera, frame)
    draw_scale(left, frame)
    draw_wind(right, frame, camera, np.asarray(wind, dtype=np.float64))
    left.text(0.03, 0.97, "at rest", transform=left.transAxes, va="top", color="#555555")
    right.text(0.97, 0.97, "in wind", transform=right.transAxes, ha="right", va="top", color="#555555")
    figure.suptitle(title if title is not None else _caption(tree), y=0.985)
    return save_figure(figure, path)


def animate_poses(
    tree: Tree,
    frames: Sequence[ArrayLike],
    winds: ArrayLike,
    path: str | Path,
    *,
    rate: float = 20.0,
    camera: Camera | None = None,
    pixels: int = 480,
) -> Path:
    """
    Draw a moving picture of a tree: GIF, or animated PNG by the suffix ``.png`` or ``.apng``.

    Parameters
    ----------
    tree
        At rest.
    frames
        Pose block of each frame, (n, 7).
    winds
        Wind of each frame in [m/s], (f, 3).
    path
        File to write.
    rate
        Frames a second in [Hz].
    camera
        From where; from the south if None.
    pixels
        Height in [px].

    Returns
    -------
    Path
        The file.

    """
    from PIL import Image

    camera = camera or Camera()
    placed = [ends_of_poses(poses, tree.length) for poses in frames]
    corners = [point for start, end in placed for point in (_box(start), _box(end))]
    frame = frame_around(np.vstack([*corners, _box(tree.start), _box(tree.end)]), camera)
    images = [
        Image.fromarray(_rendered(tree, start, end, wind, camera, frame, pixels))
        for (start, end), wind in zip(placed, np.asarray(winds, dtype=np.float64), strict=True)
    ]
    target = Path(path)
    kind = "GIF" if target.suffix.lower() == ".gif" else "PNG"
    if kind == "GIF":
        palette = images[0].quantize(64)
        images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    images[0].save(
        target, kind, save_all=True, append_images=images[1:], duration=1000.0 / rate, loop=0
    )
    return target


def _caption(tree: Tree) -> str:
    return f"{tree.name}: {tree.n_segments} segments, {tree.height:.2f} m"


def _box(points: Floats) -> Floats:
    """Points that touch each side of the cloud, so that many clouds can be framed at little cost."""
    extremes = [*points.argmin(axis=0), *points.argmax(axis=0)]
    return points[extremes]


def _rendered(
    tree: Tree, start: Floats, end: Floats, wind: Floats, camera: Camera, frame: Frame, pixels: int
) -> np.ndarray:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = new_figure(pixels * frame.aspect / 100.0, pixels / 100.0)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_tree(axes, tree, start, end, camera, frame)
    draw_wind(axes, frame, camera, wind)
    figure.set_dpi(100.0)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
