# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree painted into an image by Pillow alone: frames of a film, many in a second."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import MissingDependencyError
from tree_sway.pictures.projection import Camera
from tree_sway.pictures.tree_drawing import Frame, ground_shapes, painted_shapes

_FINER = 2
_WIDE_EDGE = 0.2
_WIND = '#1f6fb4'
_SHADOW = '#e2e2e0'


class Raster:
    """Paints a tree, frame by frame, ``pixels`` high; a `MissingDependencyError` if it cannot."""

    def __init__(self, tree: Tree, camera: Camera, frame: Frame, pixels: int) -> None:
        try:
            from PIL import Image, ImageDraw, ImageFont
        except ImportError:
            raise MissingDependencyError(
                'moving pictures need pillow', cure='pip install pillow'
            ) from None
        self._tree, self._camera, self._frame = tree, camera, frame
        self._draw_on = ImageDraw.Draw
        # Films want even numbers of points.
        self.size = 2 * round(0.5 * pixels * frame.aspect), 2 * round(0.5 * pixels)
        self._scale = _FINER * self.size[1] / (frame.top - frame.bottom)
        self._back = Image.new('RGB', (_FINER * self.size[0], _FINER * self.size[1]), 'white')
        self._font = ImageFont.load_default(size=_FINER * max(10.0, 0.032 * pixels))
        draw = self._draw_on(self._back)
        pot, (middle, width, height) = ground_shapes(tree, camera)
        for corners, color in pot:
            draw.polygon(self._points(corners), fill=color)
        if not pot:
            half = np.array([0.5 * width, 0.5 * height])
            low, high = self._to_pixels(np.array([middle - half, middle + half]))
            draw.ellipse((low[0], high[1], high[0], low[1]), fill=_SHADOW)

    def image(
        self, start: Floats, end: Floats, wind: Floats, leaves: tuple[Floats, Floats] | None
    ) -> Any:
        """
        Paint one frame as an RGB image of Pillow.

        Parameters
        ----------
        start, end
            Nodes of the segments as they are now in [m], (n, 3) each.
        wind
            In [m/s], (3,), for the arrow.
        leaves
            Pose block of the leaf clusters, (m, 7), and their diameters in [m], (m,).

        """
        image = self._back.copy()
        draw = self._draw_on(image)
        polygons, colors, edges = painted_shapes(
            self._tree, start, end, self._camera, self._frame, leaves
        )
        levels = np.clip(255.0 * colors, 0.0, 255.0).astype(int).tolist()
        ends = np.cumsum([len(polygon) for polygon in polygons])
        points = self._to_pixels(np.vstack(polygons)).ravel().tolist()
        first = 0
        # Twigs are thinner than a point: their edges show them.
        has_edge = (edges > _WIDE_EDGE).tolist()
        for last, color, edge in zip((2 * ends).tolist(), levels, has_edge, strict=True):
            ink = tuple(color)
            draw.polygon(points[first:last], fill=ink, outline=ink if edge else None)
            first = last
        self._draw_wind(draw, wind)
        return image.reduce(_FINER)

    def _draw_wind(self, draw: Any, wind: Floats) -> None:
        frame, speed = self._frame, float(np.linalg.norm(wind))
        if speed == 0.0:
            return
        size = frame.top - frame.bottom
        along = self._camera.project(wind)[:2] / speed
        across = np.array([-along[1], along[0]])
        middle = np.array([frame.left + 0.14 * size, frame.top - 0.09 * size])
        tip, tail = middle + 0.08 * size * along, middle - 0.08 * size * along
        neck = tip - 0.03 * size * along
        line = [*self._points(np.array([tail, neck]))]
        draw.line(line, fill=_WIND, width=round(0.005 * size * self._scale))
        head = np.array([tip, neck + 0.014 * size * across, neck - 0.014 * size * across])
        draw.polygon(self._points(head), fill=_WIND)
        above = np.array([0.0, 0.045 * size])
        at = self._points((middle + above)[None])
        draw.text(at, f'{speed:.1f} m/s', fill=_WIND, font=self._font, anchor='mm')

    def _to_pixels(self, points: Floats) -> Floats:
        """Points of the picture plane in [m], (k, 2), as pixels from the upper left corner."""
        at = points - [self._frame.left, self._frame.top]
        pixels: Floats = at * [self._scale, -self._scale]
        return pixels

    def _points(self, points: Floats) -> list[float]:
        flat: list[float] = self._to_pixels(points).ravel().tolist()
        return flat
