# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The latest rotations between frames, by /tf and /tf_static: a sensor on a boat or a robot.

They need only the messages of tf2; where these are missing, no frame is known.
"""

from __future__ import annotations

from collections.abc import Iterable
import math
import time
from typing import Any

from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway_ros.process.topics import TF, TF_STATIC

_MOST = 4096
"""Largest number of frames that are stored and reported, as publishers can send any number."""
_LONGEST = 255
"""Largest length of a frame's name [letters]."""
_SHOWN = 60
"""Number of letters of a name in a log message."""
_PATIENCE = 2.0
"""Time to wait for the first transform [s]."""


class Frames:
    """Known frames: the parent of each, and the latest rotation in it."""

    def __init__(self) -> None:
        self._links: dict[str, tuple[str, Rotation]] = {}

    def take(self, transforms: Iterable[Any]) -> None:
        """Add a `geometry_msgs/TransformStamped`."""
        for each in transforms:
            q = each.transform.rotation
            turn = (q.x, q.y, q.z, q.w)
            if not 0.5 < math.hypot(*turn) < 2.0:  # false for NaN
                continue
            child = each.child_frame_id.strip('/')
            if len(child) <= _LONGEST and (child in self._links or len(self._links) < _MOST):
                parent = each.header.frame_id[:_LONGEST].strip('/')
                self._links[child] = (parent, Rotation.from_quat(turn))

    def rotation(self, frame: str, base: str) -> Floats | None:
        """Rotation (3, 3) of vectors of a frame into a second one; None if not connected."""
        down = self._way_up(base.strip('/'))
        for ancestor, turn in self._way_up(frame.strip('/')).items():
            if ancestor in down:
                return (down[ancestor].inv() * turn).as_matrix()
        return None

    def _way_up(self, frame: str) -> dict[str, Rotation]:
        """Rotation of a frame in each of its ancestors; a cycle of frames is followed once."""
        way = {frame: Rotation.identity()}
        turn = Rotation.identity()
        while link := self._links.get(frame):
            frame = link[0]
            turn = link[1] * turn
            if frame in way:
                break
            way[frame] = turn
        return way


class FrameListener:
    """Listener of /tf that logs the use of each frame once."""

    def __init__(self, node: Any, base: str) -> None:
        self._log = node.get_logger()
        self._base = base
        self._frames = Frames()
        self._said: set[str] = set()
        self._until = time.monotonic() + _PATIENCE
        self._lack = 'no transform between the two on /tf'
        self.text = ''
        self.is_lacking = False
        self.is_waiting = False
        self._latest = -math.inf
        try:
            for topic in (TF, TF_STATIC):
                node.subscription(topic, lambda heard: self._frames.take(heard.transforms))
        except ImportError:
            self._until = 0.0
            self._lack = 'tf2_msgs is not installed'

    @property
    def age(self) -> float:
        """Time since the last sample in a different frame [s]."""
        return time.monotonic() - self._latest

    def rotation(self, frame: str) -> Floats | None:
        """Latest rotation from a frame into the base, (3, 3); None without one."""
        found = self._frames.rotation(frame, self._base)
        self.is_lacking = found is None
        self.is_waiting = self.is_lacking and time.monotonic() < self._until
        if self.is_waiting:
            return None
        way = f"taken as '{self._base}': {self._lack}"
        if found is not None:
            way = f"turned into '{self._base}' by /tf"
            self._until = 0.0
        shown = frame if len(frame) <= _SHOWN else f'{frame[:_SHOWN]}...'
        self.text = f"wind is in frame '{shown}', {way}"
        self._latest = time.monotonic()
        if self.text not in self._said and len(self._said) < _MOST:
            self._said.add(self.text)
            # Two places, as a place of the log has one severity.
            if found is None:
                self._log.warning(self.text)
            else:
                self._log.info(self.text)
        return found
