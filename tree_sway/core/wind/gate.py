# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The gate of wind samples: faults are refused and counted, true gusts and steps are accepted.

A sample is refused if it is not finite, faster than any wind of the model, or too far from the
last good one. The limit is a rate of change times the time between the two, plus the change by
small eddies between any two samples: in the inertial subrange increments grow as the cube root of
time, so that a rate without this refuses good samples of a fast sensor in a strong wind (20 m/s^2:
39 % at 20 Hz in 12 m/s). A change that lasts for `longest_refusal` may be a step and is accepted,
but no faster than `max_rate`: a longer spike moves the wind no further than a gust.

Samples are taken in their order of arrival. An impossible stamp (zero, ahead of its arrival, much
older, a duplicate, out of order) is counted by its cause and replaced by the time of arrival, less
the delay of the sample before, so that the times of a mixed stream stay regular. A stamp ahead is
accepted only if those before it were nearly as far ahead: else it would exclude the good samples
after it. All times are whole nanoseconds of one clock.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import NamedTuple

from numpy.typing import ArrayLike

from tree_sway.core.checks import three_numbers, within
from tree_sway.core.wind.limits import FASTEST_WIND, is_wind

# Codes that sensors send for no reading: Gill 999.99, NMEA and loggers 9999 and -9999, wet sonics
# 0x8000, which is 327.68 where the count is 0.01 m/s.
_INTEGER_CODES = 6999.0, 7999.0, 9999.0, 32767.0, 32768.0, 99999.0
_SENTINELS = (327.67, 327.68, 999.0, 999.9, 999.99, *_INTEGER_CODES)

SECOND = 1_000_000_000
"""One second in [ns]."""
LARGEST_LEAD = SECOND // 2
"""Largest lead of a stamp over its arrival in [ns], for a clock that is ahead."""
_LEAD_GROWTH = 60 * SECOND // 1000
"""Largest increase of the lead in [ns] from one sample to the next."""
LONGEST_TRANSPORT = 2 * SECOND
"""Age in [ns] from which a stamp is refused as that of a different clock, or of a recording."""
_NEVER = -(2**62)
_CLOCK_RESET = SECOND
"""Backward step in [ns] from which the clock was set back (a bag that loops)."""

JUMP_FLOOR = 1.0
"""Change between two samples in [m/s] that is always accepted: resolution and small eddies."""
JUMP_FRACTION = 0.25
"""Further accepted change as a fraction of the speed in [-]; eddies grow with the wind."""


class Verdict(NamedTuple):
    """
    Result for a sample: whether it is good, the reason, and the time [ns] and wind to use.

    The reason is ``accepted`` or the name of a count of refused samples in `GateCounts`. The wind
    [m/s] is the sample itself, except while a new level fades in after refusals.
    """

    accepted: bool
    reason: str
    time: int
    wind: tuple[float, float, float]


@dataclass
class GateCounts:
    """
    Counts of samples at the gate, by reason.

    Parameters
    ----------
    accepted
        Accepted samples.
    not_finite, sentinel, too_fast, spike, repeated, no_time
        Samples refused: not a number or infinite; a sensor's code for no reading; above the
        largest speed; too far from the last good one; a message sent twice; no time after the last
        one.
    forced
        Samples that were accepted as refusals had lasted long enough.
    zero_stamp, future_stamp, old_stamp, out_of_order
        Refused stamps of samples that may be good: zero; ahead of the arrival; older than
        `LONGEST_TRANSPORT`; not after the time given to the sample before.
    clock_back
        Number of times that the clock was set back.
    frozen
        Number of times that the sensor began to repeat one reading.

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
    Check wind samples one by one; a refused one is only counted.

    Parameters
    ----------
    max_speed
        Largest speed in [m/s].
    max_rate
        Largest rate of change of the vector in [m/s^2].
    longest_refusal
        Time in [s] after which any change is accepted.
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
        """Begin without samples."""
        self.max_speed = within('max_speed', max_speed, 0.0, FASTEST_WIND, 'm/s', above=True)
        """Largest speed of accepted samples [m/s]."""
        self._max_rate = within('max_rate', max_rate, 0.0, 1e4, 'm/s^2', above=True)
        refusal = within('longest_refusal', longest_refusal, 0.0, 60.0, 's')
        frozen = within('frozen_after', frozen_after, 0.0, 1e5, 's', above=True)
        self._longest_refusal = round(SECOND * refusal)
        self._frozen_after = round(SECOND * frozen)
        self.counts = GateCounts()
        self.reset()

    def reset(self) -> None:
        """Forget the samples, but not the counts."""
        self._time = self._arrival = _NEVER  # time used for the last sample, and its arrival
        self._stamp = _NEVER  # stamp of the last sample
        self._seen = (math.nan, math.nan, math.nan)  # last sample offered
        self._good = (0.0, 0.0, 0.0)  # last one accepted, at _good_time
        self._given = (0.0, 0.0, 0.0)  # wind that was returned for it
        self._before: tuple[float, float, float] | None = None  # wind before a new level
        self._good_time = self._refused_since = _NEVER
        self._equal_since = 0
        self.is_frozen = False
        """Whether the sensor repeats one reading for longer than a live sensor."""
        self.is_still = False
        """Whether the reading is exactly zero for that long: calm air, or a stuck sensor."""

    def offer(
        self,
        stamp: int,
        vector: ArrayLike,
        arrival: int | None = None,
        *,
        lead: int = 0,
        lag: int = 0,
    ) -> Verdict:
        """
        Check a sample.

        Parameters
        ----------
        stamp
            Time stamp of the sample in [ns].
        vector
            Wind in [m/s], (3,), before any projection; the axes do not matter.
        arrival
            Time of arrival in [ns], on the clock of the stamps; None if unknown.
        lead
            Further lead that stamps may have in [ns]: 0 for a running clock; in simulated time,
            which is constant between two ticks, the time that passes while a tick is on its way.
        lag
            Further age that stamps may have in [ns], where simulated time is faster than the
            transport: 0 for a running clock.

        Returns
        -------
        Verdict
            Result, with a time that is strictly after that of the last one.

        Raises
        ------
        ParameterError
            If the sample is not three numbers.

        """
        x, y, z = three_numbers('wind', vector)
        is_repeated = 0 < stamp == self._stamp and (x, y, z) == self._seen
        time = self._time_of(stamp, arrival, lead, lag)
        since = 1e-9 * (time - self._time)
        if is_repeated:
            reason = 'repeated'
        elif time <= self._time:
            reason = 'no_time'
        else:
            reason = self._judge(time, x, y, z)
            self._time = time
            self._stamp = stamp
            self._arrival = stamp if arrival is None else arrival
            self._note_reading(time, (x, y, z))
        self.counts.add(reason)
        is_good = reason == 'accepted'
        if is_good:
            self._good = (x, y, z)
            self._good_time = time
            self._refused_since = _NEVER
            self._fade_in(since)
        return Verdict(is_good, reason, time, self._given)

    def _note_reading(self, time: int, reading: tuple[float, float, float]) -> None:
        """Note for how long the sensor has repeated one reading."""
        if reading != self._seen:
            self._seen = reading
            self._equal_since = time
            self.is_frozen = self.is_still = False
        elif time - self._equal_since < self._frozen_after:
            return
        elif reading == (0.0, 0.0, 0.0):
            self.is_still = True
        elif not self.is_frozen:
            self.is_frozen = True
            self.counts.frozen += 1

    def _fade_in(self, since: float) -> None:
        """Return the last good sample; a new level fades in no faster than a gust."""
        left = math.dist(self._good, self._given)
        most = self._max_rate * since
        if self._before is None or left <= most:
            self._given = self._good
            self._before = None
            return
        x, y, z = (a + most / left * (b - a) for a, b in zip(self._given, self._good, strict=True))
        self._given = x, y, z

    def _time_of(self, stamp: int, given: int | None, lead: int, lag: int) -> int:
        """Return the stamp if it is plausible, or else the time to use instead."""
        arrival = stamp if given is None else given
        if arrival < self._arrival - _CLOCK_RESET:
            self.counts.clock_back += 1
            self.reset()
        fault = self._fault(stamp, arrival, lead, lag)
        if not fault:
            return stamp
        self.counts.add(fault)
        if given is None or self._time == _NEVER:
            return arrival
        usual = min(arrival, self._time + arrival - self._arrival)
        # An accepted stamp may have been ahead of the present arrival.
        latest = arrival + max(lead, LARGEST_LEAD)
        return max(usual, self._time + 1) if self._time < latest else usual

    def _fault(self, stamp: int, arrival: int, lead: int, lag: int) -> str:
        """Return why a stamp is refused, by the name of its count; empty if it is not."""
        if stamp <= 0 < arrival:
            return 'zero_stamp'
        ahead = min(max(self._time - self._arrival, 0) + _LEAD_GROWTH, LARGEST_LEAD)
        if stamp > arrival + max(lead, ahead):
            return 'future_stamp'
        if stamp < arrival - LONGEST_TRANSPORT - lag:
            return 'old_stamp'
        return 'out_of_order' if stamp <= self._time else ''

    def _judge(self, time: int, x: float, y: float, z: float) -> str:
        """Return why a sample is refused, by the name of its count, or ``accepted``."""
        if not is_wind(x, y, z, self.max_speed):
            if not all(map(math.isfinite, (x, y, z))):
                return 'not_finite'
            is_code = any(abs(abs(c) - code) < 0.006 for c in (x, y, z) for code in _SENTINELS)
            return 'sentinel' if is_code else 'too_fast'
        since = 1e-9 * (time - self._good_time)
        # While a new level fades in, its end is a return to the previous level.
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
