# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The sensor node: a real anemometer with NMEA 0183 or the lines of Gill."""

from __future__ import annotations

from typing import Any

from tree_sway.files.wind.nmea import parse_nmea
from tree_sway.files.wind.sonic_ascii import parse_sonic
from tree_sway_ros.link.address import read_address
from tree_sway_ros.link.line_source import LineSource
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import WIND
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.recent_counts import is_fault, listed, RecentCounts
from tree_sway_ros.wire.wind_messages import WindWriter


class SensorNode(TreeSwayNode):
    """Publishes `wind` of an instrument, stamped with the time of arrival."""

    def configure(self) -> None:
        """Prepare the link."""
        self._writer = WindWriter(**self.values('output_type', 'direction_convention', 'frame_id'))
        self._publisher = self.publisher(WIND, self._writer.message_class)
        self._kind = self.values['sentence']
        self._accepted = self._other = 0
        self._refused: dict[str, int] = {}
        self._recent = RecentCounts()
        self._source = LineSource(
            read_address(self.values['address']),
            self.guard.wrapped(self._take),
            self.get_logger().info,
            silence=self.values['silence'],
        )
        self.report_with(self.values['address'], self._report)

    def activate(self) -> None:
        """Start to listen."""
        self.run_worker(self._source)

    def check_values(self, values: dict[str, Any]) -> None:
        """Check the address."""
        read_address(values['address'])

    def _take(self, line: str) -> None:
        heading = self.values['heading']
        said = parse_nmea(line, heading, self.values['declination']) or parse_sonic(line, heading)
        if said is None:
            self._other += 1
            return
        if self._kind == 'auto' and said.velocity is not None:
            self._kind = said.kind  # the first good one; a change of reference would be a jump
            self.get_logger().info(f'reading {said.kind}')
        if said.kind != self._kind:
            self._other += 1
        elif said.velocity is None:
            cause = said.refusal.split("'")[0].strip()
            self._refused[cause] = self._refused.get(cause, 0) + 1
        else:
            self._accepted += 1
            stamp = self.get_clock().now().nanoseconds
            self._publisher.publish(self._writer.message(stamp, said.velocity))

    def _report(self) -> list[Status]:
        source = self._source
        recent = self._recent.growth({**self._refused, '': self._accepted})
        refused = {cause: count for cause, count in recent.items() if cause and count}
        values: dict[str, object] = {
            'reading': self._kind,
            'links made': source.links,
            'lines': source.lines,
            'accepted': self._accepted,
            'other lines': self._other,
            **{f'refused: {cause}': count for cause, count in sorted(self._refused.items())[:20]},
        }
        if not source.is_up:
            return [Status('link', WARN, f'no link: {source.failure or "not yet"}', values)]
        if not self._accepted:
            text = f'no sentence of wind yet in {source.lines} lines'
            return [Status('link', WARN, text, values)]
        if is_fault(sum(refused.values()), sum(refused.values()) + recent['']):
            text = f'{self._kind}; lines refused: {listed(refused)}'
            return [Status('link', WARN, text, values)]
        return [Status('link', OK, f'{self._kind}', values)]
