# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind of a ROS graph for ``tree-sway relay``, found by the entry point of the package."""

from __future__ import annotations

from collections.abc import Callable

from tree_sway_ros.process.listener import Listener
from tree_sway_ros.process.topics import message_class, qos_profile, WIND_FILTERED


class RosWind(Listener):
    """`wind/filtered` of this site as bytes: heard where it sends, published where it receives."""

    def __init__(self, hears: bool) -> None:
        super().__init__('tree_sway_relay')
        self._heard: list[bytes] = []
        kind, name = message_class(WIND_FILTERED), WIND_FILTERED.name
        quality = qos_profile(WIND_FILTERED)
        self.publish: Callable[[bytes], None] = lambda data: None
        if hears:
            self.node.create_subscription(kind, name, self._heard.append, quality, raw=True)
        else:
            self.publish = self.node.create_publisher(kind, name, quality).publish

    def taken(self, seconds: float) -> list[bytes]:
        """Take what has come, after waiting this time for more [s]."""
        self.spin_once(seconds)
        taken = self._heard.copy()
        self._heard.clear()
        return taken
