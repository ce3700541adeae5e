# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind node: samples of an anemometer to the wind of the trees."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
import math
import time
from typing import Any

from geometry_msgs.msg import Vector3Stamped
from rclpy.clock import JumpThreshold
from rclpy.duration import Duration

from tree_sway.core.wind import WindConvention, WindGate, WindIntake
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import WIND, WIND_FILTERED, WIND_FORCE_PLANE
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.wind_report import WindReport
from tree_sway_ros.wire.force_plane import ForcePlane
from tree_sway_ros.wire.wind_messages import (
    plane_message,
    WIND_CLASSES,
    wind_from_message,
    wind_to_message,
    WindSample,
)

_CONVENTION = ('direction_convention', 'speed_scale', 'yaw_offset', 'plane_normal')
_GATE = ('max_speed', 'max_rate', 'longest_refusal', 'frozen_after')

_BACK = 100_000_000
"""Smallest step back of time that is a reset [ns]; smaller ones are jitter."""

_LONGEST_HOLD = 5.0
"""Time [s] of the machine for which a replay's first samples wait for a subscriber."""

_RECENT = 5.0
"""Time for which a sample in a different frame is reported [s]."""


class WindNode(TreeSwayNode):
    """Subscribes `wind`, publishes `wind/filtered` and `wind/force_plane`."""

    def configure(self) -> None:
        """Subscribe and publish; samples are dropped while inactive."""
        self._report = WindReport()
        self._convention = WindConvention(**self.values.subset(*_CONVENTION))
        self._intake = WindIntake(self._convention, WindGate(**self.values.subset(*_GATE)))
        self._force_plane = ForcePlane(self._convention)
        self._frames: Any = None
        self._filtered = self.publisher(WIND_FILTERED)
        self._held: list[Any] = []
        self._held_since: float | None = None
        self._plane = self.publisher(WIND_FORCE_PLANE)
        kind = WIND_CLASSES[self.values['input_type']]
        self._topic = self.subscription(WIND, self._receive, kind).topic_name
        self.report_with('wind', self._statuses)
        read_by = self.values.subset(*_CONVENTION).items()
        said = ', '.join(f'{name} {value}' for name, value in read_by)
        self.get_logger().info(f'reading wind by {said}')

    def activate(self) -> None:
        """Reset the gate where simulated time is set back."""
        back = JumpThreshold(
            min_forward=None, min_backward=Duration(nanoseconds=-_BACK), on_clock_change=False
        )
        jumps = self.get_clock().create_jump_callback(
            back, post_callback=lambda _jump: self._intake.gate.reset()
        )
        self.on_close(jumps.unregister)

    def on_change(self, values: dict[str, Any]) -> None:
        """Apply a new convention from the next sample on."""
        self._convention = WindConvention(**self.values.subset(*_CONVENTION))
        self._intake.convention = self._convention
        self._force_plane = ForcePlane(self._convention)

    def _receive(self, message: Any, info: Mapping[str, Any]) -> None:
        if not self.is_active:
            return
        self._report.gaps.note(info)
        count = partial(self.count_publishers, self._topic)
        if not self._report.followed.admits(info, count, time.monotonic()):
            return
        sample = wind_from_message(message)
        frame_id = self.values['frame_id']
        turn = None
        if sample.frame_id not in ('', frame_id):
            # It is slow to load, and seldom needed.
            from tree_sway_ros.wire.frames import FrameListener

            self._frames = self._frames or FrameListener(self, frame_id)
            turn = self._frames.rotation(sample.frame_id)
            if self._frames.is_waiting:
                return
        components = (sample.u, sample.v, sample.w)
        arrival = self.get_clock().now().nanoseconds or None  # simulated time has not begun
        good = self._intake.offer(
            sample.stamp, components, arrival, rotation=turn, **self.stamp_limits
        )
        if good is None:
            return
        self._report.add(self._intake.left_out)
        at, vector = good
        self._send(wind_to_message(Vector3Stamped, WindSample(at, frame_id, *vector)))
        self._plane.publish(plane_message(at, frame_id, self._force_plane.turn(vector)))

    def _send(self, message: Any) -> None:
        """Publish a sample; the first of a replay with a subscriber, which may be on its way."""
        self._held.append(message)
        if self.is_simulated and not self._filtered.get_subscription_count():
            now = time.monotonic()
            self._held_since = now if self._held_since is None else self._held_since
            if now < self._held_since + _LONGEST_HOLD:
                return
        self._held_since = -math.inf
        for each in self._held:
            self._filtered.publish(each)
        self._held.clear()

    def _statuses(self) -> list[Status]:
        gate = self._intake.gate
        others = self._types_not_read()
        publishers = self.publishers_of(self._topic, self.values['input_type'])
        replay = self.clock_rate.rate if self.is_simulated else None
        wind = self._report.status(self.values['timeout'], gate, others, publishers, replay)
        level = OK
        text = f"the wind is in frame '{self.values['frame_id']}'"
        if self._frames is not None and self._frames.age < _RECENT:
            level = WARN if self._frames.is_lacking else OK
            text = self._frames.text
        return [wind, Status('frame', level, text)]

    def _types_not_read(self) -> list[str]:
        """Types other than `input_type` that are published on the topic."""
        offered = self.get_publishers_info_by_topic(self._topic)
        names = {publisher.topic_type.replace('/msg/', '/') for publisher in offered}
        return sorted(names - {self.values['input_type']})
