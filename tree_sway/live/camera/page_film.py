# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A camera in the hand of a visitor of the page, which sends places of points and no picture.

The page tells what its visitor clicked, and is told where the wood is in its picture; there it
finds points, and sends where they are. One page films at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import math
import time
from typing import Any

import numpy as np

from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.live.camera.film import FilmPoints
from tree_sway.live.camera.point_tracker import Sighting
from tree_sway.live.motion.sender_clock import SenderClock
from tree_sway.live.one_sender import OneSender
from tree_sway.live.transports.transport import Log
from tree_sway.newest import Newest
from tree_sway.twin.camera import (
    Camera,
    camera_of_clicks,
    drawn_wood,
    matched_points,
    told_by,
)

PAGE = 'camera:page'
"""Address of the camera of a page."""

_PLACES = 4
"""Number of places of a segment of which a page takes the best."""
_APART = 8
"""Width in pixels of the squares of which each has one place at most."""
_MOST = 1000
"""Largest number of all places."""
_LARGEST = 1e15
_SILENT = 1.0
"""Time in [s] without a picture after which that is told."""
_HOW = 'no page films: in Controls, Camera of a page with control, start its camera'

Answer = Callable[[Mapping[str, object]], None]


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

    def __init__(self, tree: Tree, at: str, log: Log) -> None:
        super().__init__(PAGE, log)
        told = told_by(at)
        if told.clicks or told.check:
            cure = "give what is known, as 'distance=14.2; bearing=240': visitors click"
            raise ParameterError(f'clicks or a check of {PAGE}', where='--at', cure=cure)
        self._tree, self._at = tree, at
        self._senders = OneSender()
        self._placing = Newest[Callable[[], None]](lambda place: place(), PAGE)
        self._placed: tuple[int, Camera | None] = 0, None
        self._late = 0.0
        self._begin()

    def _begin(self) -> None:
        """Film by another page."""
        self._clock = SenderClock(1e3)
        self._placed = self._placed[0], None
        self._seen = Sighting(-math.inf, 0, np.zeros((0, 2)))

    @property
    def problem(self) -> str:
        """Why no point comes; empty if they come."""
        if not self._senders.current:
            return _HOW
        if self._placed[1] is None:
            return 'the page films: points of the tree are to be clicked in its picture'
        is_silent = time.monotonic() - self._seen.time > _SILENT
        return 'no picture comes from the page: is it in front?' if is_silent else ''

    def picture(self) -> bytes | None:
        """Return None: what a page films does not leave it."""
        return None

    def drain(self, until: float = math.inf) -> list[Sighting]:
        """Return what was seen since the last call, and take the camera that it belongs to."""
        number, self.camera = self._placed
        return [each for each in super().drain(until) if each.reference == number]

    def take(self, page: object, message: Any, answer: Answer) -> str | None:
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
            self._begin()
        size: Any = message.get('size')
        given: Any = message.get('points')
        if 'at' in message:
            wide, high = (int(_number(each, 1.0)) for each in size)
            at = str(message['at'])
            self._placing.want(lambda: self._place(at, (wide, high), answer))
            return None
        numbers = [math.nan if each is None else _number(each) for each in given]
        points, stamp = np.array(numbers).reshape(-1, 2), _number(message.get('time'))
        number, camera = self._placed
        is_ours = camera is not None and message.get('number') == number
        is_other = self._seen.reference == number and len(self._seen.points) != len(points)
        if is_ours and not is_other and self._clock.note(stamp, now):
            self._seen = Sighting(self._clock.local(stamp) - self._late, number, points)
            self.add(self._seen.time, self._seen)
        else:
            self.refused += 1
        return None

    def leave(self, page: object) -> None:
        """End the film of a page that is closed; of any other page, do nothing."""
        if self._senders.current == str(id(page)):
            self._senders = OneSender()
            self._log(f'{PAGE}: its page films no more')

    def _place(self, at: str, size: tuple[int, int], answer: Answer) -> None:
        """Find where the camera stands, and tell the page where the wood is."""
        tree = self._tree
        try:
            told = told_by(f'{self._at};{at}')
            found = camera_of_clicks(tree, size, told.clicks, told.told)
        except ParameterError as error:
            self.refused += 1
            answer({'refused': {'name': 'clicks', 'reason': str(error)}})
            return
        number = self._placed[0] + 1
        self._late, self._placed = told.late, (number, found.camera)
        self._log(f'{PAGE}: {found}')
        wood = drawn_wood(found.camera, tree.start, tree.end, tree.base_diameter)
        places = np.linspace(wood.first, wood.last, _PLACES, endpoint=False).reshape(-1, 2).round()
        places = places[((places >= 0.0) & (places < size)).all(axis=1)]
        rows = np.unique(places // _APART, axis=0, return_index=True)[1]
        places = places[rows[:: 1 + len(rows) // _MOST]]
        # A place where wood crosses tells nothing.
        kept = matched_points(tree, tree.rest_poses, found.camera, places).row
        clear = places[kept].astype(int).tolist()
        answer({'film': {'number': number, 'said': str(found), 'places': clear}})


def _number(value: object, low: float = -_LARGEST) -> float:
    """Return a number of a message, else raise."""
    if type(value) not in (int, float) or not low <= value <= _LARGEST:  # type: ignore[operator]
        raise ValueError(f'{str(value)[:20]} in place of a number')
    return float(value)  # type: ignore[arg-type]
