# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind of a remote site as samples of an anemometer on `wind`."""

from __future__ import annotations

import time
from typing import Any

from tree_sway.stream import Frame, PAUSED, StreamClient, WIND_LOST
from tree_sway_ros.process.topics import DIAGNOSTICS, message_class, qos_profile, WIND
from tree_sway_ros.reports.diagnostics import OK, Status, status_array, WARN
from tree_sway_ros.wire.wind_messages import WindWriter

_REPORT_EVERY = 1.0
"""Interval of reports on `/diagnostics` [s]."""

_OVERDUE = 2.0
"""Time without a frame after which the remote site counts as lost [s]."""


class Relay:
    """
    Publisher of the remote wind, as long as a sensor measures it there.

    A frame of a paused tree repeats an old wind, and one without a measured wind has the decaying
    or the calm wind of its solver: neither is a sample.
    """

    def __init__(self, node: Any) -> None:
        self.published = 0
        """Number of samples."""
        self._writer = WindWriter('geometry_msgs/Vector3Stamped', 'to', 'map')
        self._node = node
        self._wind = node.create_publisher(message_class(WIND), WIND.name, qos_profile(WIND))
        self._diagnostics = node.create_publisher(
            message_class(DIAGNOSTICS), DIAGNOSTICS.name, qos_profile(DIAGNOSTICS)
        )
        self._flags = 0
        self._arrival = time.monotonic()
        self._reported = -_REPORT_EVERY
        self._text = ''

    def take(self, frame: Frame, _arrival: float) -> None:
        """Publish the wind of a frame if it is a sample; called by the client's thread."""
        self._flags = frame.flags
        self._arrival = time.monotonic()
        if not frame.flags & (PAUSED | WIND_LOST):
            self._wind.publish(self._writer.message(frame.stamp, frame.wind))
            self.published += 1

    def status(self, client: StreamClient) -> Status:
        """Status of the wind for `/diagnostics`."""
        silence = time.monotonic() - self._arrival
        values: dict[str, object] = {
            'samples': self.published,
            'frames': client.received,
            'unreadable': client.unreadable,
            'connection': client.state,
            'age of the last frame [s]': silence,
        }
        level = OK
        text = f'the wind of {client.url}'
        if silence > _OVERDUE:
            level = WARN
            text = f'nothing from {client.url} for {silence:.0f} s: {client.problem}'
        elif self._flags & PAUSED:
            level = WARN
            text = 'nothing is published: the remote tree is paused'
        elif self._flags & WIND_LOST:
            level = WARN
            text = 'nothing is published: the remote site has no measured wind'
        return Status('wind', level, text, values)

    def report(self, client: StreamClient) -> None:
        """Publish the status if it is due, and print it when the wind is lost or back."""
        now = time.monotonic()
        if now - self._reported < _REPORT_EVERY:
            return
        self._reported = now
        status = self.status(client)
        name = self._node.get_fully_qualified_name().lstrip('/')
        stamp = self._node.get_clock().now().to_msg()
        array = status_array([status], prefix=name, hardware=client.url, stamp=stamp)
        self._diagnostics.publish(array)
        heading = status.message.partition(':')[0]
        if heading != self._text and (self._text or status.level != OK):
            print(status.message, flush=True)
        self._text = heading
