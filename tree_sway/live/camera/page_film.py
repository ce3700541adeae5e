# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A camera in the hand of a visitor of the page, which sends places of points and no picture.

The page tells what its visitor clicked, and is told where the wood is in its picture; there it
finds points, and sends where they are. One page films at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import time
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.live.camera.film import FilmPoints
from tree_sway.live.camera.point_tracker import Sighting
from tree_sway.live.motion.sender_clock import SenderClock
from tree_sway.live.one_sender import OneSender
from tree_sway.newest import Newest
from tree_sway.twin import place_on
from tree_sway.twin.camera import (
    Camera,
    camera_of_clicks,
    drawn_wood,
    matched_points,
    told_by,
)

PAGE = 'camera:page'
"""Address of the camera of a page."""

_EVERY = 3.0
"""Distance in pixels of the places along the wood of which a page takes the best."""
_MOST_PLACES, _MOST_POINTS, _LARGEST = 1500, 200, 8192
_FARTHEST = 1e15
"""Largest number of a message."""
_SILENT = 1.0
"""Time in [s] without a picture after which that is told."""
_HOW = 'no page films: in Controls, Camera of a page with control, start its camera'

Answer = Callable[[Mapping[str, object]], None]


class _Clicked(NamedTuple):
    """What a page tells of its camera: text, width and height of its pictures in pixels."""

    text: str
    size: tuple[int, int]
    answer: Answer


class PageFilm(FilmPoints):
    """
    Points that a page follows in the pictures of its own camera.

    Parameters
    ----------
    tree
        The tree at rest.
    at
        What is known of any camera there, as `told_by` takes it, without clicks.
    log
        Function that is told the news.

    Raises
    ------
    ParameterError
        A text of another form, clicks, or a picture to write.

    """

    def __init__(self, tree: Tree, at: str, log: Callable[[str], None]) -> None:
        super().__init__(PAGE, log)
        told = told_by(at)
        if told.clicks or told.check:
            cure = "give what is known, as 'distance=14.2; bearing=240': the page's visitor clicks"
            raise ParameterError(f'clicks or a check of {PAGE}', where='--at', cure=cure)
        self._tree, self._at = tree, at
        self._senders, self._clock = OneSender(), SenderClock(1e3)
        self._placing = Newest(self._place, 'camera of a page')
        self._placed: tuple[int, Camera | None, float] = (0, None, 0.0)
        self._count = 0
        self._newest = -np.inf
        self._ended = _HOW

    @property
    def problem(self) -> str:
        """Why no point comes; empty if they come."""
        if not self._senders.current:
            return self._ended
        if self._placed[1] is None:
            return 'the page films: points of the tree are to be clicked in its picture'
        is_silent = time.monotonic() - self._newest > _SILENT
        return 'no picture comes from the page: is it in front?' if is_silent else ''

    def picture(self) -> bytes | None:
        """Return None: what a page films does not leave it."""
        return None

    def drain(self) -> list[Sighting]:
        """Return what was seen since the last call, and take the camera that it belongs to."""
        number, self.camera, _ = self._placed
        return [each for each in super().drain() if each.reference == number]

    def take(self, page: object, message: object, answer: Answer) -> str | None:
        """
        Take a message of a page.

        Parameters
        ----------
        page
            Whose it is.
        message
            ``{"at": clicks, "size": [width, height]}``, or of a picture ``{"time": ms, "number":
            that of the answer, "points": [x, y, ...]}`` with null where one is lost, or
            ``{"end": true}``.
        answer
            Function that is called in another thread with what the clicks tell.

        Returns
        -------
        str or None
            Why it is refused, if another page films.

        Raises
        ------
        ValueError, TypeError
            A message of another form.

        """
        if not isinstance(message, dict):
            raise TypeError('film')
        if 'end' in message:
            self.leave(page)
            return None
        now, before = time.monotonic(), self._senders.current
        if not self._senders.admit(str(id(page)), now):
            self.refused += 1
            return 'another page films this tree: end its camera first'
        if self._senders.current != before:
            self._clock, self._placed = SenderClock(1e3), (self._placed[0], None, 0.0)
        if 'at' in message:
            size = [round(each) for each in _numbers(message.get('size'), 1.0, _LARGEST)]
            if len(size) != 2:
                raise ValueError('size')
            self._placing.want(_Clicked(str(message['at']), (size[0], size[1]), answer))
            return None
        given = message.get('points')
        is_list = isinstance(given, list) and len(given) <= 2 * _MOST_POINTS
        if not is_list or len(given) % 2:
            raise ValueError('points')
        seen = np.full(len(given), np.nan)
        is_seen = np.array([each is not None for each in given], dtype=bool)
        seen[is_seen] = _numbers([each for each in given if each is not None])
        (stamp,) = _numbers([message.get('time')])
        self._note(stamp, message.get('number'), seen.reshape(-1, 2), now)
        return None

    def _note(self, stamp: float, number: object, points: Floats, now: float) -> None:
        """Keep the points of a picture, or refuse them: of other clicks, or of a wrong time."""
        placed, camera, late = self._placed
        is_first = self._count == 0
        is_ours = camera is not None and number == placed
        if not (is_ours and (is_first or len(points) == self._count)):
            self.refused += 1
        elif self._clock.note(stamp, now):
            self._count, self._newest = len(points), now
            self._add(Sighting(self._clock.local(stamp) - late, placed, points))
        else:
            self.refused += 1

    def leave(self, page: object) -> None:
        """End the film of a page that is closed; of any other page, do nothing."""
        if self._senders.current == str(id(page)):
            self._senders, self._ended = OneSender(), f'its page films no more; {_HOW}'
            self._log(f'{self.name}: its page films no more')

    def _place(self, clicked: _Clicked) -> None:
        """Find where the camera stands, and tell the page where the wood is."""
        tree = self._tree
        try:
            told = told_by(f'{self._at};{clicked.text}')
            if told.check:
                raise ParameterError('a page has no picture to write', where='check')
            found = camera_of_clicks(tree, clicked.size, told.clicks, told.told)
        except ParameterError as error:
            self.refused += 1
            clicked.answer({'refused': {'name': 'clicks', 'reason': str(error)}})
            return
        number = self._placed[0] + 1
        self._count, self._placed = 0, (number, found.camera, told.late)
        wood = drawn_wood(found.camera, tree.start, tree.end, tree.base_diameter)
        places = _places(wood.first, wood.last, clicked.size)
        # A place where wood crosses tells nothing.
        kept = matched_points(tree, tree.rest_poses, found.camera, places).row
        told_places = places[kept].astype(int).tolist()
        clicked.answer({'film': {'number': number, 'said': str(found), 'places': told_places}})
        self._log(f'{self.name}: {found}')


def _numbers(values: Any, low: float = -_FARTHEST, high: float = _FARTHEST) -> list[float]:
    """Return numbers within a range as they are, else raise."""
    for each in values:
        if type(each) not in (int, float) or not low <= each <= high:
            raise ValueError(f'a number out of {low:g} .. {high:g}')
    return [float(each) for each in values]


def _places(first: Floats, last: Floats, size: tuple[int, int]) -> Floats:
    """Return whole pixels along lines (s, 2), as many as are sent at most, (k, 2)."""
    found = [np.zeros((0, 2))]
    for one, other in zip(first, last, strict=True):
        count = np.linalg.norm(other - one) / _EVERY
        if np.isfinite(count):
            found.append(np.linspace(one, other, 1 + int(min(count, _LARGEST)), endpoint=False))
    places = np.unique(np.concatenate(found).round(), axis=0)
    places = places[((places >= 0.0) & (places < size)).all(axis=1)]
    return np.asarray(places[:: 1 + len(places) // _MOST_PLACES])
