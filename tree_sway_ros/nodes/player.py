# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The player node: a recorded wind, at its rate or faster, once or repeated."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tree_sway.errors import LONGEST_NOTE, ParameterError, shown
from tree_sway.files import reader_options
from tree_sway.files.wind import read_wind
from tree_sway_ros.nodes.recorded_imu import RecordedImu
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import CLOCK, IMU, WIND, WIND_FILTERED
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.timing.playback import is_ros_time, Playback
from tree_sway_ros.wire.wind_messages import clock_message, WindWriter


class PlayerNode(TreeSwayNode):
    """Publishes `wind` from a record, and `/clock` if enabled."""

    def configure(self) -> None:
        """Read the record."""
        if not self.values['file']:
            raise ParameterError('no file to play', cure='give -p file:=wind.csv')
        options: dict[str, Any] = {**reader_options(self.values['reader_options'].split())}
        self._record = read_wind(self.values['file'], **options)
        self._writer = WindWriter(
            **self.values.subset('output_type', 'direction_convention', 'frame_id')
        )
        has_clock = self.values['publish_clock']
        self._wind = self.publisher(WIND, self._writer.message_class, is_replay=has_clock)
        for note in self._record.notes:
            self.get_logger().info(shown(note, LONGEST_NOTE))
        self._ticks: Any = self.publisher(CLOCK) if has_clock else None
        self._motion = RecordedImu(self.values['file'], self.values['imu'], self._record.epoch)
        self._imu = [
            self.publisher(replace(IMU, name=topic), is_replay=has_clock)
            for topic in self._motion.topics
        ]
        self._rows = self._motion.joined(self._record.time)
        epoch = self._record.epoch
        if has_clock and not is_ros_time(epoch, self._record.time):
            self.get_logger().warning(
                f'{self._record.source} is dated outside 1970 .. 2038, the range of /clock: '
                'it starts at 1 s'
            )
            epoch = None
        self._playback = Playback(
            self._rows.time, self._publish,
            may_start=lambda: self._wind.get_subscription_count() > 0, on_end=self._end,
            lacking=self._lacking, say=self.get_logger().info, on_error=self.fail,
            start_at=self.values['start'], epoch=epoch, has_clock=has_clock,
            **self.values.subset('rate', 'loop'),
        )  # fmt: skip
        self.report_with(self._record.source, self._report)

    @property
    def length(self) -> float:
        """Time from the start of the playback to the end of the record [s]."""
        return self._record.duration - float(self.values['start'])

    def activate(self) -> None:
        """Play from the start, once there is a subscriber."""
        self.run_worker(self._playback)

    def _lacking(self) -> str:
        """Return which topics lack subscribers, that of the wind node among them."""
        wanted = {each.topic_name: 1 for each in self._imu}
        filtered = self.resolve_topic_name(WIND_FILTERED.name)
        if self.count_publishers(filtered):
            wanted[filtered] = self.values['subscribers']
        counts = {topic: self.count_subscribers(topic) for topic in wanted}
        return ', '.join(
            f'subscribers of {topic} ({counts[topic]} of {count})'
            for topic, count in wanted.items()
            if counts[topic] < count
        )

    def _publish(self, row: int, stamp: int) -> None:
        if row < 0:
            self._ticks.publish(clock_message(stamp))
            return
        source = int(self._rows.source[row])
        sample = int(self._rows.sample[row])
        if source < 0:
            self._wind.publish(self._writer.message(stamp, self._record.velocity[sample]))
        else:
            self._imu[source].publish(self._motion.message(source, sample, stamp))

    def _end(self) -> None:
        self.get_logger().info('the record has ended')
        self.is_done = True

    def _report(self) -> list[Status]:
        values = {**self._playback.progress(), 'refused in file': self._record.refused}
        if waits_for := self._playback.waits_for:
            return [Status('playback', WARN, f'waiting for {waits_for}', values)]
        return [Status('playback', OK, self._record.source, values)]
