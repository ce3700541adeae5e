# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Samples of a live motion sensor, with times of this machine, and news for the terminal.

What a second sender sends is refused, counted and named (`OneSender`). Samples whose clock jumps
are refused until the clock has been compared again (`SenderClock`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
import math
import time
from typing import ClassVar

from tree_sway.files.wind import Refusal
from tree_sway.live.live_source import LiveSource
from tree_sway.live.motion.motion_reading import MotionReading
from tree_sway.live.motion.sender_clock import SenderClock
from tree_sway.live.recent import RecentSamples
from tree_sway.live.source import Source
from tree_sway.live.transports.transport import ignore, Log, Message

SLOWEST = 5.0
"""Least number of samples per second [Hz] that follows a tree."""
_QUEUE = 8192
_SILENT = 5.0
"""Time [s] without a good sample after which a sensor is stale."""
_INCOMPLETE = 1.0
"""Time [s] without a sample of all quantities after which those that come are taken as all."""
_COUNTED = 40
"""Samples over which the rate is counted."""
_LEFT_OUT = 'the tree stood still then, paused or as this machine had too much to do'


class LiveMotion(LiveSource):
    """
    Samples of a source, from `start` to `stop`.

    Parameters
    ----------
    source
        Its transport, and the reader of its messages.
    log
        Function called with a line of news, from the source's thread.
    heard
        Function called with each sample, from that thread.

    """

    _patience: ClassVar = {'waiting': 4.0, 'unknown': 3.0, 'connecting': 4.0}
    _longest_pause = 2.0

    def __init__(
        self,
        source: Source,
        log: Log,
        *,
        heard: Callable[[MotionReading], None] = ignore,
    ) -> None:
        super().__init__(source, log)
        self.name = source.name
        """Name of the sensor for viewers."""
        self.quantities: tuple[str, ...] = ()
        """What its samples have."""
        self.left_out = 0
        """Number of samples of times that the steps of the tree left out, which were refused."""
        self._heard = heard
        self._clock = SenderClock(source.ticks)
        self._samples = RecentSamples[MotionReading](_QUEUE, _COUNTED)
        self.drain = self._samples.drain
        """Returns the samples since the last call, up to a time; all of `time.monotonic` [s]."""
        self._sent = self._refused_at = -math.inf
        self._cause = ''

    @property
    def rate(self) -> float:
        """Samples per second [Hz], of the newest ones; 0 before two of them."""
        return self._samples.rate

    @property
    def problem(self) -> str:
        """Why it does not move the tree as far as its line is concerned; empty if it may."""
        if self._clock.problem:
            return self._clock.problem
        state = self.state
        if state == 'live':
            is_slow = 0.0 < self.rate < SLOWEST and self.accepted >= _COUNTED
            slow = f'{self.rate:.1f} samples per second are too few: set 20 or more'
            return slow if is_slow else ''
        if self.link.is_up:
            if state == 'stale':
                now = time.monotonic()
                silence = f'{now - self._sent:.0f} s'
                if now - self._refused_at < _SILENT:
                    return f'all was refused for {silence}: {self._cause}'
                return f'silent for {silence}: check battery and network'
            if state == 'unknown' and not self.refused and not self.other:
                return 'its clock is being compared'
        return self._why_nothing()

    @property
    def note(self) -> str:
        """Who else sends, and what the steps left out; empty if nothing is odd."""
        told = [self._senders.problem or self._clock.mixture]
        if self.left_out:
            told.append(f'{self.left_out} samples were refused: {_LEFT_OUT}')
        return '; '.join(filter(None, told))

    def _news(self) -> str:
        return f'{self.name}: {self.problem}'

    def _take(self, message: Message) -> None:
        """Read a message; called by the link's thread."""
        now = time.monotonic()
        readings = self._source.read(message)
        self.other += not readings
        good = [each for each in readings if isinstance(each, MotionReading)]
        for each in readings:
            if isinstance(each, Refusal):
                self._refuse(each.reason)
        if not good:
            return
        before = self._senders.current
        if not self._follows(message.origin):
            return
        if message.origin != before:
            self._clock = SenderClock(self._source.ticks)
        self._use(good, now)

    def _use(self, readings: list[MotionReading], now: float) -> None:
        """Bring samples to the clock of this machine, and pass them on."""
        stamps = [each.time for each in readings if each.time is not None]
        if stamps and not self._clock.note(max(stamps), now, min(stamps)):
            if self._clock.ticks is not None:
                mixture = self._clock.mixture
                is_new = self._refuse(mixture or 'its clock jumped', len(readings))
                if mixture and is_new:
                    self._log(f'{self.name}: {mixture}')
            elif self._clock.problem:
                self._refuse('its clock is of an unknown unit', len(readings))
            return
        for each in readings:
            is_whole = set(self.quantities) <= set(each.quantities)
            if not is_whole and now - self._sent <= _INCOMPLETE:
                cause = f'{_words(each.quantities)} alone: send all of a sample in one message'
                if self._refuse(cause):
                    self._log(f'{self.name}: refused {cause}')
                continue
            self._sent = now
            self._expires = now + _SILENT
            at = now if each.time is None else self._clock.local(each.time)
            sample = replace(each, time=at)
            self.accepted += 1
            if not self.quantities or not is_whole:
                self.quantities = each.quantities
                self._log(f'{self.name}: samples of {_words(self.quantities)} come')
            self._samples.add(at, sample)
            self._heard(sample)

    def _refuse(self, cause: str, count: int = 1) -> bool:
        """Count what is refused; return whether its cause is new."""
        self._cause, self._refused_at = cause, time.monotonic()
        return self.link.refuse(cause, count)


def _words(quantities: Sequence[str]) -> str:
    return ' and '.join(quantities).replace('rate', 'angular rate')
