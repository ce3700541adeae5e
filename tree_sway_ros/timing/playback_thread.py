# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A thread that publishes the events of a `Playback` when they are due."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import time

from tree_sway_ros.timing.handshake import SETTLING
from tree_sway_ros.timing.playback import Playback
from tree_sway_ros.timing.worker import Worker

_LATEST = 0.5
_POLL = 0.02


@dataclass(eq=False)
class PlaybackThread(Worker):
    """
    Plays the events of a record at a multiple of real time, once ``may_start`` is true.

    Stamps are the record's own time where it drives /clock, else the wall time at which each
    sample is due. Should the machine sleep, the playback goes on from where it was, without a
    burst. `publish` is called with the row of the record (-1: a tick of /clock) and the stamp in
    [ns]; `on_error` with what it raised.
    """

    playback: Playback
    speed: float
    publish: Callable[[int, int], None]
    may_start: Callable[[], bool]
    on_end: Callable[[], None]
    on_error: Callable[[Exception], None]

    def __post_init__(self) -> None:
        """Prepare the thread."""
        super().__init__('playback')
        self._position = 0.0
        self._samples = self._stalls = 0

    def progress(self) -> dict[str, float]:
        """How far it is, for reports."""
        return {
            'position [s]': self._position % self.playback.round,
            'rounds': float(self._position // self.playback.round),
            'samples': float(self._samples),
            'stalls': float(self._stalls),
        }

    def _run(self) -> None:
        try:
            while not self.may_start():
                if self.playback.has_clock:
                    self.publish(-1, self.playback.epoch)  # time stands, for all who come
                if self._stopping.wait(_POLL):
                    return
            self._play()
        except Exception as error:
            if not self._stopping.is_set():
                self.on_error(error)

    def _play(self) -> None:
        has_clock = self.playback.has_clock
        # What goes ahead of all time is given a while to arrive.
        begin = time.monotonic() + (SETTLING if self.playback.goes_ahead else 0.0)
        wall = time.time_ns()
        for event in self.playback.events():
            due = event.due / self.speed
            wait = begin + due - time.monotonic()
            if event.row >= 0 and due == 0.0:
                wait = 0.0
            if wait > 0.0 and self._stopping.wait(wait):
                return
            if wait < -_LATEST:
                begin -= wait
                wall -= round(wait * 1e9)
                self._stalls += 1
            if has_clock:
                stamp = self.playback.epoch + round(event.time * 1e9)
            else:
                stamp = wall + round(due * 1e9)
            self.publish(event.row, stamp)
            self._position = event.time
            self._samples += event.row >= 0
        self.on_end()
