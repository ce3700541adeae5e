# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Where a camera stands and how it looks, from points of the tree that a person clicked in a picture.

Seven numbers are sought: bearing, distance and height of the camera, bearing, pitch and roll of
its axis, focal length. Points of a straight stem tell five at most: they do not tell from which
side the camera looks, and hardly tell a near camera of a short focal length from a far one of a
long one. So the bearing, unless a limb is clicked, and distance or focal length must be told; what
is known of any camera bounds the rest. The errors that come with the result say what remains.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.twin.camera.pinhole import Camera, looking
from tree_sway.twin.sensor_place import place_on, point_at

_CLICK = 2.0
"""Error of a click in pixels."""

_MOST_MISSED = 12.0
"""Root mean square in pixels by which clicks may miss."""

_DOUBTED = 8.0
"""Error in pixels from which a single click is doubted."""

_BEARING_ERROR = math.radians(25.0)
"""Error of the bearing beyond which a film tells nothing of depth."""

_TOLD: dict[str, tuple[Callable[[float], float], float]] = {
    'bearing': (math.radians, math.radians(5.0)),
    'distance': (math.log, 0.03),
    'height': (float, 0.2),
    'focal': (math.log, 0.03),
}
"""What is fitted of what is told, and its error: bearing [rad], logarithms, height [m]."""

_USUAL_HEIGHT = (1.6, 0.5)
_USUAL_FOCAL = (0.78, 0.2)
"""Focal length of phones over the longer side of their pictures, and error of its logarithm."""

_USUAL_DISTANCE = (1.5, 0.6)
"""Distance over the height of the tree, and error of its logarithm."""


class Click(NamedTuple):
    """A point in the picture in pixels, and its place on the tree as `place_on` takes it."""

    x: float
    y: float
    place: str


class Told(NamedTuple):
    """What is known of a camera; None where nothing is."""

    bearing: float | None = None
    """Where it looks in degrees clockwise from north."""
    distance: float | None = None
    """Horizontal distance from the foot of the stem in [m]."""
    height: float | None = None
    """Height above the foot of the stem in [m]."""
    focal: float | None = None
    """Focal length in pixels."""


class FoundCamera(NamedTuple):
    """A camera, how far clicks miss in pixels, and errors by name in degrees, m and pixels."""

    camera: Camera
    missed: float
    errors: dict[str, float]
    doubt: str = ''
    """The click that misses most, where that is far."""

    def __str__(self) -> str:
        errors = ', '.join(f'{name} {value:.2g}' for name, value in self.errors.items())
        return f'clicks miss by {self.missed:.1f} px; errors: {errors}{self.doubt}'


def camera_of_clicks(
    tree: Tree, size: tuple[int, int], clicks: Sequence[Click], told: Told | None = None
) -> FoundCamera:
    """
    Find the camera of a picture.

    Parameters
    ----------
    tree
        The tree at rest.
    size
        Width and height of the picture in pixels.
    clicks
        Points of the tree in it.
    told
        What is known of the camera.

    Raises
    ------
    ParameterError
        Too few clicks, clicks that fit no camera, or a bearing that nothing tells.

    """
    told = told or Told()
    if len(clicks) < 3:
        cure = 'click three or more: the foot of the stem, its top, and one between'
        raise ParameterError(f'{len(clicks)} clicked points', where='camera', cure=cure)
    points = np.array([point_at(tree, place_on(tree, each.place)) for each in clicks])
    image = np.array([[each.x, each.y] for each in clicks])
    fit = _Fit(tree, size, points, image, told)
    bearings = [math.radians(told.bearing or 0.0)]
    if told.bearing is None:
        bearings = (math.radians(45.0) * np.arange(8)).tolist()
    found = min((fit.from_bearing(each) for each in bearings), key=lambda each: each.cost)
    camera = fit.camera(found.x)
    each_missed = np.linalg.norm(camera.project(points) - image, axis=1)
    missed = float(np.sqrt(np.square(each_missed).mean()))
    worst = int(each_missed.argmax())
    x, y, place = clicks[worst]
    doubt = f'; check {x:.0f},{y:.0f},{place}, which misses by {each_missed[worst]:.0f} px'
    if not missed < _MOST_MISSED:
        cure = 'check the clicks and their places, and what is told of bearing and distance'
        what = f'no camera fits the clicks: they miss by {missed:.0f} px{doubt}'
        raise ParameterError(what, where='camera', cure=cure)
    bearing, distance, height, _, pitch, roll, focal = np.sqrt(
        np.diag(np.linalg.inv(found.jac.T @ found.jac))
    ).tolist()
    if bearing > _BEARING_ERROR:
        cure = 'tell where it looks, as bearing=240, or click points of limbs too'
        raise ParameterError('nothing tells its bearing', where='camera', cure=cure)
    errors = {
        'bearing': math.degrees(bearing),
        'distance': distance * math.exp(found.x[1]),
        'height': height,
        'pitch': math.degrees(pitch),
        'roll': math.degrees(roll),
        'focal': focal * camera.focal,
    }
    return FoundCamera(camera, missed, errors, doubt if each_missed[worst] > _DOUBTED else '')


class _Fit:
    """Least squares of clicks and of what is known before them."""

    def __init__(
        self, tree: Tree, size: tuple[int, int], points: Floats, image: Floats, told: Told
    ) -> None:
        self._points, self._image = points, image
        self._foot = tree.start[0]
        self._centre = 0.5 * np.array(size, dtype=float)
        times_height, distance_error = _USUAL_DISTANCE
        times_size, focal_error = _USUAL_FOCAL
        known = {
            'bearing': (0.0, 1e3),
            'distance': (math.log(times_height * np.ptp(tree.end[:, 2])), distance_error),
            'height': _USUAL_HEIGHT,
            'aside': (0.0, 0.5),
            'pitch': (0.0, 0.7),
            'roll': (0.0, 0.1),
            'focal': (math.log(times_size * max(size)), focal_error),
        }
        for name, value in told._asdict().items():
            if value is not None:
                fitted, error = _TOLD[name]
                known[name] = fitted(value), error
        self._mean, self._spread = np.array(list(known.values())).T

    def camera(self, sought: Floats) -> Camera:
        """Return the camera of the seven numbers."""
        bearing, distance, height, aside, pitch, roll, focal = sought.tolist()
        away = math.exp(distance) * np.array([math.sin(bearing), math.cos(bearing), 0.0])
        position = self._foot - away + np.array([0.0, 0.0, height])
        axes = looking(bearing + aside, pitch, roll)
        return Camera(position, axes, math.exp(focal), self._centre)

    def _missed(self, sought: Floats) -> Floats:
        apart = (self.camera(sought).project(self._points) - self._image).ravel() / _CLICK
        prior = (sought - self._mean) / self._spread
        return np.concatenate([np.nan_to_num(apart, nan=1e4), prior])

    def from_bearing(self, bearing: float) -> Any:
        """Fit from a first bearing in [rad]."""
        from scipy.optimize import least_squares  # it takes long to load, and few need it

        first = self._mean.copy()
        first[0] = bearing
        rise = self._points[:, 2].mean() - self._foot[2] - first[2]
        first[4] = math.atan2(rise, math.exp(first[1]))
        return least_squares(self._missed, first, x_scale=np.minimum(self._spread, 1.0))
