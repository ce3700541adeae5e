# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree in the pictures of one camera: where the camera stands, and points that are followed."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.extras import refuse_missing
from tree_sway.files import read_text
from tree_sway.live.camera.point_tracker import PointTracker, Sighting
from tree_sway.twin import place_on
from tree_sway.twin.camera import Camera, camera_of_clicks, drawn_wood, DrawnWood, told_by

_BESIDE = 8
"""Width in pixels about the wood in which points are found."""
_RED = (0, 0, 255)
_GREEN = (0, 220, 0)


def opencv(command: str) -> Any:
    """Return the module of OpenCV, or raise a `MissingDependencyError` of a command."""
    refuse_missing(['cv2'], command)
    return import_module('cv2')


class CameraView:
    """
    Points on a tree that a camera sees.

    Parameters
    ----------
    tree
        The tree at rest.
    at
        What a person tells of the camera, as `told_by` takes it, or the name of a file with it.
    say
        Function that is told how well the camera was found.
    command
        The rest of the command line that needs it, for the cure where OpenCV is not installed.

    Raises
    ------
    MissingDependencyError
        OpenCV is not installed.
    FormatError, ParameterError
        No such file, a text of another form, or a place that is not on the tree.

    """

    def __init__(
        self, tree: Tree, at: str, say: Callable[[str], object], command: str = 'show'
    ) -> None:
        self.cv2 = opencv(command)
        if ';' not in at and '\n' not in at:
            at = read_text(Path(at))
        self._tree, self._say = tree, say
        self.told = told_by(at)
        """Clicks, and what is known of the camera."""
        for each in self.told.clicks:
            place_on(tree, each.place)
        self.camera: Camera | None = None
        """Where it stands; None before the first picture."""
        self._shape: tuple[int, ...] = ()
        self._newest: tuple[Any, Floats] | None = None
        self._refusal: ParameterError | None = None

    def follow(self, time: float, picture: Any) -> Sighting:
        """
        Return where the points are in a picture, blue, green, red or grey, of a time in [s].

        The first one tells where the camera stands. A `ParameterError` refuses one of another size
        than that, and all of them where the clicks fit no camera.
        """
        if self.camera is None:
            self.place(picture)
        if picture.shape[:2] != self._shape:
            sizes = [' x '.join(map(str, each[1::-1])) for each in (picture.shape, self._shape)]
            raise ParameterError(f'a picture of {sizes[0]} after those of {sizes[1]}')
        sighting = self._tracker.follow(time, picture)
        self._newest = picture, sighting.points
        return sighting

    def drawn(self) -> bytes | None:
        """
        Draw the newest picture, with lines where the wood is at rest and the points that are seen.

        Returns a JPEG; None before the first picture. May be called in any thread.
        """
        if self._newest is None:
            return None
        picture, points = self._newest
        cv2, drawn = self.cv2, self._with_wood(picture)
        for at in points[np.isfinite(points).all(axis=1)].astype(int).tolist():
            cv2.circle(drawn, tuple(at), 3, _GREEN, -1)
        return bytes(cv2.imencode('.jpg', drawn)[1])

    def place(self, picture: Any) -> Camera:
        """Find where the camera stands by a first picture; the errors are those of `follow`."""
        if self._refusal is not None:
            raise self._refusal
        tree, told = self._tree, self.told
        high, wide = self._shape = picture.shape[:2]
        try:
            found = camera_of_clicks(tree, (wide, high), told.clicks, told.told)
            wood = drawn_wood(found.camera, tree.start, tree.end, tree.base_diameter)
            self._wood = wood
            if told.check:
                self._check(picture)
        except ParameterError as error:
            self._refusal = error
            raise
        self._say(str(found))
        mask = np.zeros((high, wide), dtype=np.uint8)
        _draw(self.cv2, mask, wood, 255, _BESIDE)
        self._tracker = PointTracker(self.cv2, mask)
        self.camera = found.camera
        return self.camera

    def _with_wood(self, picture: Any) -> Any:
        """Return a picture in colour with lines where the wood should be."""
        is_grey = picture.ndim == 2
        drawn = self.cv2.cvtColor(picture, self.cv2.COLOR_GRAY2BGR) if is_grey else picture.copy()
        _draw(self.cv2, drawn, self._wood, _RED, 0)
        return drawn

    def _check(self, picture: Any) -> None:
        """Write a picture with lines where the wood should be."""
        path = self.told.check
        if not self.cv2.imwrite(path, self._with_wood(picture)):
            raise ParameterError(
                f"'{path}' cannot be written",
                where='--at',
                cure='give a .png or .jpg in a folder that is there',
            )


def _draw(cv2: Any, picture: Any, wood: DrawnWood, colour: Any, beside: int) -> None:
    """Draw wood as wide as it is, and wider, or as lines if it is to be no wider."""
    for first, last, width in zip(wood.first, wood.last, wood.width, strict=True):
        if np.isfinite([*first, *last]).all():
            both = np.clip([first, last], -9999, 9999).astype(int).tolist()
            thick = int(width) + beside if beside else 1
            cv2.line(picture, *map(tuple, both), colour, min(thick, 255))
