# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a live source: its samples, its state for viewers, and news for the terminal.

The wind of an instant is passed on as it comes. Means of 20 s and more are blown as gusts about
them, until they are too old. Where messages do not say what they are, the time between them
decides; a first one counts as a mean until the second comes. That time is the lower median of the
last ones, as an outage is no period; a single one of more than ten minutes may be an outage.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
import math
from statistics import median_low
import threading
import time
from typing import ClassVar

import numpy as np

from tree_sway.core.wind import is_wind
from tree_sway.files.wind import Refusal, Velocity, WindReading
from tree_sway.live.every_other import EveryOther
from tree_sway.live.gusts_about_mean import GustsAboutMean, RATE
from tree_sway.live.live_source import LiveSource
from tree_sway.live.recent import RecentSamples
from tree_sway.live.source import Source
from tree_sway.live.transports.transport import ignore, Log, Message
from tree_sway.simulation.wind import LEAST_INTERVAL

Sample = tuple[float, Velocity]
"""Time [s] and wind east, north, up [m/s], the way the air goes."""

_USUAL_INTERVAL = 60.0
"""Length of a mean [s] until the second one tells it."""
_GAPS = 5
"""Number of times between messages that tell their period."""
_LONGEST_SINGLE = 600.0
"""Longest time between the first two messages that is taken for their period [s]."""
_LASTS = 3.0
"""Number of intervals for which a mean is used."""
_QUEUE = 4096
_OLDEST = 1.0
"""Age of the oldest sample that a run is given [s]."""
_BUNDLE = 0.02
"""Three times the time between samples [s] below which they may have come in a bundle."""
_LEAST, _LIVE_FOR = 2.0, 10.0
"""Least age [s] up to which the wind of an instant counts as live: of even samples, of others."""
_POINTS = 'N NE E SE S SW W NW'.split()


class LiveWind(LiveSource):
    """
    Samples of a source, from `start` to `stop`.

    Parameters
    ----------
    source
        Its transport, and the reader of its messages.
    log
        Function called with a line of news, from the source's thread.
    taken
        Function called with the wind of each instant as it comes, from that thread; such samples
        are then not in `drain`.
    heard
        Function called with each reading, from that thread.
    silence
        As in `Link`.

    """

    _patience: ClassVar = {'waiting': 4.0, 'unknown': 3.0}

    def __init__(
        self,
        source: Source,
        log: Log,
        *,
        taken: Callable[[Velocity], None] | None = None,
        heard: Callable[[WindReading], None] = ignore,
        silence: float | None = None,
    ) -> None:
        super().__init__(source, log, silence)
        self.bearing = source.bearing
        """Direction that a wind without one comes from, clockwise from north [rad]."""
        self.newest: WindReading | None = None
        """Newest reading."""
        self.interval = 0.0
        """Length of the mean that the newest reading is [s]; 0 for the wind of an instant."""
        self.lacks_direction = source.is_without_vane
        """Whether the newest reading has no direction of its own."""
        self.every_other = EveryOther()
        """Whether its speeds look like those of two senders, which nothing else tells apart."""
        self._taken = taken
        self._heard = heard
        self._lock = threading.Lock()
        self._gusts = GustsAboutMean()
        self._samples = RecentSamples[Sample](_QUEUE)
        self._arrival = -math.inf
        self._gaps = deque[float](maxlen=_GAPS)
        self._blown = -math.inf
        self._is_guess = False
        """Whether the next reading will tell if the newest is a mean."""

    @property
    def bearing_to(self) -> float:
        """Direction that such a wind blows to, from -pi to pi [rad]."""
        return math.remainder(self.bearing + math.pi, math.tau)

    @bearing_to.setter
    def bearing_to(self, value: float) -> None:
        self.bearing = (value + math.pi) % math.tau

    @property
    def is_mean(self) -> bool:
        """Whether gusts are blown about the newest reading."""
        return self.interval >= LEAST_INTERVAL

    @property
    def name(self) -> str:
        """Name of the source for viewers."""
        place = self.newest.place if self.newest is not None else ''
        return ', '.join(filter(None, (place, self._source.name)))

    @property
    def age(self) -> float:
        """Age of the newest reading [s], since its measurement if it has a time."""
        newest = self.newest
        if newest is not None and newest.time is not None:
            return max(time.time() - newest.time, 0.0)
        return time.monotonic() - self._arrival

    @property
    def source(self) -> Mapping[str, object]:
        """Description for viewers: name, newest wind, its age, and whether it is a mean."""
        newest = self.newest
        described: dict[str, object] = {
            'kind': 'live',
            'name': self.name,
            'state': self.state,
            'refused': dict(self.refused),
            'other': self.other,
        }
        if newest is not None:
            east, north, _ = newest.velocity(self.bearing)
            described |= {
                'speed': round(newest.speed, 2),
                'wind': [round(east, 3), round(north, 3)],
                'age': round(self.age, 1),
                'is_mean': self.is_mean,
                'lacks_direction': self.lacks_direction,
            }
        return described

    def drain(self) -> list[Sample]:
        """Return the samples since the last call, by the times of `time.monotonic`."""
        found = self._samples.drain()
        now = time.monotonic()
        with self._lock:
            until = min(now, self._expires)
            if self.is_mean and until > self._blown:
                first = math.floor(max(self._blown, until - 1.0) * RATE) + 1
                ticks = range(first, math.floor(until * RATE) + 1)
                found += [(tick / RATE, self._gusts.sample((tick + 0.5) / RATE)) for tick in ticks]
                self._blown = until
        return found

    def between(self, since: float, until: float) -> Iterator[Sample]:
        """
        Return the new samples on the clock of a run, whose present time is the later [s].

        Those that came while the run was busy get times after the earlier one; while it was
        paused, all but the last second are left out.
        """
        now = time.monotonic()
        samples = [each for each in self.drain() if now - each[0] <= _OLDEST]
        step = (until - since) / (len(samples) + 1)
        for number, (at, velocity) in enumerate(samples, start=1):
            yield max(until - max(now - at, 0.0), since + number * step), velocity

    @property
    def problem(self) -> str:
        """Why there is no wind, empty if there is one."""
        return '' if self.accepted else self._why_nothing()

    def _take(self, message: Message) -> None:
        """Read a message; called by the link's thread."""
        readings = self._source.read(message)
        self.other += not readings
        for reading in readings:
            if isinstance(reading, WindReading) and is_wind(reading.speed, reading.up, 0.0):
                if self._follows(' '.join(filter(None, (message.origin, reading.sender)))):
                    self.accepted += 1
                    self._use(reading)
                continue
            cause = 'speed is too fast or no number'
            if isinstance(reading, Refusal):
                cause = reading.reason
            if self.link.refuse(cause) and self.accepted:
                self._log(f'{self._source.name}: refused, and counted: {cause}')

    def _use(self, reading: WindReading) -> None:
        now = time.monotonic()
        is_first = self.newest is None
        was_guess = self._is_guess
        if not is_first:
            self._gaps.append(now - self._arrival)
        period = self._period
        interval = self._interval(reading, period)
        velocity = reading.velocity(self.bearing)
        with self._lock:
            self._arrival = now
            self.newest = reading
            self.lacks_direction = reading.bearing is None
            self.interval = interval
            if self.is_mean:
                has_gust = is_wind(reading.gust or 0.0, 0.0, 0.0)
                gust = reading.gust if has_gust else None
                self._gusts.set(now, np.array(velocity), interval, gust)
                self._blown = max(self._blown, now - 1.0 / RATE)
                self._expires = now - self.age + (self._source.lasts or _LASTS * interval)
            else:
                lasts = _LASTS * (period or 0.0)
                is_even = lasts > _BUNDLE and max(self._gaps, default=_LIVE_FOR) <= lasts
                self._expires = now + max(_LEAST if is_even else _LIVE_FOR, lasts)
        self._heard(reading)
        if is_first:
            text = described(reading, self.bearing)
            self._log(f'wind comes: {text}; {self._gusts_text(reading)}')
        elif was_guess:
            self._log(f'{self._source.name}: {self._gusts_text(reading)}')
        if self.every_other.note(reading.speed):
            self._log(f'{self._source.name}: {self.every_other.problem}')
        if self.is_mean:
            return
        if self._taken is not None:
            self._taken(velocity)
        else:
            self._samples.add(now, (now, velocity))

    @property
    def _period(self) -> float | None:
        """Usual time between two messages [s]; None while it is not known."""
        gaps = self._gaps
        if not gaps or (len(gaps) == 1 and gaps[0] > _LONGEST_SINGLE):
            return None
        return median_low(gaps)

    def _interval(self, reading: WindReading, period: float | None) -> float:
        """Length of the mean that a reading is [s]; 0 for the wind of an instant."""
        stated = (self._source.mean, reading.interval, self._source.interval)
        known = [each for each in stated if each is not None]
        self._is_guess = not known and period is None
        usual = _USUAL_INTERVAL if period is None else period
        return [*known, usual if usual >= LEAST_INTERVAL else 0.0][0]

    def _gusts_text(self, reading: WindReading) -> str:
        """Return what is known about the gusts of a reading, as words."""
        if not self.is_mean:
            return 'the wind of instants'
        law = 'IEC 61400-1' if reading.gust is None else 'its gust'
        gusts = f'gusts about it are simulated by {law}'
        if self._is_guess:
            return f'{gusts}, until the next one tells whether it is a mean'
        interval = self.interval
        length = f'{interval / 60.0:.3g} min' if interval >= 60.0 else f'{interval:.3g} s'
        return f'a mean over {length}: {gusts}'


def described(reading: WindReading, bearing: float) -> str:
    """Return a reading as words; the bearing is that of one without a direction [rad]."""
    used = bearing if reading.bearing is None else reading.bearing
    point = _POINTS[round(used / (math.pi / 4.0)) % 8]
    text = f'{reading.speed:.1f} m/s from {point} ({reading.kind})'
    if reading.bearing is None:
        text += ', its direction is assumed'
    return ', '.join(filter(None, (text, reading.assumed)))
