# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A moving picture of a tree, as a file: a GIF, or a film by ffmpeg."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.flutter import air_speed, flutter_angle, leaf_poses
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.whole_file import whole_file
from tree_sway.pictures.painter import Painter
from tree_sway.pictures.projection import Camera, Frame, frame_around

_SUFFIXES = ('.gif', '.mp4')
_GIF_COLORS = 64


def check_film(path: str | Path) -> Path:
    """
    Return the path of a moving picture if one can be written.

    Raises
    ------
    FormatError
        If the suffix names no moving picture.
    ModuleNotFoundError
        If pillow, or imageio-ffmpeg for a film, is not installed.

    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in _SUFFIXES:
        raise FormatError(
            f"'{target.suffix}' is no moving picture",
            where=str(target),
            cure=f'end the name with one of: {", ".join(_SUFFIXES)}',
        )
    for module in ('PIL', 'imageio_ffmpeg')[: 1 + (suffix == '.mp4')]:
        import_module(module)
    return target


def animate_poses(
    tree: Tree,
    frames: Sequence[ArrayLike],
    winds: ArrayLike,
    path: str | Path,
    *,
    rate: float = 20.0,
    leaves: LeafClusters | None = None,
    pixels: int = 480,
) -> Path:
    """
    Draw a moving picture: a GIF or a film, by the suffix.

    Parameters
    ----------
    tree, leaves
        The tree, and its leaves; none are drawn if None.
    frames
        Pose block of each frame, (n, 7).
    winds
        Wind of each frame in [m/s], (f, 3).
    path
        File to write: ``.gif`` or ``.mp4``.
    rate
        Frames per second in [Hz].
    pixels
        Height in [px].

    Raises
    ------
    ParameterError
        If there are no frames, or not as many winds.
    FormatError
        If the file cannot be written; and as `check_film`.

    """
    target = check_film(path)
    blowing = np.asarray(winds, dtype=np.float64)
    if len(frames) == 0 or blowing.shape != (len(frames), 3):
        raise ParameterError(
            f'{len(frames)} frames and winds {blowing.shape} do not go together',
            cure='give one wind (3,) a frame, and at least one frame',
        )
    camera = Camera()
    blocks = [np.asarray(poses, dtype=np.float64) for poses in frames]
    painter = Painter([tree], camera, _frame_of_all(tree, blocks, camera), pixels)

    def images() -> Iterator[Any]:
        for i, (block, wind) in enumerate(zip(blocks, blowing, strict=True)):
            angle: ArrayLike = 0.0
            if leaves is not None:
                now, then = (
                    leaf_poses(leaves, poses)[:, :3] for poses in (block, blocks[max(i - 1, 0)])
                )
                angle = flutter_angle(leaves, air_speed(now, then, 1.0 / rate, wind), i / rate)
            yield painter.image(block, wind, leaves, angle)

    with whole_file(target) as partial:
        if target.suffix.lower() == '.gif':
            _write_gif(partial, images(), rate)
        else:
            _write_film(partial, images(), painter.size, rate)
    return target


def _write_gif(path: Path, images: Iterator[Any], rate: float) -> None:
    first = next(images).quantize(_GIF_COLORS)
    # No dither: dots that dance are no motion.
    others = (image.quantize(palette=first, dither=0) for image in images)
    first.save(path, 'GIF', save_all=True, append_images=others, duration=1000.0 / rate, loop=0)


def _write_film(path: Path, images: Iterator[Any], size: tuple[int, int], rate: float) -> None:
    """Have ffmpeg write what is painted, frame after frame."""
    from imageio_ffmpeg import write_frames

    film = write_frames(
        path, size, fps=rate, macro_block_size=2, output_params=['-movflags', '+faststart']
    )
    film.send(None)  # starts ffmpeg
    for image in images:
        film.send(image.tobytes())
    film.close()


def _frame_of_all(tree: Tree, blocks: list[Floats], camera: Camera) -> Frame:
    """Frame that holds the tree at rest and in every frame."""
    corners = [_box(tree.start), _box(tree.end)]
    for block in blocks:
        corners += [_box(points) for points in ends_of_poses(block, tree.length)]
    return frame_around(np.vstack(corners), camera, headroom=0.1)


def _box(points: Floats) -> Floats:
    """Points that touch each side of the cloud, so that many clouds are framed at little cost."""
    return points[[*points.argmin(axis=0), *points.argmax(axis=0)]]
