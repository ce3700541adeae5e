# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From samples of a sensor to what a solver needs: the mean of the wind over each of its steps.

The samples become a curve of straight lines, which can be drawn only once the next sample is
there: the curve runs one sensor period late, and later still by as much as samples are seen to
arrive after the solver has passed their stamp. The solver gets the exact mean of the curve over
its step, which keeps second order where a sample of it would not.

What the solver has been given is never redrawn, so that nothing jumps, whatever comes late, early
or not at all: a short dropout is held; a long one decays to calm; after either, what was given
fades over into the new samples. Every mean is one of samples and of calm, and never beyond them.
Times are those of one clock, handed in by the caller; it may jump.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.checks import three_numbers, within
from tree_sway.core.wind.curve import Vector, WindCurve
from tree_sway.core.wind.fade import Fade
from tree_sway.core.wind.limits import is_wind
from tree_sway.core.wind.sensor_timing import SensorTiming
from tree_sway.errors import ParameterError

Floats = NDArray[np.float64]

CLOCK_RESET = 1.0
"""
Backward step in [s] that is a clock set back, not a sample out of order or a look at the past.

"""

_CALM: Vector = (0.0, 0.0, 0.0)
_NO_FADE = Fade(_CALM, -math.inf, -math.inf)
_STALE_DECAYS = 5.0  # decay times after which the wind counts as gone


class WindAverage:
    """
    Samples in, means over steps out.

    Parameters
    ----------
    timeout
        Age of the newest sample in [s] up to which it is held; at least three sensor periods.
    decay
        Time constant in [s] with which the wind then dies down.
    blend
        Longest time in [s] over which the first sample after a dropout is faded in; a dropout
        shorter than that fades in over its own length.
    capacity
        Number of samples kept. A step must not span more.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """

    def __init__(
        self,
        timeout: float = 2.0,
        decay: float = 3.0,
        *,
        blend: float = 0.5,
        capacity: int = 512,
    ) -> None:
        """Start without a sample."""
        self._timeout = within('timeout', timeout, 0.0, 3600.0, 's', above=True)
        self._decay = within('decay', decay, 0.0, 3600.0, 's', above=True)
        self._blend = min(within('blend', blend, 0.0, 60.0, 's', above=True), self._timeout)
        self._curve = WindCurve(int(within('capacity', capacity, 8, 1e6)))
        self.refused = 0
        self.reset()

    def reset(self) -> None:
        """Forget every sample and every step; keep the count of the refused ones."""
        self._curve.clear()
        self._fade = _NO_FADE
        self._timing = SensorTiming(self._timeout)
        self._newest: float | None = None  # time of the newest sample
        self._passed: float | None = None  # end of the latest step: before it nothing may change
        self._is_new_clock = False  # the clock has jumped since the newest sample

    @property
    def period(self) -> float | None:
        """Estimated period of the sensor in [s]; None before the second sample."""
        return self._timing.period

    def add(self, time: float, vector: ArrayLike) -> bool:
        """
        Add a sample.

        Parameters
        ----------
        time
            Time of the sample in [s].
        vector
            Wind in [m/s], (3,).

        Returns
        -------
        bool
            False if it was refused, and counted: not finite, or not after the one before.

        Raises
        ------
        ParameterError
            If the sample is not three numbers.

        """
        x, y, z = three_numbers('wind', vector)
        if not all(map(math.isfinite, (time, x, y, z))):
            self.refused += 1
            return False
        if self._newest is not None and time <= self._newest:
            if time > self._newest - CLOCK_RESET:
                self.refused += 1
                return False
            self._set_clock_back(time)
        self._clamp_clock(time)
        passed = -math.inf if self._passed is None else self._passed
        if self._newest is None or self._is_new_clock:
            gap = silence = math.inf
        else:
            gap = time - self._newest
            silence = max(gap, passed - self._newest - self._timing.lateness)
        if self._timing.is_dropout(silence):
            self._start_anew(time, (x, y, z), silence)
        elif self._timing.period is None:
            self._curve.append(
                max(time, passed), self._curve.last
            )  # the first holds to the second
        self._timing.note_interval(gap)
        self._timing.note_lateness(max(0.0, passed - time), gap)
        self._draw_to(time, passed, (x, y, z))
        self._newest = time
        self._is_new_clock = False
        return True

    def mean(self, start: float, end: float) -> Floats:
        """
        Return the mean of the wind over a step.

        Parameters
        ----------
        start, end
            The step in [s]; a step of no length gives the value there.

        Returns
        -------
        Floats
            Mean wind in [m/s], (3,); zero before the first sample.

        Raises
        ------
        ParameterError
            If the step is not finite or ends before it starts.

        """
        if not (math.isfinite(start) and start <= end < math.inf):
            raise ParameterError(f'no step from {start} to {end}', where='wind average')
        if self._passed is not None and end < self._passed - CLOCK_RESET:
            self._set_clock_back(start)
        self._clamp_clock(start)
        mean = self._mean(start, end)
        self._passed = end if self._passed is None else max(end, self._passed)
        return np.array(mean)

    def state(self, time: float) -> str:
        """
        Return what the wind is at a time in [s].

        Returns
        -------
        str
            ``none`` before the first sample; ``live``; ``holding`` the last one; ``decaying``;
            ``stale`` when nothing is left of it.

        """
        # Another thread may ask: what changes under it is read once.
        newest, timing = self._newest, self._timing
        if newest is None:
            return 'none'
        if time - newest <= timing.longest_live + timing.lateness:
            return 'live'
        overdue = time - newest - timing.lateness - timing.longest_hold
        if overdue <= 0.0:
            return 'holding'
        return 'decaying' if overdue <= _STALE_DECAYS * self._decay else 'stale'

    def memory(self) -> list[float]:
        """Return all that is carried from step to step as numbers, NaN for what is not yet."""
        times = (self._newest, self._passed, self._timing.period)
        fade, timing = self._fade, self._timing
        return [
            *(math.nan if time is None else time for time in times),
            *(float(self._is_new_clock), timing.lateness, fade.start, fade.end, *fade.before),
            *(number for time, value in self._curve.knots for number in (time, *value)),
        ]

    def recall(self, memory: Sequence[float]) -> None:
        """Go on from the memory of another; a `ParameterError` for numbers that are none."""
        try:
            numbers = np.array(memory, dtype=np.float64).reshape(-1)
            head, knots = numbers[:10].tolist(), numbers[10:].reshape(-1, 4)
            newest, passed, period, is_new, lateness, start, end, *before = head
            is_sound = all(is_wind(*value) for value in (before, *knots[:, 1:].tolist()))
            is_sound &= bool(np.isfinite(knots[:, 0]).all() and (np.diff(knots[:, 0]) > 0.0).all())
            is_sound &= len(before) == 3 and 0.0 <= lateness < math.inf and not period <= 0.0
            is_sound &= start <= end < math.inf and len(knots) > 0 and math.isfinite(newest)
        except (ValueError, TypeError, OverflowError) as error:
            raise ParameterError('numbers that are no wind', where='wind average') from error
        if not is_sound:
            raise ParameterError('a wind that cannot be', where='wind average')
        self.reset()
        for time, *value in knots.tolist():
            self._curve.append(time, (value[0], value[1], value[2]))
        self._fade = Fade((before[0], before[1], before[2]), start, end)
        self._timing.period = None if math.isnan(period) else period
        self._timing.lateness, self._is_new_clock = lateness, bool(is_new)
        self._newest, self._passed = newest, None if math.isnan(passed) else passed

    @property
    def _decay_start(self) -> float:
        return (self._newest or 0.0) + self._timing.lateness + self._timing.longest_hold

    def _draw_to(self, time: float, passed: float, value: Vector) -> None:
        """Draw the curve on to a new sample, from where the solver has passed at the earliest."""
        knot = time + (self._timing.period or 0.0) + self._timing.lateness
        if self._curve.end < passed:
            self._curve.append(passed, self._curve.last)
        elif self._curve.end >= knot:
            self._curve.cut(max(passed, time))
        self._curve.append(knot, value)

    def _start_anew(self, time: float, value: Vector, silence: float) -> None:
        """Start a new curve at a value; what there was until now fades over into it."""
        since = self._passed
        before = _CALM if since is None else self._mean(since, since)
        self._curve.clear()
        self._fade = _NO_FADE
        self._curve.append(time if since is None else since, value)
        if since is not None:
            self._fade = Fade(before, since, since + min(silence, self._blend))

    def _mean(self, start: float, end: float) -> Vector:
        if self._newest is None:
            return _CALM
        calm = self._decay_start
        if start == end:
            left = math.exp(min(0.0, (calm - start) / self._decay))
            x, y, z = self._fade.value(self._curve, start)
            return left * x, left * y, left * z
        if end <= calm:
            return self._fade.mean(self._curve, start, end)
        level = self._fade.value(self._curve, end)
        since = max(start, calm)
        decayed = self._decay * (
            math.exp((calm - since) / self._decay) - math.exp((calm - end) / self._decay)
        )
        x, y, z = (v * decayed / (end - start) for v in level)
        if start >= calm:
            return x, y, z
        held = self._mean(start, calm)
        part = (calm - start) / (end - start)
        return x + part * held[0], y + part * held[1], z + part * held[2]

    def _set_clock_back(self, time: float) -> None:
        """Begin again at a time, from the wind there is."""
        held = _CALM if self._passed is None else self._mean(self._passed, self._passed)
        had_wind, period = self._newest is not None, self._timing.period
        self.reset()
        if had_wind:
            self._timing.period = period
            self._newest = time
            self._curve.append(time, held)
        self._passed = time
        self._is_new_clock = True

    def _clamp_clock(self, time: float) -> None:
        """Take a clock that jumps forward for one that was paused."""
        if self._passed is None:
            return
        now = self._passed if self._newest is None else max(self._passed, self._newest)
        jump = time - now
        if jump > self._timing.longest_hold:
            self._curve.shift(jump)
            self._fade = self._fade.later(jump)
            self._passed += jump
            if self._newest is not None:
                self._newest += jump
            self._is_new_clock = True
