# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From samples of a sensor to the mean of the wind over each step of a solver.

The samples are interpolated linearly, which needs the next sample: the curve has a delay of one
sensor period, and more if samples arrive after the solver has passed their stamp. The solver uses
the exact mean of the curve over its step, which is of second order.

The curve is never changed before the end of the last step, so that the wind does not jump, whether
samples are late, early or missing: in a short dropout the last wind is used; in a long one it
decays to calm; after either, it fades into the new samples. Every mean is within the range of
samples and calm. Times are those of one clock, given by the caller; it may jump ahead, and
restarts with `WindAverage.reset` where it is set back.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import number_of, three_numbers, within
from tree_sway.core.wind.curve import WindCurve
from tree_sway.core.wind.sensor_timing import SensorTiming
from tree_sway.errors import ParameterError

_BLEND = 0.5
"""
Longest time in [s] over which the first sample after a dropout is faded in; after a shorter
dropout it is the length of that.

"""

LONGEST_HOLD = 2.0
"""Default of the time in [s] for which the last sample is used."""

CAPACITY = 512
"""Number of samples in memory. A step must not span more."""

_CALM = np.zeros(3)
_STALE_DECAYS = 5.0  # decay times after which the wind counts as stale


class WindAverage:
    """
    Samples in, means over steps out.

    Parameters
    ----------
    timeout
        Age of the newest sample in [s] up to which it is used; at least three sensor periods.
    decay
        Time constant in [s] with which the wind then decays.

    Raises
    ------
    ParameterError
        If a value is out of its range.

    """

    def __init__(self, timeout: float = LONGEST_HOLD, decay: float = 3.0) -> None:
        """Start without a sample."""
        self._timeout = within('timeout', timeout, 0.0, 3600.0, 's', above=True)
        self._decay = within('decay', decay, 0.0, 3600.0, 's', above=True)
        self.refused = 0
        self.reset()

    def reset(self) -> None:
        """Forget every sample and every step, but not the count of refused ones."""
        self._curve = WindCurve(CAPACITY)
        self._before = _CALM
        self._fade_start = -math.inf
        self._fade_end = -math.inf
        self._timing = SensorTiming(self._timeout)
        self._newest = -math.inf  # time of the newest sample
        self._passed = -math.inf  # end of the latest step: the curve before it does not change
        self._is_new_clock = False  # the clock has jumped since the newest sample

    @property
    def period(self) -> float | None:
        """Estimated period of the sensor in [s]; None before the second sample."""
        return self._timing.period

    @property
    def lateness(self) -> float:
        """Estimated time in [s] by which samples arrive after the step of their time."""
        return self._timing.lateness

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
            If the sample is not three numbers, or the time none.

        """
        value = np.array(three_numbers('wind', vector))
        time = number_of('time', time)
        if time <= self._newest or not (math.isfinite(time) and np.isfinite(value).all()):
            self.refused += 1
            return False
        self._clamp_clock(time)
        gap = silence = math.inf
        if self._newest > -math.inf and not self._is_new_clock:
            gap = time - self._newest
            silence = max(gap, self._passed - self._newest - self._timing.lateness)
        if self._timing.is_dropout(silence):
            self._begin_curve(time, value, silence)
        elif self._timing.period is None:
            # The first sample is used until the second.
            self._curve.append(max(time, self._passed), self._curve.last)
        self._timing.note_interval(gap)
        self._timing.note_lateness(max(0.0, self._passed - time), gap)
        self._draw_to(time, value)
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
        start = number_of('start', start)
        end = number_of('end', end)
        if not (math.isfinite(start) and start <= end < math.inf):
            raise ParameterError(f'no step from {start} to {end}', where='wind average')
        self._clamp_clock(start)
        mean = np.array(self._mean(start, end))
        self._passed = max(end, self._passed)
        return mean

    def state(self, time: float) -> str:
        """
        Return the state of the wind at a time in [s].

        Returns
        -------
        str
            ``none`` before the first sample; ``live``; ``holding`` the last one; ``decaying``;
            ``stale`` when it has decayed.

        """
        # A different thread may call this: changing values are read once.
        newest = self._newest
        timing = self._timing
        if newest == -math.inf:
            return 'none'
        if time - newest <= timing.longest_live + timing.lateness:
            return 'live'
        overdue = time - newest - timing.lateness - timing.longest_hold
        if overdue <= 0.0:
            return 'holding'
        return 'decaying' if overdue <= _STALE_DECAYS * self._decay else 'stale'

    def _draw_to(self, time: float, value: Floats) -> None:
        """Extend the curve to a new sample, not before the end of the last step."""
        knot = time + (self._timing.period or 0.0) + self._timing.lateness
        if self._curve.end < self._passed:
            self._curve.append(self._passed, self._curve.last)
        elif self._curve.end >= knot:
            self._curve.cut(max(self._passed, time))
        if knot < self._fade_end:
            share = (knot - self._fade_start) / (self._fade_end - self._fade_start)
            self._curve.append(knot, (1.0 - share) * self._before + share * value)
        self._curve.append(max(knot, self._fade_end), value)

    def _begin_curve(self, time: float, value: Floats, silence: float) -> None:
        """Start a new curve; the previous wind fades into the next samples."""
        since = self._passed
        before = self._mean(since, since)
        self._curve = WindCurve(CAPACITY)
        self._before = before
        self._fade_start = since
        self._fade_end = since + min(silence, _BLEND, self._timeout)
        if since > -math.inf:
            self._curve.append(since, before)
        self._curve.append(max(time, self._fade_end), value)

    def _mean(self, start: float, end: float) -> Floats:
        if self._newest == -math.inf:
            return _CALM
        calm = self._newest + self._timing.lateness + self._timing.longest_hold
        if end <= calm:
            return self._curve.mean(start, end)
        since = max(start, calm)
        level = self._curve.value(end)
        if since == end:
            return math.exp((calm - end) / self._decay) * level
        left = math.exp((calm - since) / self._decay) - math.exp((calm - end) / self._decay)
        total = self._decay * left * level
        if start < calm:
            total += (calm - start) * self._curve.mean(start, calm)
        return total / (end - start)

    def _clamp_clock(self, time: float) -> None:
        """Treat a clock that jumps forward like one that was paused."""
        jump = time - max(self._passed, self._newest)
        if self._passed > -math.inf and jump > self._timing.longest_hold:
            self._curve.shift(jump)
            self._fade_start += jump
            self._fade_end += jump
            self._passed += jump
            self._newest += jump
            self._is_new_clock = True
