# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind in a message: the four types of common_interfaces that drivers use, to and from numbers.

There is no standard wind message. All four have a vector of three numbers; unit, sign and frame
are converted by `core.wind.convention`.
"""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any, NamedTuple

from geometry_msgs.msg import (
    PoseStamped,
    TwistStamped,
    TwistWithCovarianceStamped,
    Vector3,
    Vector3Stamped,
)
from rosgraph_msgs.msg import Clock

from tree_sway.core.wind import WindConvention

_SECOND = 1_000_000_000


class WindSample(NamedTuple):
    """
    A wind vector of a message, in the unit and convention of the sender.

    The stamp [ns] is 0, and the frame empty, where the message has none.
    """

    stamp: int
    frame_id: str
    u: float
    v: float
    w: float


_VECTORS: dict[Any, Callable[[Any], Any]] = {
    Vector3Stamped: lambda message: message.vector,
    TwistStamped: lambda message: message.twist.linear,
    TwistWithCovarianceStamped: lambda message: message.twist.twist.linear,
    Vector3: lambda message: message,
}
#: By their names, as parameters have them: ``geometry_msgs/Vector3Stamped``.
WIND_CLASSES = {f'geometry_msgs/{each.__name__}': each for each in _VECTORS}


def wind_from_message(message: Any) -> WindSample:
    """
    Read a wind message of any of the four types.

    A covariance that begins with -1 means no reading, as in REP-145 for an IMU: then the vector is
    not a number, which the gate refuses and counts.
    """
    vector = _VECTORS[type(message)](message)
    if type(message) is TwistWithCovarianceStamped and message.twist.covariance[0] == -1.0:
        vector = Vector3(x=math.nan, y=math.nan, z=math.nan)
    header = getattr(message, 'header', None)
    if header is None:
        return WindSample(0, '', vector.x, vector.y, vector.z)
    return WindSample(stamp_to_ns(header.stamp), header.frame_id, vector.x, vector.y, vector.z)


def wind_to_message(message_class: Any, sample: WindSample) -> Any:
    """Write a wind message of any of the four types."""
    message = message_class()
    vector = _VECTORS[message_class](message)
    vector.x, vector.y, vector.z = map(float, sample[2:])
    if hasattr(message, 'header'):
        fill_stamp(message.header.stamp, sample.stamp)
        message.header.frame_id = sample.frame_id
    return message


class WindWriter:
    """Writer of wind messages of a driver: one of the four types, vectors ``to`` or ``from``."""

    def __init__(self, output_type: str, direction_convention: str, frame_id: str) -> None:
        self.message_class = WIND_CLASSES[output_type]
        self._convention = WindConvention(direction_convention)
        self._frame_id = frame_id

    def message(self, stamp: int, velocity: Any) -> Any:
        """Write a velocity, blowing to, ENU in [m/s], (3,), stamped with a time in [ns]."""
        components = self._convention.components(velocity)
        return wind_to_message(self.message_class, WindSample(stamp, self._frame_id, *components))


def plane_message(stamp: int, frame_id: str, wxyz: Any) -> Any:
    """Write the orientation of the force plane as a PoseStamped at the origin."""
    message = PoseStamped()
    fill_stamp(message.header.stamp, stamp)
    message.header.frame_id = frame_id
    to = message.pose.orientation
    to.w, to.x, to.y, to.z = map(float, wxyz)
    return message


def clock_message(stamp: int) -> Any:
    """Write a time in [ns] as a Clock."""
    message = Clock()
    fill_stamp(message.clock, stamp)
    return message


def stamp_to_ns(stamp: Any) -> int:
    """Time of a ``builtin_interfaces/Time`` in [ns]."""
    return int(stamp.sec) * _SECOND + int(stamp.nanosec)


def fill_stamp(stamp: Any, nanoseconds: int) -> None:
    """Write a time in [ns] into a ``builtin_interfaces/Time``."""
    stamp.sec, stamp.nanosec = divmod(int(nanoseconds), _SECOND)
