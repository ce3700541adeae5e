# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A film in a file, or a live camera by its number or address: points of its pictures."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from importlib import import_module
import threading
import time
from typing import Any

import numpy as np

from tree_sway.errors import ParameterError
from tree_sway.extras import refuse_missing
from tree_sway.live.camera.point_tracker import PointTracker, Sighting
from tree_sway.twin.camera import Camera, DrawnWood

_PREFIX = 'camera:'
_BESIDE = 8
"""Width in pixels about the wood in which points are found."""
_AGAIN = 3.0
"""Time in [s] after which a camera that stopped is opened again."""
_KEPT = 300
_RED = (0, 0, 255)


def is_camera(address: str) -> bool:
    """Whether an address of a sensor is that of a camera."""
    return address.startswith(_PREFIX)


class Film:
    """
    Pictures of a source.

    Parameters
    ----------
    address
        ``camera:`` and the number of a camera, a file, or an address such as ``rtsp://host/live``.
    late
        How late its live pictures come in [s].

    Raises
    ------
    MissingDependencyError
        OpenCV is not installed.
    ParameterError
        It cannot be opened, or has no picture.

    """

    def __init__(self, address: str, late: float = 0.07) -> None:
        refuse_missing(['cv2'], f'simulate --motion {address}')
        cv2 = self._cv2 = import_module('cv2')
        self.name = address
        source = address.removeprefix(_PREFIX)
        self._source: int | str = int(source) if source.isdecimal() else source
        self.is_live = source.isdecimal() or '://' in source
        """Whether its pictures are of now."""
        self._late = late
        self._capture = cv2.VideoCapture(self._source)
        is_read, self.first = self._capture.read()
        self._begun = self._capture.get(cv2.CAP_PROP_POS_MSEC)
        """The first picture, blue, green, red, (high, wide, 3)."""
        if not is_read:
            raise ParameterError(
                f"no picture comes from '{source}'",
                where='--motion',
                cure='give camera:0, camera:FILE.mp4 or camera:rtsp://host/path',
            )

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.first.shape[1], self.first.shape[0]

    def tracker(self, wood: DrawnWood) -> PointTracker:
        """Return a tracker of points on and about wood."""
        return PointTracker(self._cv2, self.mask(self._cv2, self.first.shape, wood))

    @staticmethod
    def mask(cv2: Any, shape: tuple[int, ...], wood: DrawnWood) -> Any:
        """Return where wood is in a picture, 255 there and 0 elsewhere, (high, wide)."""
        mask = np.zeros(shape[:2], dtype=np.uint8)
        _draw(cv2, mask, wood, 255, _BESIDE)
        return mask

    def check(self, path: str, wood: DrawnWood) -> None:
        """Write the first picture with lines where the wood should be."""
        picture = self.first.copy()
        _draw(self._cv2, picture, wood, _RED, 0)
        if not self._cv2.imwrite(path, picture):
            raise ParameterError(
                f"'{path}' cannot be written",
                where='--at',
                cure='give a .png or .jpg in a folder that is there',
            )

    def sightings(self, tracker: PointTracker) -> Iterator[Sighting]:
        """Follow the points of a file's pictures, with times from its first one on in [s]."""
        yield tracker.follow(0.0, self.first)
        before = 0.0
        rate = self._capture.get(self._cv2.CAP_PROP_FPS) or 30.0
        while True:
            is_read, picture = self._capture.read()
            if not is_read:
                return
            at = 1e-3 * (self._capture.get(self._cv2.CAP_PROP_POS_MSEC) - self._begun)
            # Some containers tell no times; pictures are then as far apart as the rate says.
            before = at if at > before else before + 1.0 / rate
            yield tracker.follow(before, picture)

    def newest(self) -> tuple[float, Any]:
        """Wait for a picture: its time on this clock [s]; None where none comes."""
        is_read, picture = self._capture.read()
        return time.monotonic() - self._late, picture if is_read else None

    def open_again(self) -> None:
        """Open the source once more."""
        self._capture.release()
        self._capture = self._cv2.VideoCapture(self._source)

    def close(self) -> None:
        """Let the source go."""
        self._capture.release()


class LiveFilm:
    """Points of a live camera that stands somewhere, followed from `start` to `stop`."""

    def __init__(
        self, film: Film, camera: Camera, tracker: PointTracker, log: Callable[[str], None]
    ) -> None:
        self.camera = camera
        """Where it stands."""
        self._film, self._tracker, self._log = film, tracker, log
        self._sightings: deque[Sighting] = deque(maxlen=_KEPT)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name='camera', daemon=True)
        self.problem = 'no picture yet'
        """Why no picture comes; empty if they come."""

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End."""
        self._stop.set()
        self._thread.join(timeout=2.0)

    def drain(self) -> list[Sighting]:
        """Return what was seen since the last call; times are those of `time.monotonic`."""
        found = list[Sighting]()
        while self._sightings:
            found.append(self._sightings.popleft())
        return found

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                at, picture = self._film.newest()
                if picture is not None:
                    self._say('')
                    self._sightings.append(self._tracker.follow(at, picture))
                    continue
                self._say('no picture comes: check the camera and its connection')
                self._stop.wait(_AGAIN)
                self._film.open_again()
        except Exception as error:  # of OpenCV: the tree goes on without a camera
            self._say(f'it stopped ({type(error).__name__}: {error})')
        finally:
            self._film.close()

    def _say(self, problem: str) -> None:
        if problem != self.problem:
            self.problem = problem
            self._log(f'{self._film.name}: {problem or "pictures come"}')


def _draw(cv2: Any, picture: Any, wood: DrawnWood, colour: Any, beside: int) -> None:
    """Draw wood as wide as it is, and wider, or as lines if it is to be no wider."""
    for first, last, width in zip(wood.first, wood.last, wood.width, strict=True):
        if np.isfinite([*first, *last]).all():
            both = np.clip([first, last], -9999, 9999).astype(int).tolist()
            thick = int(width) + beside if beside else 1
            cv2.line(picture, *map(tuple, both), colour, min(thick, 255))
