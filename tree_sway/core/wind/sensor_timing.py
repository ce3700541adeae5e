# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Period and lateness of a sensor, estimated from its samples."""

from __future__ import annotations

import math

_LIVE_PERIODS = 2.0  # age up to which a sensor counts as live
_DROPOUT_PERIODS = 3.0  # gap from which it is a dropout
_GAIN = 0.1  # weight of a new interval
_LONGEST_BELIEVED = 3.0  # interval over the period: a longer one may be a dropout
_SHORTEST_BELIEVED = 1 / 3  # a shorter one may be a burst of delayed samples
_LONGEST_FIRST = 600.0  # first interval [s]: a longer one is an outage
_SHRINK = 0.6  # factor of the period by such a short one, so that a wrong guess does not last
_LATENESS_GAIN = 0.02  # rate at which the allowance for late samples decreases
_CATCH_UP = 0.25  # at most this part of an interval


class SensorTiming:
    """Period and lateness of a sensor; samples last ``timeout`` [s], at least 3 periods."""

    def __init__(self, timeout: float) -> None:
        """Start without an interval."""
        self._timeout = timeout
        self.period: float | None = None
        self.lateness = 0.0

    @property
    def longest_hold(self) -> float:
        """Age in [s] up to which a sample is used."""
        return max(self._timeout, _DROPOUT_PERIODS * (self.period or 0.0))

    @property
    def longest_live(self) -> float:
        """Age in [s] up to which the sensor is live."""
        return self._timeout if self.period is None else _LIVE_PERIODS * self.period

    def is_dropout(self, gap: float) -> bool:
        """Return whether samples are missing in an interval between two in [s]."""
        return gap > (self._timeout if self.period is None else _DROPOUT_PERIODS * self.period)

    def note_interval(self, gap: float) -> None:
        """Update the period by the interval between two samples in [s]."""
        if math.isinf(gap):
            return
        if self.period is None:
            self.period = gap if gap <= _LONGEST_FIRST else None
        elif gap < _SHORTEST_BELIEVED * self.period:
            self.period *= _SHRINK
        else:
            self.period += _GAIN * (min(gap, _LONGEST_BELIEVED * self.period) - self.period)

    def note_lateness(self, late: float, gap: float) -> None:
        """Update the lateness by that of a sample, an interval after the one before, in [s]."""
        step_back = min(_LATENESS_GAIN * (self.lateness - late), _CATCH_UP * gap)
        self.lateness = max(late, self.lateness - step_back)
