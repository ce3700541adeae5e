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
from tree_sway.core.tree.pose_ends import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError, MissingDependencyError, ParameterError
from tree_sway.files.whole_file import whole_file
from tree_sway.pictures.projection import Camera
from tree_sway.pictures.raster import Raster
from tree_sway.pictures.tree_drawing import Frame, frame_around

_KINDS = {'.gif': 'GIF', '.png': 'PNG', '.apng': 'PNG', '.mp4': 'MP4'}
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
    Draw a moving picture: a GIF, an animated PNG, a film, or a folder of frames, by the suffix.

    Parameters
    ----------
    tree, leaves
        The tree, and its leaves; none are drawn if None.
    frames
        Pose block of each frame, (n, 7).
    winds
        Wind of each frame in [m/s], (f, 3).
    path
        File to write: ``.gif``, ``.png``, ``.apng`` or ``.mp4`` (by ffmpeg); without a suffix, a
        folder of frames.
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
    kind = _KINDS.get(target.suffix.lower())
    if kind is None and target.suffix:
        raise FormatError(
            f"'{target.suffix}' is no moving picture",
            where=str(target),
            cure=f'end the name with one of: {", ".join(_KINDS)}; a folder has no ending',
        )
    blowing = np.asarray(winds, dtype=np.float64)
    if len(frames) == 0 or blowing.shape != (len(frames), 3):
        raise ParameterError(
            f'{len(frames)} frames and winds {blowing.shape} do not go together',
            cure='give one wind (3,) a frame, and at least one frame',
        )
    camera = camera or Camera()
    blocks = [np.asarray(poses, dtype=np.float64) for poses in frames]
    raster = Raster(tree, camera, _frame_of_all(tree, blocks, camera), pixels)

    def images() -> Iterator[Any]:
        for i, (block, wind) in enumerate(zip(blocks, blowing, strict=True)):
            foliage = None
            if leaves is not None:
                before = blocks[max(i - 1, 0)]
                foliage = _fluttering(leaves, block, before, wind, i, rate), leaves.size
            yield raster.image(*ends_of_poses(block, tree.length), wind, foliage)

    shown = images() if watched is None else watched(images(), len(blocks))
    if kind is None:
        _write_frames(target, shown)
    elif kind == 'MP4':
        _write_film(target, shown, raster.size, rate)
    else:
        _write_picture(target, shown, kind, rate)
    return target


def _write_picture(target: Path, images: Iterator[Any], kind: str, rate: float) -> None:
    first = next(images)
    others: Any = list(images) if kind == 'PNG' else images  # Pillow goes through them twice
    if kind == 'GIF':
        palette = first.quantize(_GIF_COLORS)
        # No dither: dots that dance are no motion.
        others = (image.quantize(palette=palette, dither=0) for image in images)
        first = palette
    with whole_file(target) as partial:
        first.save(
            partial, kind, save_all=True, append_images=others, duration=1000.0 / rate, loop=0
        )


def _write_frames(target: Path, images: Iterator[Any]) -> None:
    try:
        target.mkdir(parents=True, exist_ok=True)
        for number, image in enumerate(images):
            image.save(target / f'{number:05d}.png')
    except OSError as error:
        raise FormatError(
            f'frames cannot be written ({error})', where=str(target), cure='name another folder'
        ) from None


def _write_film(target: Path, images: Iterator[Any], size: tuple[int, int], rate: float) -> None:
    """Have ffmpeg write what is painted, frame after frame."""
    program = shutil.which('ffmpeg')
    if program is None:
        raise MissingDependencyError(
            'films need ffmpeg, which is not installed',
            where=str(target),
            cure='install ffmpeg, or name a .gif or a folder',
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
                cure='name a .gif or a folder',
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


def _fluttering(
    leaves: LeafClusters, block: Floats, before: Floats, wind: Floats, step: int, rate: float
) -> Floats:
    """Pose block of the leaves in the air that passes them."""
    now, then = (leaf_poses(leaves, poses)[:, :3] for poses in (block, before))
    speed = air_speed(now, then, 1.0 / rate, wind)
    return leaf_poses(leaves, block, flutter_angle(leaves, speed, step / rate))
