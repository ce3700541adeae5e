# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A film in a file, or a live camera by its number or address: points of its pictures."""

from __future__ import annotations

from collections.abc import Iterator
import time
from typing import Any

from tree_sway.errors import ParameterError
from tree_sway.live.camera.camera_view import CameraView, opencv
from tree_sway.live.camera.point_tracker import Sighting
from tree_sway.live.recent import RecentSamples
from tree_sway.live.transports.transport import Log
from tree_sway.twin.camera import Camera
from tree_sway.worker import Worker

_PREFIX = 'camera:'
_AGAIN = 3.0
"""Time in [s] after which a camera that stopped is opened again."""
_KEPT = 300
_COUNTED = 60
"""Number of pictures whose rate is told."""


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
        cv2 = self._cv2 = opencv(f'simulate --motion {address}')
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
                cure='connect it, close what uses it, check its name, or give camera:0, '
                'camera:FILE.mp4 or camera:rtsp://host/path',
            )

    def sightings(self, view: CameraView) -> Iterator[Sighting]:
        """Follow the points of a file's pictures, with times from its first one on in [s]."""
        yield view.follow(0.0, self.first)
        before = 0.0
        rate = self._capture.get(self._cv2.CAP_PROP_FPS) or 30.0
        while True:
            is_read, picture = self._capture.read()
            if not is_read:
                return
            at = 1e-3 * (self._capture.get(self._cv2.CAP_PROP_POS_MSEC) - self._begun)
            # Some containers tell no times; pictures are then as far apart as the rate says.
            before = at if at > before else before + 1.0 / rate
            yield view.follow(before, picture)

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


class FilmPoints(RecentSamples[Sighting]):
    """Points of the newest pictures of a camera, and the rate of these."""

    def __init__(self, name: str, log: Log) -> None:
        super().__init__(_KEPT, _COUNTED)
        self.name, self._log = name, log
        self.camera: Camera | None = None
        """Where it stands; None before that is known."""
        self.refused = 0
        """Messages that were refused before they told a picture."""


class LiveFilm(FilmPoints, Worker):
    """Points of a live camera, followed in a view of it from `start` to `stop`."""

    def __init__(self, film: Film, view: CameraView, log: Log) -> None:
        FilmPoints.__init__(self, film.name, log)
        Worker.__init__(self, 'camera')
        self._film, self.view = film, view
        self.picture = view.drawn
        """Draws what it sees as a JPEG; called in a thread of its own."""
        self.problem = 'no picture yet'
        """Why no picture comes; empty if they come."""

    def _run(self) -> None:
        try:
            while not self.is_stopping:
                at, picture = self._film.newest()
                if picture is not None:
                    self._say('')
                    seen = self.view.follow(at, picture)
                    self.camera = self.view.camera
                    self.add(seen.time, seen)
                    continue
                self._say('no picture comes: check the camera and its connection')
                self._stopping.wait(_AGAIN)
                self._film.open_again()
        except Exception as error:  # of OpenCV: the tree goes on without a camera
            self._say(f'it stopped ({type(error).__name__}: {error})')
        finally:
            self._film.close()

    def _say(self, problem: str) -> None:
        if problem != self.problem:
            self.problem = problem
            self._log(f'{self._film.name}: {problem or "pictures come"}')
