# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Listens to a swaying tree as any other program would: poses as bytes, over DDS."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
import math
import struct
import time
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.rest_frame import ends_of_poses
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import TransportError
from tree_sway_ros.ros.process.listener import Listener
from tree_sway_ros.ros.process.topics import (
    message_class,
    qos_profile,
    SEGMENT_POSES,
    WIND,
    WIND_FILTERED,
)
from tree_sway_ros.tools.stream.totals import StreamTotals

WINDOW = 2.0
"""For so long messages are kept one by one [s]."""
_POSE = 7 * 8
_QUEUE = 50
"""Messages that may wait: what came while this program was held up is late, not missing."""
_LOOK_AROUND = 1.0  # [s]: how long programs that run already take to be seen


@dataclass
class StreamRecord:
    """
    What was received in the last seconds, one item per message: arrivals and stamps in [s].

    The displacement of the highest tip from rest [m], (3,), is empty if no tree is followed; wind
    is in [m/s], (3,).
    """

    arrival: deque[float] = field(default_factory=deque)
    stamp: deque[float] = field(default_factory=deque)
    tip: deque[Floats] = field(default_factory=deque)
    wind_arrival: deque[float] = field(default_factory=deque)
    wind: deque[Floats] = field(default_factory=deque)

    def forget(self, before: float) -> None:
        """Drop what arrived before a time in [s]."""
        while self.arrival and self.arrival[0] < before:
            for column in (self.arrival, self.stamp, self.tip):
                if column:
                    column.popleft()
        while self.wind_arrival and self.wind_arrival[0] < before:
            self.wind_arrival.popleft()
            self.wind.popleft()

    @property
    def pose_rate(self) -> float:
        """Pose arrays per second in [Hz]; 0 if there are fewer than two."""
        return rate_of(self.arrival)

    @property
    def wind_rate(self) -> float:
        """Wind samples per second in [Hz]; 0 if there are fewer than two."""
        return rate_of(self.wind_arrival)

    def latency(self, share: float) -> float:
        """Quantile of the time from stamp to arrival in [s]; NaN if nothing arrived."""
        late = np.array(self.arrival) - np.array(self.stamp)
        return float(np.quantile(late, share)) if len(late) else math.nan


def rate_of(times: Sequence[float]) -> float:
    """Mean rate of events in [Hz] from their times in [s]; 0 if there are fewer than two."""
    if len(times) < 2 or times[-1] <= times[0]:
        return 0.0
    return (len(times) - 1) / (times[-1] - times[0])


class StreamMonitor(Listener):
    """A node that receives poses and wind; without a tree it counts poses and follows no tip."""

    def __init__(self, context: Any, tree: Tree | None, namespace: str = '') -> None:
        super().__init__('monitor', namespace, context)
        self.record, self.totals = StreamRecord(), StreamTotals()
        self._tree = tree
        self._tip = 0 if tree is None else int(np.argmax(tree.end[:, 2]))
        for topic, callback, raw in (
            (SEGMENT_POSES, self._receive_poses, True),
            (WIND_FILTERED, self._receive_wind, False),
        ):
            qos = qos_profile(topic)
            qos.depth = _QUEUE
            self.node.create_subscription(message_class(topic), topic.name, callback, qos, raw=raw)

    def expect_silence(self) -> None:
        """Raise a `TransportError` if somebody publishes: a second wind or tree would mix in."""
        self.spin(_LOOK_AROUND)
        for topic in (WIND, SEGMENT_POSES):
            if self.node.count_publishers(topic.name):
                raise TransportError(
                    f"another program publishes '{topic.name}' in this ROS domain",
                    cure='end it, or set ROS_DOMAIN_ID to another number up to 101',
                )

    def count_anew(self) -> None:
        """Forget what came until now; the totals begin here."""
        self.totals = StreamTotals()

    def _receive_poses(self, data: bytes) -> None:
        arrival = time.time()
        # CDR: four bytes of header, the stamp, the frame's name; the poses are what it ends with.
        second, nanosecond = struct.unpack_from('<iI', data, 4)
        stamp, tip = second + 1e-9 * nanosecond, self._displacement(data)
        record = self.record
        record.arrival.append(arrival)
        record.stamp.append(stamp)
        if tip is not None:
            record.tip.append(tip)
        record.forget(arrival - WINDOW)
        self.totals.add_poses(arrival, stamp, tip)

    def _displacement(self, data: bytes) -> Floats | None:
        """Displacement of the highest tip from rest in a serialised pose array in [m], (3,)."""
        if self._tree is None:
            return None
        offset = len(data) - (self._tree.n_segments - self._tip) * _POSE
        pose = np.array(struct.unpack_from('<7d', data, offset))
        _, end = ends_of_poses(pose[None], self._tree.length[self._tip, None])
        return end[0] - self._tree.end[self._tip]

    def _receive_wind(self, message: Any) -> None:
        stamp, vector = message.header.stamp, message.vector
        wind, arrival = np.array([vector.x, vector.y, vector.z]), time.time()
        self.record.wind_arrival.append(arrival)
        self.record.wind.append(wind)
        self.record.forget(arrival - WINDOW)
        self.totals.add_wind(stamp.sec + 1e-9 * stamp.nanosec, wind)
