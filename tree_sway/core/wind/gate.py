# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The gate that a wind sample passes: faults are refused and counted, true gusts and steps get in.

A sample is refused if it is not finite, faster than any wind for which the model holds, or too far
from the last good one. Too far is a rate of change times the time between the two, plus what the
small eddies change between any two samples: in the inertial subrange increments grow as the cube
root of time, so that a rate alone refuses the good samples of a fast sensor in a strong wind (20
m/s^2: 39 % at 20 Hz in 12 m/s). What stays away for `longest_refusal` may be a step and is let in,
but no faster than `max_rate`: a spike that lasts longer moves the wind no further than a gust can.

Samples are taken in their order of arrival. A stamp that cannot be (zero, ahead of its arrival,
much older than it, a duplicate, out of order) is counted by its cause; in its place is the
time of arrival, less the delay of the sample before, so that the times of a mixed stream go on
evenly. A stamp ahead is believed only if those before it were nearly as far ahead: a single one
would shut out the good samples that follow it. All times are whole nanoseconds of one clock.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import NamedTuple

from numpy.typing import ArrayLike

from tree_sway.core.checks import three_numbers, within
from tree_sway.core.wind.limits import FASTEST_WIND, is_wind

# What sensors send instead of a reading: Gill 999.99, NMEA and loggers 9999 and -9999, wet sonics
# 0x8000, which is 327.68 where the count is 0.01 m/s.
_INTEGER_CODES = 6999.0, 7999.0, 9999.0, 32767.0, 32768.0, 99999.0
SENTINELS = (327.67, 327.68, 999.0, 999.9, 999.99, *_INTEGER_CODES)

SECOND = 1_000_000_000
"""One second in [ns]."""
LARGEST_LEAD = SECOND // 2
"""Lead of a stamp over its arrival in [ns] up to which it is of a clock that runs ahead."""
LEAD_GROWTH = 60 * SECOND // 1000
"""How much more a stamp may be ahead of its arrival in [ns] than the sample before."""
LONGEST_TRANSPORT = 2 * SECOND
"""Age in [ns] at which a stamp is of another clock, or of a recording, and no longer believed."""
_NEVER = -(2**62)
CLOCK_RESET = SECOND
"""Backward step in [ns] that is a clock set back (a bag that loops), not samples out of order."""

JUMP_FLOOR = 1.0
"""Change between two samples that is always believed in [m/s]: resolution and small eddies."""
JUMP_FRACTION = 0.25
"""Such a change, in addition, as a fraction of the speed in [-]; eddies grow with the wind."""


class Verdict(NamedTuple):
    """
    What became of a sample: whether it is good, why, and the time [ns] and wind to use for it.

    The reason is ``accepted`` or the name of a count of refused samples in `GateCounts`. The wind
    [m/s] is the sample itself but while a new level fades in after a refused run.
    """

    accepted: bool
    reason: str
    time: int
    wind: tuple[float, float, float]


@dataclass
class GateCounts:
    """
    What went through the gate, by reason.

    Parameters
    ----------
    accepted
        Samples that got in.
    not_finite, sentinel, too_fast, spike, repeated, no_time
        Samples refused: not a number or infinite; a sensor's code for no reading; above the
        largest speed; too far from the last good one; a message sent twice; no time after the last
        one.
    forced
        Accepted ones that were let in because refusing had lasted long enough.
    zero_stamp, future_stamp, old_stamp, out_of_order
        Stamps not believed, though the sample itself may be good: none at all; ahead of the
        arrival; older than `LONGEST_TRANSPORT`; not after the time given to the sample before.
    clock_back
        Times the clock was set back.
    frozen
        Times the sensor began to repeat one reading.

    """

    accepted: int = 0
    not_finite: int = 0
    sentinel: int = 0
    too_fast: int = 0
    spike: int = 0
    repeated: int = 0
    no_time: int = 0
    forced: int = 0
    zero_stamp: int = 0
    future_stamp: int = 0
    old_stamp: int = 0
    out_of_order: int = 0
    clock_back: int = 0
    frozen: int = 0

    @property
    def refused(self) -> int:
        """Return the number of samples refused, for any reason."""
        faults = self.not_finite + self.sentinel + self.too_fast + self.spike
        return faults + self.repeated + self.no_time

    def add(self, name: str) -> None:
        """Count one more of a name."""
        setattr(self, name, getattr(self, name) + 1)


class WindGate:
    """
    Judge wind samples one by one; a refused one leaves no trace but its count.

    Parameters
    ----------
    max_speed
        Largest speed in [m/s].
    max_rate
        Largest rate of change of the vector in [m/s^2].
    longest_refusal
        Time in [s] after which a change is believed, however sudden.
    frozen_after
        Time in [s] of equal samples, other than zero, after which the sensor counts as frozen.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """

    def __init__(
        self,
        max_speed: float = 40.0,
        max_rate: float = 20.0,
        longest_refusal: float = 0.5,
        frozen_after: float = 10.0,
    ) -> None:
        """Open the gate with no sample seen."""
        self._max_speed = within('max_speed', max_speed, 0.0, FASTEST_WIND, 'm/s', above=True)
        self._max_rate = within('max_rate', max_rate, 0.0, 1e4, 'm/s^2', above=True)
        refusal = within('longest_refusal', longest_refusal, 0.0, 60.0, 's')
        frozen = within('frozen_after', frozen_after, 0.0, 1e5, 's', above=True)
        self._longest_refusal, self._frozen_after = round(SECOND * refusal), round(SECOND * frozen)
        self.counts = GateCounts()
        self.reset()

    def reset(self) -> None:
        """Forget the samples seen; keep the counts."""
        self._time = self._arrival = _NEVER  # given to the last sample, and when it arrived
        self._stamp = _NEVER  # of the last sample, believed or not
        self._seen = (math.nan, math.nan, math.nan)  # last sample offered
        self._good = (0.0, 0.0, 0.0)  # last one accepted, at _good_time
        self._given = (0.0, 0.0, 0.0)  # what was given out for it
        self._before: tuple[float, float, float] | None = None  # left while a level fades in
        self._good_time = self._refused_since = _NEVER
        self._equal_since = 0
        self.is_frozen = False
        """Whether the sensor has repeated one reading for longer than a live one does."""

    def offer(
        self, stamp: int, vector: ArrayLike, arrival: int | None = None, *, lead: int = 0
    ) -> Verdict:
        """
        Judge a sample.

        Parameters
        ----------
        stamp
            Time that the sample carries in [ns].
        vector
            Wind in [m/s], (3,), before any projection; the axes do not matter.
        arrival
            Time that it arrived in [ns], on the clock of the stamps; None if the stamp is all
            there is.
        lead
            How far stamps may be ahead of the arrival in [ns]: 0 on a clock that runs, up to a
            tick of simulated time, which does not move in between.

        Returns
        -------
        Verdict
            Whether it is good, why, and the time to use for it: strictly after that of the last
            one.

        Raises
        ------
        ParameterError
            If the sample is not three numbers.

        """
        x, y, z = three_numbers('wind', vector)
        is_repeated = 0 < stamp == self._stamp and (x, y, z) == self._seen
        time = self._time_of(stamp, arrival, lead)
        since = 1e-9 * (time - self._time)
        if is_repeated:
            reason = 'repeated'
        elif time <= self._time:
            reason = 'no_time'
        else:
            reason = self._judge(time, x, y, z)
            self._time, self._stamp = time, stamp
            self._arrival = stamp if arrival is None else arrival
            self._watch_for_frozen(time, (x, y, z))
        self.counts.add(reason)
        is_good = reason == 'accepted'
        if is_good:
            self._good, self._good_time = (x, y, z), time
            self._refused_since = _NEVER
            self._fade_in(since)
        return Verdict(is_good, reason, time, self._given)

    def _fade_in(self, since: float) -> None:
        """Give out the last good sample, no faster than a gust where it is of a new level."""
        left, most = math.dist(self._good, self._given), self._max_rate * since
        if self._before is None or left <= most:
            self._given, self._before = self._good, None
            return
        x, y, z = (a + most / left * (b - a) for a, b in zip(self._given, self._good, strict=True))
        self._given = x, y, z

    def _time_of(self, stamp: int, given: int | None, lead: int) -> int:
        """Return the stamp if it can be believed, or else the time to use in its place."""
        arrival = stamp if given is None else given
        if arrival < self._arrival - CLOCK_RESET:
            self.counts.clock_back += 1
            self.reset()
        fault = self._fault(stamp, arrival, lead)
        if not fault:
            return stamp
        self.counts.add(fault)
        if given is None or self._time == _NEVER:
            return arrival
        usual = min(arrival, self._time + arrival - self._arrival)
        # A stamp that was believed may have been ahead of what arrives now.
        return max(usual, self._time + 1) if self._time < arrival + LARGEST_LEAD else usual

    def _fault(self, stamp: int, arrival: int, lead: int) -> str:
        """Say why a stamp is not believed, by the name of its count; empty if it is."""
        if stamp <= 0 < arrival:
            return 'zero_stamp'
        ahead = max(lead, max(self._time - self._arrival, 0) + LEAD_GROWTH)
        if stamp > arrival + min(ahead, LARGEST_LEAD):
            return 'future_stamp'
        if stamp < arrival - LONGEST_TRANSPORT:
            return 'old_stamp'
        return 'out_of_order' if stamp <= self._time else ''

    def _judge(self, time: int, x: float, y: float, z: float) -> str:
        """Say why a sample is refused, by the name of its count, or ``accepted``."""
        if not is_wind(x, y, z, self._max_speed):
            if not all(map(math.isfinite, (x, y, z))):
                return 'not_finite'
            is_code = any(abs(abs(c) - code) < 0.006 for c in (x, y, z) for code in SENTINELS)
            return 'sentinel' if is_code else 'too_fast'
        since = 1e-9 * (time - self._good_time)
        # While a new level fades in, its end is a return to the level before.
        for level in (self._good, self._before or self._good):
            allowed = self._max_rate * since + JUMP_FLOOR
            if math.dist((x, y, z), level) <= allowed + JUMP_FRACTION * math.hypot(*level):
                return 'accepted'
        if self._refused_since == _NEVER:
            self._refused_since = time
        if time - self._refused_since < self._longest_refusal:
            return 'spike'
        self.counts.forced += 1
        self._before = self._before or self._good
        return 'accepted'

    def _watch_for_frozen(self, time: int, sample: tuple[float, float, float]) -> None:
        if sample != self._seen or sample == (0.0, 0.0, 0.0):
            self._seen, self._equal_since, self.is_frozen = sample, time, False
        elif not self.is_frozen and time - self._equal_since >= self._frozen_after:
            self.is_frozen = True
            self.counts.frozen += 1
