# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The sensor node: a live source of wind, as a real anemometer or a weather service."""

from __future__ import annotations

from typing import Any

from tree_sway.files.wind import Velocity
from tree_sway.live import InstrumentLines, LiveWind, open_source
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import WIND
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.recent_counts import is_fault, listed, RecentCounts
from tree_sway_ros.wire.wind_messages import WindWriter

_GUSTS_EVERY = 0.1
"""Period of the samples of gusts about a mean [s]."""


class SensorNode(TreeSwayNode):
    """
    Publishes `wind` of a source, stamped with the time of arrival.

    Means over 20 s and more are published as gusts about them, ten samples per second.
    """

    _wind: LiveWind

    def configure(self) -> None:
        """Prepare the link."""
        self._writer = WindWriter(
            **self.values.subset('output_type', 'direction_convention', 'frame_id')
        )
        self._publisher = self.publisher(WIND, self._writer.message_class)
        self._recent = RecentCounts()
        source = open_source(self.values['address'])
        self._lines = source.read
        self._messages = source.messages
        is_of_lines = isinstance(self._lines, InstrumentLines)
        self._wind = LiveWind(
            source,
            self.get_logger().info,
            taken=self.guard.wrapped(self._publish),
            silence=self.values['silence'] if is_of_lines else None,
        )
        self.on_change(self.values.subset())
        self.create_steady_timer(_GUSTS_EVERY, self._blow)
        self.report_with(self.values['address'], self._report)

    def activate(self) -> None:
        """Start to listen."""
        self.on_close(self._wind.stop)
        self._wind.start()

    def check_values(self, values: dict[str, Any]) -> None:
        """Check the address."""
        open_source(values['address'])

    def on_change(self, values: dict[str, Any]) -> None:
        """Follow the directions of the instrument."""
        if not hasattr(self, '_wind'):  # parameters may change before it is configured
            return
        self._wind.bearing = self.values['bearing']
        lines = self._lines
        if isinstance(lines, InstrumentLines):
            lines.sentence = self.values['sentence']
            lines.heading = self.values['heading']
            lines.declination = self.values['declination']

    def _publish(self, velocity: Velocity) -> None:
        self._publisher.publish(self._writer.message(self.get_clock().now().nanoseconds, velocity))

    def _blow(self) -> None:
        """Publish the newest gust about a mean."""
        if samples := self._wind.drain():
            self._publish(samples[-1][1])

    def _report(self) -> list[Status]:
        wind = self._wind
        link = self._wind.link
        newest = wind.newest
        recent = self._recent.growth({**wind.refused, '': wind.accepted})
        refused = {cause: count for cause, count in recent.items() if cause and count}
        reading = newest.kind if newest is not None else ''
        values: dict[str, object] = {
            'reading': reading,
            'connections made': link.connections,
            'messages': link.messages,
            'accepted': wind.accepted,
            'other messages': wind.other,
            'gusts about means': wind.is_mean,
            'messages as of two senders': wind.every_other.total,
            **{f'refused: {cause}': count for cause, count in sorted(wind.refused.items())},
        }
        if not wind.accepted or not link.is_up:
            text = wind.problem or f'no link: {link.failure}'
        elif is_fault(sum(refused.values()), sum(refused.values()) + recent['']):
            text = f'{reading}; {self._messages} refused: {listed(refused)}'
        elif wind.state == 'stale':
            text = f'{reading}; none for {wind.age:.0f} s'
        elif problem := wind.every_other.problem:
            text = f'{reading}; {problem}'
        else:
            return [Status('link', OK, reading, values)]
        return [Status('link', WARN, text, values)]
