# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Samples of a live motion sensor, with times of this machine, and news for the terminal.

The first address or topic that sends is the sensor; what others send is refused and counted, until
it has been silent for some seconds. Samples whose clock jumps are refused until the clock has been
compared again (`SenderClock`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
import math
import threading
import time
from typing import NamedTuple

from tree_sway.errors import shown
from tree_sway.sensors.motion.motion_reading import MotionReading, Numbers
from tree_sway.sensors.motion.motion_registry import OpenedMotion
from tree_sway.sensors.motion.sender_clock import SenderClock
from tree_sway.sensors.reading import Refusal
from tree_sway.sensors.transports.link import Link
from tree_sway.sensors.transports.transport import Message

SLOWEST = 5.0
"""Least number of samples per second [Hz] that follows a tree."""
_QUEUE = 8192
_SILENT = 5.0
"""Time [s] without a sample after which a sensor is stale, and another may take its place."""
_LOOK = 0.5
_PATIENCE = {'waiting': 4.0, 'unknown': 3.0, 'connecting': 4.0}
"""Time [s] after which silence, or messages that are not understood, are told."""
_MOST_CAUSES = 20
_COUNTED = 40
"""Samples over which the rate is counted."""
_LONGEST_PAUSE = 2.0


class MotionSample(NamedTuple):
    """A sample at a time of `time.monotonic` [s], with the quantities of `MotionReading`."""

    time: float
    acceleration: Numbers | None
    rate: Numbers | None
    orientation: Numbers | None


class LiveMotion:
    """
    Samples of a source, from `start` to `stop`.

    Parameters
    ----------
    opened
        The source.
    log
        Function called with a line of news, from the source's thread.
    heard
        Function called with each sample, from that thread.

    """

    def __init__(
        self,
        opened: OpenedMotion,
        log: Callable[[str], None],
        *,
        heard: Callable[[MotionSample], None] | None = None,
    ) -> None:
        self.name = opened.name
        """Name of the sensor for viewers."""
        self.accepted = self.other = 0
        """Numbers of samples, and of messages that are not about motion."""
        self.refused: dict[str, int] = {}
        """Numbers of samples that were refused, by cause."""
        self.quantities: tuple[str, ...] = ()
        """What its first sample has."""
        self._source, self._log, self._heard = opened.source, log, heard
        self._clock = SenderClock(opened.source.ticks)
        self._samples: deque[MotionSample] = deque(maxlen=_QUEUE)
        self._arrivals: deque[float] = deque(maxlen=_COUNTED)
        self._sender, self._sent = '', -math.inf
        self._last = ''
        self._ended = threading.Event()
        self._link = Link(opened.source.transport, self._take, log, longest_pause=_LONGEST_PAUSE)

    def start(self) -> None:
        """Start to listen."""
        self._ended.clear()
        self._link.start()
        threading.Thread(target=self._watch, name='motion', daemon=True).start()

    def stop(self) -> None:
        """Stop; the thread ends by itself if it is busy."""
        self._ended.set()
        self._link.stop()

    @property
    def link(self) -> Link:
        """The connection, with its state and counts."""
        return self._link

    @property
    def state(self) -> str:
        """State: ``connecting``, ``waiting``, ``unknown`` messages, ``live`` or ``stale``."""
        if self.accepted:
            return 'live' if time.monotonic() - self._sent < _SILENT else 'stale'
        if self._link.messages:
            return 'unknown'
        return 'waiting' if self._link.is_up else 'connecting'

    @property
    def rate(self) -> float:
        """Samples per second [Hz], of the newest ones; 0 before two of them."""
        arrivals = list(self._arrivals)
        passed = arrivals[-1] - arrivals[0] if arrivals else 0.0
        return (len(arrivals) - 1) / passed if passed > 0.0 else 0.0

    @property
    def problem(self) -> str:
        """Why it does not move the tree as far as its line is concerned; empty if it may."""
        link, source = self._link, self._source
        if self._clock.problem:
            return self._clock.problem
        if self.state == 'live':
            slow = 0.0 < self.rate < SLOWEST and len(self._arrivals) == _COUNTED
            return (
                f'{self.rate:.1f} samples per second are too few: set 20 or more' if slow else ''
            )
        if not link.is_up:
            return f'no connection: {link.failure or "not yet"}'
        if self.state == 'stale':
            return f'silent for {time.monotonic() - self._sent:.0f} s: check battery and network'
        if not link.messages:
            return f'listening to {source.transport}: nothing has come yet'
        if self.refused:
            causes = ', '.join(list(self.refused)[:3])
            return f'all of {link.messages} messages were refused: {causes}; last: {self._last}'
        if not self.other:
            return 'its clock is being compared'
        return (
            f'{link.messages} messages came, none was understood, the last: {self._last}; '
            f'expected {source.expects}'
        )

    def drain(self) -> list[MotionSample]:
        """Return the samples since the last call."""
        found = list[MotionSample]()
        while self._samples:
            found.append(self._samples.popleft())
        return found

    def _watch(self) -> None:
        """Tell once why nothing comes, as soon as it is known, until it does."""
        state, since, told = '', 0.0, ''
        while not self._ended.wait(_LOOK) and not self.accepted:
            if self.state != state:
                state, since = self.state, time.monotonic()
            if state != told and time.monotonic() - since >= _PATIENCE.get(state, math.inf):
                told = state
                self._log(f'{self.name}: {self.problem}')

    def _take(self, message: Message) -> None:
        """Read a message; called by the link's thread."""
        now = time.monotonic()
        self._last = shown(message.data[:300].decode('utf-8', 'replace'), 120)
        readings = self._source.read(message)
        self.other += not readings
        good = [each for each in readings if isinstance(each, MotionReading)]
        for each in readings:
            if isinstance(each, Refusal):
                self._refuse(each.reason)
        if not good:
            return
        if message.origin != self._sender:
            if now - self._sent < _SILENT:
                self._refuse('another sender', len(good))
                return
            self._sender = message.origin
            self._clock = SenderClock(self._source.ticks)
        self._use(good, now)

    def _use(self, readings: list[MotionReading], now: float) -> None:
        """Bring samples to the clock of this machine, and pass them on."""
        stamps = [each.time for each in readings if each.time is not None]
        self._sent = now
        if stamps and not self._clock.note(max(stamps), now):
            if self._clock.ticks is not None:
                self._refuse('its clock jumped', len(readings))
            elif self._clock.problem:
                self._refuse('its clock is of an unknown unit', len(readings))
            return
        for each in readings:
            at = now if each.time is None else self._clock.local(each.time)
            sample = MotionSample(at, each.acceleration, each.rate, each.orientation)
            self.accepted += 1
            self._arrivals.append(at)
            if not self.quantities:
                self.quantities = each.quantities
                measured = ' and '.join(_WORDS[name] for name in self.quantities)
                self._log(f'{self.name}: {measured} come')
            self._samples.append(sample)
            if self._heard is not None:
                self._heard(sample)

    def _refuse(self, cause: str, count: int = 1) -> None:
        if cause in self.refused or len(self.refused) < _MOST_CAUSES:
            self.refused[cause] = self.refused.get(cause, 0) + count


_WORDS = {
    'acceleration': 'acceleration', 'rate': 'angular rate', 'orientation': 'orientation',
}  # fmt: skip
