# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The player node: a recorded wind, as it was, faster, or around and around."""

from __future__ import annotations

from collections.abc import Callable
import time
from typing import Any

from tree_sway.errors import ParameterError
from tree_sway.files.reader_options import reader_options
from tree_sway.files.wind.wind_file import read_wind
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import (
    CLOCK,
    SEGMENT_POSES,
    WIND,
    WIND_FILTERED,
)
from tree_sway_ros.reports.diagnostics import OK, Status
from tree_sway_ros.timing.handshake import Answers, Audience, required
from tree_sway_ros.timing.playback import is_ros_time, LONGEST_CLOCK_STEP, Playback
from tree_sway_ros.timing.playback_thread import PlaybackThread
from tree_sway_ros.wire.cdr import stamp_of
from tree_sway_ros.wire.wind_messages import clock_message, WindWriter

_SLACK = 100_000_000
"""The clock may be ahead of the frames of an exact replay by this time [ns]."""
_BACK = 300_000_000
"""Time before its beginning at which the clock of an exact replay waits [ns]."""
_FURTHER = 3 * _BACK
"""The same [ns] for a solver that was under way before, so that it begins again."""
_STILL = 3.0
"""Time without a frame [s] after which a solver needs that."""
_PATIENCE = 15.0
"""Wait for a solver that shows no frame of that time [s]."""
_MEETING = 2.0
"""From the solver's frame to the first sample [s]: wind node and solver must have met as well."""


class PlayerNode(TreeSwayNode):
    """Publishes `wind` or the state of a tree from a record, and `/clock` if asked to."""

    def configure(self) -> None:
        """Read the record."""
        if not self.values['file']:
            raise ParameterError('no file to play', cure='give -p file:=wind.csv')
        self._open_wind()
        for note in self._record.notes:
            self.get_logger().info(note)
        has_clock = self.values['publish_clock']
        self._clock_publisher: Any = self.publisher(CLOCK) if has_clock else None
        epoch = self._record.epoch
        if has_clock and not is_ros_time(epoch, self._record.time):
            self.get_logger().warning(
                f'{self._record.source} is dated outside 1970 .. 2038, which /clock cannot say: '
                'it starts at 1 s'
            )
            epoch = None
        wanted = required(self.values['wait_for'])
        self._audience = Audience(wanted, self.listeners, self.get_logger().info)
        is_exact = has_clock and WIND_FILTERED.name in wanted
        self._playback = Playback(
            self._record.time,
            epoch=epoch,
            **self.values('start', 'loop'),
            clock_period=self.values['rate'] / self.values['clock_rate'] if has_clock else 0.0,
            ahead=is_exact,
        )
        self._answers: Answers | None = None
        self._deadline = self._met = 0.0
        self._expect()
        if is_exact:
            self._answers = Answers(_SLACK)
            self.subscription(SEGMENT_POSES, self._hear, raw=True)
            self.subscription(WIND_FILTERED, self._hear_wind, raw=True)
        self._thread = PlaybackThread(
            self._playback,
            self.values['rate'],
            publish=self._publish,
            may_start=self._may_start,
            on_end=self._end,
            on_error=self.fail,
        )
        self.report_with(self._record.source, self._report)

    def _open_wind(self) -> None:
        options: dict[str, Any] = {**reader_options(self.values['reader_options'].split())}
        record = read_wind(self.values['file'], **options)
        writer = WindWriter(**self.values('output_type', 'direction_convention', 'frame_id'))
        wind = self.publisher(WIND, writer.message_class, alone=True)
        self._record = record
        self._send: Callable[[int, int], None] = lambda row, stamp: wind.publish(
            writer.message(stamp, record.velocity[row])
        )

    def activate(self) -> None:
        """Play from the start, once those who must listen do."""
        self._expect()
        self.run_worker(self._thread)

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse a clock in steps so long that nodes would take them for a clock set forward."""
        rate, clock_rate = values['rate'], values['clock_rate']
        step, longest = rate / clock_rate, LONGEST_CLOCK_STEP
        if values['publish_clock'] and step > longest:
            raise ParameterError(
                f'/clock would go in steps of {step:g} s; nodes follow up to {longest:g} s',
                where="parameters 'rate' and 'clock_rate'",
                cure=f'give rate up to {longest * clock_rate:g}, or clock_rate {rate / longest:g}',
            )

    def _expect(self) -> None:
        """Begin to wait for a solver that has begun, and for the wind to come through to it."""
        self._is_waiting, self._has_begun, self._has_blown = True, False, False
        self._back = _BACK

    def _publish(self, row: int, stamp: int) -> None:
        if row >= 0:
            self._send(row, stamp)
            return
        if self._answers is not None and self._is_waiting:
            stamp -= self._back
        elif self._answers is not None:
            self._answers.wait()
            self._answers.sent(stamp)
        self._clock_publisher.publish(clock_message(stamp))

    def _hear(self, data: bytes) -> None:
        stamp = stamp_of(data)
        ahead = self._playback.epoch - stamp - self._back
        if ahead > _BACK // 2 and self._back == _BACK:  # a solver of an earlier time, not at rest
            self._back = _FURTHER
        else:
            self._has_begun |= ahead >= 0
        if self._answers is not None:
            self._answers.heard(stamp)

    def _hear_wind(self, data: bytes) -> None:
        self._has_blown |= stamp_of(data) == self._playback.epoch

    def _may_start(self) -> bool:
        now = time.monotonic()
        if not self._audience.is_there():
            self._deadline, self._met = now + _PATIENCE, now + _MEETING
            return False
        if self._answers is None or (self._has_begun and self._has_blown):
            self._is_waiting = False
            return True
        if now > self._deadline:
            self.get_logger().warning('no frames come back: this replay will not be exact')
            self._is_waiting = False
            return True
        if not self._has_begun:
            self._met = now + _MEETING
            if now > self._deadline - _PATIENCE + _STILL:  # a solver is at that very time
                self._back = _FURTHER
        self._is_waiting = not self._has_begun
        if now > self._met:  # the first sample is sent until it has come through
            self._publish(self._playback.first_row, self._playback.epoch)
        return False

    def _end(self) -> None:
        if self._answers is not None:  # what is under way is lost with whoever sent it
            self._answers.end(lambda time: self._clock_publisher.publish(clock_message(time)))
        self.get_logger().info('the record has ended')
        self.is_done = True

    def _report(self) -> list[Status]:
        values = {**self._thread.progress(), 'refused in file': self._record.refused}
        if self._answers is not None:
            values['waited for frames in vain'] = self._answers.missing
        return [Status('playback', OK, self._record.source, values)]
