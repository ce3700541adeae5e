# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera among the arguments ``--motion`` and ``--at``: ``camera:FILE`` and its clicks."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple, TYPE_CHECKING

from tree_sway.commands import say, waiting
from tree_sway.core.checks import within
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.live import CameraView, Film, is_camera, LiveFilm, PAGE, PageFilm
from tree_sway.live.commands import say_motion, sensors_and_places
from tree_sway.twin.camera import FilmedMotion

if TYPE_CHECKING:
    from tree_sway.twin.camera import Camera


class PlacedCamera(NamedTuple):
    """A film, where its camera stands, and its view of the tree."""

    film: Film
    camera: Camera
    view: CameraView


def _told_camera(arguments: argparse.Namespace) -> tuple[str, str] | None:
    """Take the address of the camera and what is told of it out of the arguments."""
    pairs = sensors_and_places(arguments)
    cameras = [pair for pair in pairs if is_camera(pair[0])]
    if len(cameras) > 1:
        raise ParameterError('two cameras', where='--motion', cure='give one')
    others = [pair for pair in pairs if not is_camera(pair[0])]
    arguments.motion, arguments.at = [[pair[k] for pair in others] for k in (0, 1)]
    return cameras[0] if cameras else None


def placed_camera(address: str, at: str, tree: Tree) -> PlacedCamera:
    """
    Find where a camera stands, of its address and what is told of it.

    Raises
    ------
    ParameterError
        A film that cannot be opened, or clicks that fit no camera.
    MissingDependencyError
        OpenCV is not installed.

    """
    command = f'simulate --motion {address}'
    view = CameraView(tree, at, lambda text: say(f'{address}: {text}'), command)
    film = Film(address, late=view.told.late)
    return PlacedCamera(film, view.place(film.first), view)


@contextmanager
def filming(
    arguments: argparse.Namespace, tree: Callable[[], Tree]
) -> Iterator[LiveFilm | PageFilm | None]:
    """
    Follow the live camera among the arguments, or that of a page; None without one.

    The errors are those of `placed_camera`, and a film in a file.
    """
    told = _told_camera(arguments)
    if told is None or told[0] == PAGE:
        yield PageFilm(tree(), told[1], say_motion) if told else None
        return
    placed = placed_camera(*told, tree())
    if not placed.film.is_live:
        cure = 'give camera:0 or camera:rtsp://host/path; tree-sway simulate follows films'
        raise ParameterError(f'{placed.film.name} is of the past', where='--motion', cure=cure)
    live = LiveFilm(placed.film, placed.view, say_motion)
    live.start()
    try:
        yield live
    finally:
        live.stop()


def filmed_motion(arguments: argparse.Namespace, tree: Tree) -> FilmedMotion | None:
    """
    Follow the points of the film among the arguments; None without one.

    The errors are those of `placed_camera`, and a camera without an end.
    """
    told = _told_camera(arguments)
    if told is None:
        return None
    placed = placed_camera(*told, tree)
    if placed.film.is_live:
        cure = 'give a film, as camera:FILE.mp4; tree-sway show follows a live camera'
        raise ParameterError(f'{placed.film.name} has no end', where='--motion', cure=cure)
    starts = within('--motion-starts', arguments.motion_starts, -1e9, 1e9, 's')
    with waiting('following the film'):
        seen = [
            (each.time + starts, each.reference, each.points)
            for each in placed.film.sightings(placed.view)
        ]
    return FilmedMotion(placed.camera, seen)
