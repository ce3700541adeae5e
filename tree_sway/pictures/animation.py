# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A moving picture of a tree, as a file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
import shutil
import subprocess
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.flutter import air_speed, flutter_angle, leaf_poses
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError, MissingDependencyError, ParameterError
from tree_sway.files.whole_file import whole_file
from tree_sway.pictures.painter import Painter
from tree_sway.pictures.projection import Camera, Frame, frame_around

_SUFFIXES = ('.gif', '.mp4')
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
    watched: Callable[[Iterator[Any], int], Iterator[Any]] | None = None,
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
        File to write: ``.gif`` or ``.mp4`` (by ffmpeg).
    rate
        Frames per second in [Hz].
    camera
        From where; from the south if None.
    pixels
        Height in [px].
    watched
        Given the images and how many there will be, gives them on; to show how far the work is.

    Raises
    ------
    ParameterError
        If there are no frames, or not as many winds.
    FormatError
        If the suffix names no moving picture, or the file cannot be written.
    MissingDependencyError
        If pillow, or ffmpeg for a film, is not there.

    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in _SUFFIXES:
        raise FormatError(
            f"'{target.suffix}' is no moving picture",
            where=str(target),
            cure=f'end the name with one of: {", ".join(_SUFFIXES)}',
        )
    blowing = np.asarray(winds, dtype=np.float64)
    if len(frames) == 0 or blowing.shape != (len(frames), 3):
        raise ParameterError(
            f'{len(frames)} frames and winds {blowing.shape} do not go together',
            cure='give one wind (3,) a frame, and at least one frame',
        )
    camera = camera or Camera()
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

    shown = images() if watched is None else watched(images(), len(blocks))
    if suffix == '.gif':
        _write_gif(target, shown, rate)
    else:
        _write_film(target, shown, painter.size, rate)
    return target


def _write_gif(target: Path, images: Iterator[Any], rate: float) -> None:
    first = next(images).quantize(_GIF_COLORS)
    # No dither: dots that dance are no motion.
    others = (image.quantize(palette=first, dither=0) for image in images)
    with whole_file(target) as partial:
        first.save(
            partial, 'GIF', save_all=True, append_images=others, duration=1000.0 / rate, loop=0
        )


def _write_film(target: Path, images: Iterator[Any], size: tuple[int, int], rate: float) -> None:
    """Have ffmpeg write what is painted, frame after frame."""
    program = shutil.which('ffmpeg')
    if program is None:
        raise MissingDependencyError(
            'films need ffmpeg, which is not installed',
            where=str(target),
            cure='install ffmpeg, or name a .gif',
        )
    wide, high = size
    given = ['-f', 'rawvideo', '-pix_fmt', 'rgb24', '-s', f'{wide}x{high}', '-r', f'{rate:g}']
    with whole_file(target) as partial:
        command = [program, '-v', 'error', '-y', *given, '-i', '-', '-pix_fmt', 'yuv420p']
        command += ['-movflags', '+faststart', '-f', 'mp4', str(partial)]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
        assert process.stdin is not None
        try:
            for image in images:
                process.stdin.write(image.tobytes())
        except BrokenPipeError:
            pass  # it says why below
        _, output = process.communicate()
        if process.returncode:
            reason = output.decode(errors='replace').strip().splitlines()
            raise FormatError(
                f'ffmpeg: {reason[-1] if reason else "failed"}',
                where=str(target),
                cure='name a .gif',
            )


def _frame_of_all(tree: Tree, blocks: list[Floats], camera: Camera) -> Frame:
    """Frame that holds the tree at rest and in every frame."""
    corners = [_box(tree.start), _box(tree.end)]
    for block in blocks:
        corners += [_box(points) for points in ends_of_poses(block, tree.length)]
    return frame_around(np.vstack(corners), camera, headroom=0.1)


def _box(points: Floats) -> Floats:
    """Points that touch each side of the cloud, so that many clouds are framed at little cost."""
    return points[[*points.argmin(axis=0), *points.argmax(axis=0)]]
