# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Points followed through pictures, each back to the picture in which it was found.

So nothing drifts, and a point that a bird or a cloud hid is found again where it is. A point
counts as seen where following it there and back ends where it began. When most are lost for long,
points are found anew.

Brightness and contrast about each pixel are taken out of a picture first: shadows and clouds
change both, and dragged the points on thin wood along.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats

_MOST_POINTS = 300
_MOST_BEHIND, _BEHIND_APART = 40, 20
"""Largest number of points beside the mask, and their least distance in pixels."""
_AWAY = 30
"""Pixels from the mask from which they are found."""
_QUALITY = 0.01
_APART = 5
"""Least distance of two points in pixels."""
_WINDOW = (17, 17)
_ABOUT = (15, 15)
"""Pixels about each one whose brightness and contrast are taken out."""
_PLAIN = 36.0
"""Square of a contrast, in grey, below which there is noise rather than texture."""
_CONTRAST = 50.0
"""Grey of a deviation that is as large as the contrast."""
_LEVELS = 2
_ROUNDS = 10
_RETURNED = 0.7
"""Distance in pixels within which a point has to come back."""
_FEWEST = 0.4
"""Share of the points below which most are lost."""
_LONG = 10.0
"""Time in [s] for which most must be lost before points are found anew."""
_EDGE = 60
"""Margin in pixels about the mask."""
_NO_POINTS = np.zeros((0, 1, 2), dtype=np.float32)


class Sighting(NamedTuple):
    """Points of a picture, not a number where lost: its time [s], the picture they are from."""

    time: float
    reference: int
    points: Floats


class PointTracker:
    """
    Follow points.

    Parameters
    ----------
    cv2
        The module of OpenCV.
    mask
        Where in the picture points are found, not 0 there, (high, wide). Some are found far beside
        it too, which tell whether the camera shakes.

    """

    def __init__(self, cv2: Any, mask: Any) -> None:
        self._cv2 = cv2
        self._reference = -1
        self._first: Any = None
        self._found = self._last = _NO_POINTS
        self._good_at = 0.0
        x, y, wide, high = cv2.boundingRect(mask)
        left, top = self._corner = max(x - _EDGE, 0), max(y - _EDGE, 0)
        self._part = slice(top, y + high + _EDGE), slice(left, x + wide + _EDGE)
        self._mask = mask[self._part]
        ends = cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT
        self._flow = {
            'winSize': _WINDOW,
            'maxLevel': _LEVELS,
            'criteria': (ends, _ROUNDS, 0.02),
            'flags': cv2.OPTFLOW_USE_INITIAL_FLOW,
        }

    def follow(self, time: float, picture: Any) -> Sighting:
        """
        Return where the points are in a picture, blue, green, red or grey, of a time in [s].

        The first picture, and one with a new number, is one in which points were found.
        """
        grey = self._cropped(picture)
        if self._first is None:
            return self._begin(time, grey)
        follow = self._cv2.calcOpticalFlowPyrLK
        seen, is_seen, _ = follow(self._first, grey, self._found, self._last.copy(), **self._flow)
        back, is_back, _ = follow(grey, self._first, seen, self._found.copy(), **self._flow)
        missed = np.linalg.norm(back - self._found, axis=2).ravel()
        is_good = ((is_seen & is_back).ravel() == 1) & (missed < _RETURNED)
        # A lost point is sought where those about it have gone: by the middle of all.
        moved = np.median((seen - self._found)[is_good], axis=0) if is_good.any() else 0.0
        self._last = np.where(is_good[:, None, None], seen, self._found + moved).astype(np.float32)
        if is_good.mean() > _FEWEST:
            self._good_at = time
        elif time - self._good_at > _LONG:
            return self._begin(time, grey)
        points = np.where(is_good[:, None], seen[:, 0].astype(np.float64), np.nan)
        return Sighting(time, self._reference, points + self._corner)

    def _begin(self, time: float, grey: Any) -> Sighting:
        """Find points, and follow them from here."""

        def features(most: int, apart: int, mask: Any) -> Any:
            found = self._cv2.goodFeaturesToTrack(grey, most, _QUALITY, apart, mask=mask)
            return _NO_POINTS if found is None else found

        self._found = features(_MOST_POINTS, _APART, self._mask)
        if len(self._found):
            near = self._cv2.dilate(self._mask, np.ones((2 * _AWAY + 1, 2 * _AWAY + 1), np.uint8))
            behind = features(_MOST_BEHIND, _BEHIND_APART, 255 - near)
            self._found = np.concatenate([self._found, behind])
        self._last, self._good_at = self._found, time
        self._first = grey if len(self._found) else None
        self._reference += 1
        points = self._found[:, 0].astype(np.float64) + self._corner
        return Sighting(time, self._reference, points)

    def _cropped(self, picture: Any) -> Any:
        """Return the part of a picture about the mask in grey, of even brightness and contrast."""
        cv2, part = self._cv2, picture[self._part]
        grey = part if part.ndim == 2 else cv2.cvtColor(part, cv2.COLOR_BGR2GRAY)
        mean = cv2.boxFilter(grey, cv2.CV_32F, _ABOUT)
        square = cv2.sqrBoxFilter(grey, cv2.CV_32F, _ABOUT)
        contrast = cv2.sqrt(cv2.subtract(square, cv2.multiply(mean, mean)) + _PLAIN)
        apart = cv2.divide(cv2.subtract(grey, mean, dtype=cv2.CV_32F), contrast, scale=_CONTRAST)
        return cv2.add(apart, 128.0, dtype=cv2.CV_8U)
