# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Rotations between frames, from what is said on /tf and /tf_static: a sensor on a boat or a robot.

Read here and not by tf2's buffer, so that its messages are all that is needed.
"""

from __future__ import annotations

from bisect import bisect
from collections import deque
from collections.abc import Iterable
import math
import time
from typing import Any, NamedTuple

from scipy.spatial.transform import Rotation, Slerp

from tree_sway.core.arrays import Floats
from tree_sway_ros.process.topics import TF, TF_STATIC
from tree_sway_ros.wire.wind_messages import stamp_to_ns

_KEPT = 100
"""Transforms kept per frame: a second of a fast one."""
_MOST = 4096
"""Frames that are kept and reported: whoever may publish can make up any number."""
_LONGEST = 255
"""Longer names [letters] are no frame's."""
_SHOWN = 60
"""Letters of a name that a message repeats."""
_PATIENCE = 2.0
"""The first transform is awaited for this time [s]."""


class _Link(NamedTuple):
    """Where a frame was at a time [ns]: its parent, and its rotation in it, x y z w."""

    stamp: int
    parent: str
    turn: tuple[float, float, float, float]


class Frames:
    """The frames that are known, each with its last transforms."""

    def __init__(self) -> None:
        self._links: dict[str, deque[_Link]] = {}

    def take(self, transforms: Iterable[Any], *, is_static: bool = False) -> None:
        """Take `geometry_msgs/TransformStamped`; a frame begins again where its time goes back."""
        for each in transforms:
            q = each.transform.rotation
            turn = (q.x, q.y, q.z, q.w)
            if not 0.5 < math.hypot(*turn) < 2.0:  # NaN is not, either
                continue
            child = each.child_frame_id.strip('/')
            is_new = child not in self._links
            if len(child) > _LONGEST or (is_new and len(self._links) >= _MOST):
                continue
            stamp = 0 if is_static else stamp_to_ns(each.header.stamp)
            link = _Link(stamp, each.header.frame_id[:_LONGEST].strip('/'), turn)
            links = self._links.setdefault(child, deque(maxlen=_KEPT))
            if links and (links[-1].stamp >= stamp or links[-1].parent != link.parent):
                links.clear()
            links.append(link)

    def rotation(self, frame: str, base: str, stamp: int) -> Floats | None:
        """
        Rotation (3, 3) of vectors of a frame into another; None where no way leads there.

        The stamp is in [ns]: between two transforms by interpolation; the nearest beyond them, and
        the latest at 0.
        """
        down = self._way_up(base.strip('/'), stamp)
        for ancestor, turn in self._way_up(frame.strip('/'), stamp).items():
            if ancestor in down:
                return (down[ancestor].inv() * turn).as_matrix()
        return None

    def _way_up(self, frame: str, stamp: int) -> dict[str, Rotation]:
        """Rotation of a frame in each of those above it; a ring of frames is gone round once."""
        way, turn = {frame: Rotation.identity()}, Rotation.identity()
        while links := self._links.get(frame):
            frame, turn = links[-1].parent, _rotation_at(links, stamp) * turn
            if frame in way:
                break
            way[frame] = turn
        return way


class FrameListener:
    """Listens to /tf from when it is made, and logs once what it makes of each frame."""

    def __init__(self, node: Any, base: str) -> None:
        self._log, self._base = node.get_logger(), base
        self._frames = Frames()
        self._said: set[str] = set()
        self._until = time.monotonic() + _PATIENCE
        self._lack = 'no transform between the two on /tf'
        self.text, self.is_lacking, self.is_waiting = '', False, False
        self._latest = -math.inf
        try:
            node.subscription(TF, lambda heard: self._frames.take(heard.transforms))
            node.subscription(
                TF_STATIC, lambda heard: self._frames.take(heard.transforms, is_static=True)
            )
        except ImportError:
            self._until, self._lack = 0.0, 'tf2_msgs is not installed'

    @property
    def age(self) -> float:
        """Time since the last sample in another frame [s]."""
        return time.monotonic() - self._latest

    def rotation(self, frame: str, stamp: int) -> Floats | None:
        """Rotation from a frame into the base at a time [ns], (3, 3); None without one."""
        found = self._frames.rotation(frame, self._base, stamp)
        self.is_lacking = found is None
        self.is_waiting = self.is_lacking and time.monotonic() < self._until
        if self.is_waiting:
            return None
        way = f"taken as '{self._base}': {self._lack}"
        if found is not None:
            way, self._until = f"turned into '{self._base}' by /tf", 0.0
        shown = frame if len(frame) <= _SHOWN else f'{frame[:_SHOWN]}...'
        self.text, self._latest = f"wind is in frame '{shown}', {way}", time.monotonic()
        if self.text not in self._said and len(self._said) < _MOST:
            self._said.add(self.text)
            # Two places, as a place of the log keeps to one severity.
            if found is None:
                self._log.warning(self.text)
            else:
                self._log.info(self.text)
        return found


def _rotation_at(links: deque[_Link], stamp: int) -> Rotation:
    after = len(links) if stamp == 0 else bisect([link.stamp for link in links], stamp)
    if after in (0, len(links)):
        return Rotation.from_quat(links[min(after, len(links) - 1)].turn)
    one, two = links[after - 1], links[after]
    turns = Slerp([0.0, float(two.stamp - one.stamp)], Rotation.from_quat([one.turn, two.turn]))
    return turns(float(stamp - one.stamp))
