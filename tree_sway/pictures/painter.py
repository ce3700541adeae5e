# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trees painted into images by Pillow: stills, and the frames of films, many in a second."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.leaves.flutter import leaf_poses
from tree_sway.core.leaves.foliage import LeafClusters
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.pictures.projection import Camera, Frame
from tree_sway.pictures.shapes import ground_shapes, outline_at_rest, tree_shapes

_FINER = 2
"""Points painted for each point of the image, in either direction."""
_WIND, _SHADOW, _GHOST = '#1f6fb4', '#e2e2e0', '#dedad6'


class Painter:
    """
    Paints one tree or several from one place, pose after pose.

    Parameters
    ----------
    trees
        The trees; poses and leaves count their segments one tree after the other.
    camera, frame
        From where they are seen, and what is shown.
    pixels
        Height of the images in [px].

    Raises
    ------
    ModuleNotFoundError
        If pillow is not installed.

    """

    def __init__(self, trees: Sequence[Tree], camera: Camera, frame: Frame, pixels: int) -> None:
        from PIL import Image, ImageDraw, ImageFont

        first = accumulate((each.n_segments for each in trees), initial=0)
        rows = [slice(begin, end) for begin, end in pairwise(first)]
        self._trees = sorted(
            zip(trees, rows, strict=True),
            key=lambda each: -float(each[0].start[0, 1]),
        )
        self._length = np.concatenate([each.length for each in trees])
        self._camera, self._frame, self._draw_on = camera, frame, ImageDraw.Draw
        # Films want even numbers of points.
        self.size = 2 * round(0.5 * pixels * frame.aspect), 2 * round(0.5 * pixels)
        self._scale = _FINER * self.size[1] / (frame.top - frame.bottom)
        self._back = Image.new('RGB', (_FINER * self.size[0], _FINER * self.size[1]), 'white')
        self._font = ImageFont.load_default(size=_FINER * max(10.0, 0.032 * pixels))
        draw = self._draw_on(self._back)
        for tree, _ in self._trees:
            pot, (middle, width, height) = ground_shapes(tree, camera)
            for corners, color in pot:
                draw.polygon(self._points(corners), fill=color)
            if not pot:
                half = np.array([0.5 * width, 0.5 * height])
                left, low, right, high = self._points(np.array([middle - half, middle + half]))
                draw.ellipse((left, high, right, low), fill=_SHADOW)

    def image(
        self,
        poses: ArrayLike,
        wind: ArrayLike = (0.0, 0.0, 0.0),
        leaves: LeafClusters | None = None,
        flutter: ArrayLike = 0.0,
        *,
        has_ghost: bool = False,
    ) -> Any:
        """
        Paint an RGB image of Pillow.

        Parameters
        ----------
        poses
            Pose block of all segments, (n, 7).
        wind
            In [m/s], (3,), for an arrow; none is painted without wind.
        leaves, flutter
            Their leaves, none if None, and how far each is turned, as of `leaf_poses`.
        has_ghost
            Whether to paint the shape at rest behind.

        """
        image = self._back.copy()
        draw = self._draw_on(image)
        if has_ghost:
            for tree, _ in self._trees:
                for corners in outline_at_rest(tree, self._camera):
                    draw.polygon(self._points(corners), fill=_GHOST, outline=_GHOST)
        block = np.asarray(poses, dtype=np.float64)
        start, end = ends_of_poses(block, self._length)
        placed = None if leaves is None else leaf_poses(leaves, block, flutter)
        for tree, rows in self._trees:
            foliage = None
            if leaves is not None and placed is not None:
                is_own = (leaves.segment >= rows.start) & (leaves.segment < rows.stop)
                foliage = placed[is_own], leaves.size[is_own]
            self._draw_tree(draw, tree, start[rows], end[rows], foliage)
        self._draw_wind(draw, np.asarray(wind, dtype=np.float64))
        return image.reduce(_FINER)

    def _draw_tree(
        self,
        draw: Any,
        tree: Tree,
        start: Floats,
        end: Floats,
        leaves: tuple[Floats, Floats] | None,
    ) -> None:
        shapes = tree_shapes(tree, start, end, self._camera, self._frame, leaves)
        levels = np.clip(255.0 * shapes.colors, 0.0, 255.0).astype(int).tolist()
        ends = 2 * np.cumsum([len(corners) for corners in shapes.corners])
        points = self._points(np.vstack(shapes.corners))
        first = 0
        for last, level, has_edge in zip(
            ends.tolist(), levels, shapes.has_edge.tolist(), strict=True
        ):
            ink = tuple(level)
            draw.polygon(points[first:last], fill=ink, outline=ink if has_edge else None)
            first = last

    def _draw_wind(self, draw: Any, wind: Floats) -> None:
        """Draw an arrow along the wind as the camera sees it, with its speed."""
        frame, speed = self._frame, float(np.linalg.norm(wind))
        if speed == 0.0:
            return
        size = frame.top - frame.bottom
        along = self._camera.project(wind)[:2] / speed
        across = np.array([-along[1], along[0]])
        middle = np.array([frame.left + 0.14 * size, frame.top - 0.09 * size])
        tip, tail = middle + 0.08 * size * along, middle - 0.08 * size * along
        neck = tip - 0.03 * size * along
        line = self._points(np.array([tail, neck]))
        draw.line(line, fill=_WIND, width=round(0.005 * size * self._scale))
        head = np.array([tip, neck + 0.014 * size * across, neck - 0.014 * size * across])
        draw.polygon(self._points(head), fill=_WIND)
        above = self._points((middle + np.array([0.0, 0.045 * size]))[None])
        draw.text(above, f'{speed:.1f} m/s', fill=_WIND, font=self._font, anchor='mm')

    def _points(self, points: Floats) -> list[float]:
        """Points of the picture plane in [m], (k, 2), as pixels from the upper left corner."""
        at = (points - [self._frame.left, self._frame.top]) * [self._scale, -self._scale]
        flat: list[float] = at.ravel().tolist()
        return flat
