# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A moving picture of a tree, as a file: GIF, WebP, or a film by ffmpeg."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
import itertools
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import flutter_angle, LeafClusters
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files import whole_file
from tree_sway.pictures.plotting import new_figure
from tree_sway.pictures.tree_drawing import draw_trees, limits_around

_SUFFIXES = ('.gif', '.webp', '.mp4')
_GIF_COLORS = 64
_WEBP_QUALITY = 50
_DOTS_PER_INCH = 128.0
"""A power of two, so that no number of points is lost to rounding."""


def check_film(path: str | Path) -> Path:
    """
    Return the path of a moving picture if one can be written.

    Raises
    ------
    FormatError
        If the suffix is not that of a moving picture.
    ModuleNotFoundError
        If matplotlib, Pillow, or imageio-ffmpeg for a film, is not installed.

    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in _SUFFIXES:
        raise FormatError(
            f"'{target.suffix}' is no moving picture",
            where=str(target),
            cure=f'end the name with one of: {", ".join(_SUFFIXES)}',
        )
    import_module('matplotlib')
    import_module('PIL')
    if suffix == '.mp4':
        import_module('imageio_ffmpeg')
    return target


def animate_poses(
    tree: Tree, frames: Sequence[ArrayLike], winds: ArrayLike, path: str | Path, *,
    rate: float = 20.0, leaves: LeafClusters | None = None, pixels: int = 480,
) -> Path:  # fmt: skip
    """
    Draw a moving picture: GIF, WebP or a film, by the suffix.

    Parameters
    ----------
    tree, leaves
        Tree, and its leaves; none are drawn if None.
    frames
        Pose block of each frame, (n, 7).
    winds
        Wind of each frame in [m/s], (f, 3).
    path
        File to write: ``.gif``, ``.webp`` or ``.mp4``.
    rate
        Frames per second in [Hz].
    pixels
        Height in [px].

    Raises
    ------
    ParameterError
        If there are no frames, or not as many winds.
    FormatError
        If the file cannot be written, or an error of `check_film`.

    """
    target = check_film(path)
    blowing = np.asarray(winds, dtype=np.float64)
    if len(frames) == 0 or blowing.shape != (len(frames), 3):
        raise ParameterError(
            f'{len(frames)} frames and winds {blowing.shape} do not match',
            cure='give one wind (3,) a frame, and at least one frame',
        )
    blocks = [np.asarray(poses, dtype=np.float64) for poses in frames]
    corners = [_box(tree.start), _box(tree.end)]
    for block in blocks:
        start, end = ends_of_poses(block, tree.length)
        corners += [_box(start), _box(end)]
    limits = limits_around(np.vstack(corners))
    (left, right), (bottom, top) = limits
    # Films need even numbers of points.
    half_height = 0.5 * pixels
    width = 2 * round(half_height * (right - left) / (top - bottom))
    height = 2 * round(half_height)
    figure = new_figure(width / _DOTS_PER_INCH, height / _DOTS_PER_INCH)
    figure.set_dpi(_DOTS_PER_INCH)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))

    def images() -> Iterator[Any]:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from PIL import Image

        canvas = FigureCanvasAgg(figure)
        for number, (block, wind) in enumerate(zip(blocks, blowing, strict=True)):
            angle: ArrayLike = 0.0
            if leaves is not None:
                speed = float(np.linalg.norm(wind))
                angle = flutter_angle(leaves, speed, number / rate)
            draw_trees(axes, [tree], block, limits, wind=wind, leaves=leaves, flutter=angle)
            canvas.draw()
            painted = np.asarray(canvas.buffer_rgba())
            yield Image.fromarray(painted[..., :3].copy())

    return write_pictures(images(), target, rate)


def write_pictures(images: Iterator[Any], target: Path, rate: float) -> Path:
    """Write pictures of Pillow, all of one even size, as their suffix says, at a rate in [Hz]."""
    with whole_file(target) as partial:
        write = {'.gif': _write_gif, '.webp': _write_webp, '.mp4': _write_film}
        write[target.suffix.lower()](partial, images, rate)
    return target


def _write_gif(path: Path, images: Iterator[Any], rate: float) -> None:
    first = next(images).quantize(_GIF_COLORS)
    # Without dither, whose dots would flicker.
    others = (image.quantize(palette=first, dither=0) for image in images)
    first.save(path, 'GIF', save_all=True, append_images=others, duration=1000.0 / rate, loop=0)


def _write_webp(path: Path, images: Iterator[Any], rate: float) -> None:
    duration = round(1000.0 / rate)
    next(images).save(
        path, 'WEBP', save_all=True, append_images=images, duration=duration, loop=0,
        quality=_WEBP_QUALITY, method=6,
    )  # fmt: skip


def _write_film(path: Path, images: Iterator[Any], rate: float) -> None:
    """Write painted frames by ffmpeg."""
    from imageio_ffmpeg import write_frames

    first = next(images)
    film = write_frames(
        path, first.size, fps=rate, macro_block_size=2, output_params=['-movflags', '+faststart']
    )
    film.send(None)  # starts ffmpeg
    for image in itertools.chain([first], images):
        film.send(image.tobytes())
    film.close()


def _box(points: Floats) -> Floats:
    """Extreme points of the cloud, so that many clouds are framed at low cost."""
    return points[[*points.argmin(axis=0), *points.argmax(axis=0)]]
