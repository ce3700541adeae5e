"""
Listens to a swaying tree as any other program would: poses as bytes, over DDS.

"""

from __future__ import annotations

import math
import struct
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import TransportError
from tree_sway_ros.ros.process.topics import (
    SEGMENT_POSES,
    WIND,
    WIND_FILTERED,
    message_class,
    qos_profile,
)
from tree_sway_ros.view.projection import ends_of_poses

_POSE = 7 * 8
_LOOK_AROUND = 1.0  # [s]: how long programs that run already take to be seen


@dataclass
class StreamRecord:
    """
    What was received, one item a message.

    Parameters
    ----------
    arrival, stamp
        When each pose array arrived and what time it shows, in [s].
    tip
        Displacement of the highest tip from rest in each pose array in [m], (3,); empty if no tree
        is followed.
    wind_stamp, wind
        When each wind sample was measured in [s], and the sample in [m/s], (3,).

    """

    arrival: list[float] = field(default_factory=list)
    stamp: list[float] = field(default_factory=list)
    tip: list[Floats] = field(default_factory=list)
    wind_stamp: list[float] = field(default_factory=list)
    wind: list[Floats] = field(default_factory=list)

    def since(self, begin: float) -> StreamRecord:
        """Return the poses that arrived, and the wind that was measured, at a time or later."""
        poses = [i for i, arrival in enumerate(self.arrival) if arrival >= begin]
        winds = [i for i, stamp in enumerate(self.wind_stamp) if stamp >= begin]
        return StreamRecord(
            [self.arrival[i] for i in poses],
            [self.stamp[i] for i in poses],
            [self.tip[i] for i in poses if self.tip],
            [self.wind_stamp[i] for i in winds],
            [self.wind[i] for i in winds],
        )

    @property
    def pose_rate(self) -> float:
        """Pose arrays a second in [Hz]; 0 if there are fewer than two."""
        return rate_of(self.arrival)

    @property
    def wind_rate(self) -> float:
        """Wind samples a second in [Hz]; 0 if there are fewer than two."""
        return rate_of(self.wind_stamp)

    def latency(self, share: float) -> float:
        """Quantile of the time from stamp to arrival in [s]; NaN if nothing arrived."""
        late = np.array(self.arrival) - np.array(self.stamp)
        return float(np.quantile(late, share)) if len(late) else math.nan

    def missing(self, rate: float) -> int:
        """Frames of the grid between the first and the last that never came."""
        if len(self.stamp) < 2:
            return 0
        return round((self.stamp[-1] - self.stamp[0]) * rate) + 1 - len(self.stamp)


def rate_of(times: list[float]) -> float:
    """Mean rate of events in [Hz] from their times in [s]; 0 if there are fewer than two."""
    if len(times) < 2 or times[-1] <= times[0]:
        return 0.0
    return (len(times) - 1) / (times[-1] - times[0])


class StreamMonitor:
    """
    A node that receives poses and wind.

    Parameters
    ----------
    context
        ROS context to live in.
    tree
        The tree that sways, for its rest shape; without it poses are counted and its tip is not
        followed.
    namespace
        Of the tree's nodes.

    """

    def __init__(self, context: Any, tree: Tree | None, namespace: str = "") -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self.record = StreamRecord()
        self._tree = tree
        self._tip = 0 if tree is None else int(np.argmax(tree.end[:, 2]))
        self._node = rclpy.create_node("monitor", context=context, namespace=namespace)
        for topic, callback, raw in (
            (SEGMENT_POSES, self._receive_poses, True),
            (WIND_FILTERED, self._receive_wind, False),
        ):
            qos = qos_profile(topic)
            self._node.create_subscription(message_class(topic), topic.name, callback, qos, raw=raw)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self._node)

    def wait(self, seconds: float) -> None:
        """Receive for a while."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def expect_silence(self) -> None:
        """
        Look around before publishing: a second wind or tree on the same topics would mix with ours.

        Raises
        ------
        TransportError
            If somebody publishes there already.

        """
        self.wait(_LOOK_AROUND)
        for topic in (WIND, SEGMENT_POSES):
            if self._node.count_publishers(topic.name):
                raise TransportError(
                    f"another program publishes '{topic.name}' in this ROS domain",
                    cure="end it, or set ROS_DOMAIN_ID to another number up to 101",
                )

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self._node.destroy_node()

    def _receive_poses(self, data: bytes) -> None:
        self.record.arrival.append(time.time())
        # CDR: four bytes of header, the stamp, the frame's name; the poses are what it ends with.
        second, nanosecond = struct.unpack_from("<iI", data, 4)
        self.record.stamp.append(second + 1e-9 * nanosecond)
        if self._tree is not None:
            offset = len(data) - (self._tree.n_segments - self._tip) * _POSE
            pose = np.array(struct.unpack_from("<7d", data, offset))
            _, end = ends_of_poses(pose[None], self._tree.length[self._tip, None])
            self.record.tip.append(end[0] - self._tree.end[self._tip])

    def _receive_wind(self, message: Any) -> None:
        stamp = message.header.stamp
        self.record.wind_stamp.append(stamp.sec + 1e-9 * stamp.nanosec)
        vector = message.vector
        self.record.wind.append(np.array([vector.x, vector.y, vector.z]))
