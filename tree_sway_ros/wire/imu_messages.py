# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Motion in a message ``sensor_msgs/Imu``, to numbers.

Frames and units are those of REP-103 and REP-145: an acceleration with gravity and an angular rate
in the sensor's frame, and its orientation to east, north, up. A quantity whose covariance begins
with -1 is not measured; a covariance of zeros is unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import Any, NamedTuple

from sensor_msgs.msg import Imu

from tree_sway_ros.wire.wind_messages import fill_stamp, stamp_to_ns


class ImuSample(NamedTuple):
    """
    Stamp [ns], 0 where the message has none, and what was measured, None elsewhere.

    ``noise`` are the standard deviations of acceleration, rate and orientation that the message
    states, 0 where unknown.
    """

    stamp: int
    acceleration: tuple[float, ...] | None
    rate: tuple[float, ...] | None
    orientation: tuple[float, ...] | None
    noise: tuple[float, float, float]


def motion_from_message(message: Any) -> ImuSample:
    """Return the motion of a message."""
    turn = message.orientation
    parts = (
        (message.linear_acceleration, message.linear_acceleration_covariance),
        (message.angular_velocity, message.angular_velocity_covariance),
    )
    vectors = [
        None if covariance[0] == -1.0 else (vector.x, vector.y, vector.z)
        for vector, covariance in parts
    ]
    stated = message.orientation_covariance
    quaternion = (turn.x, turn.y, turn.z, turn.w)
    is_turned = stated[0] != -1.0 and any(quaternion)
    return ImuSample(
        stamp_to_ns(message.header.stamp),
        vectors[0],
        vectors[1],
        quaternion if is_turned else None,
        (_deviation(parts[0][1]), _deviation(parts[1][1]), _deviation(stated)),
    )


def imu_message(
    stamp: int,
    acceleration: Sequence[float] | None,
    rate: Sequence[float] | None,
    orientation: Sequence[float] | None,
) -> Any:
    """Make a message of a stamp [ns]; covariances of what is None begin with -1, others are 0."""
    message = Imu()
    fill_stamp(message.header.stamp, stamp)
    for values, part, covariance, names in (
        (acceleration, message.linear_acceleration, message.linear_acceleration_covariance, 'xyz'),
        (rate, message.angular_velocity, message.angular_velocity_covariance, 'xyz'),
        (orientation, message.orientation, message.orientation_covariance, 'xyzw'),
    ):
        if values is None:
            covariance[0] = -1.0
            continue
        for name, value in zip(names, values, strict=True):
            setattr(part, name, float(value))
    return message


def _deviation(covariance: Any) -> float:
    """Root of the largest variance of a covariance of nine numbers; 0 for none that is known."""
    largest = max(float(covariance[0]), float(covariance[4]), float(covariance[8]))
    return math.sqrt(largest) if 0.0 < largest < math.inf else 0.0
