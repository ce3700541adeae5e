# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
By how many steps sensors are read late, so that their samples are there.

A sensor over a network sends late, and several samples at once. When a sample comes, the step that
is just made tells how old the sensor's knowledge was at its worst. A stall now and then counts
little; a sensor that is silent does not count at all.
"""

from __future__ import annotations

import math

_UP, _DOWN = 0.2, 0.005
"""Share by which a lag above or below the known one is followed at each arrival."""

_SILENT = 1.0
"""Time [s] after which a sensor without a new sample does not count."""

_KEPT = 2
"""Steps by which the lateness may be more than needed before it is less."""


class Lateness:
    """
    Lags of sensors, and the steps that cover those of all.

    Parameters
    ----------
    count
        Number of sensors.
    dt
        Time step in [s].
    most
        Largest lateness in steps.

    """

    def __init__(self, count: int, dt: float, most: int) -> None:
        self._dt, self._most = dt, most
        self._lags = [0.0] * count
        self._newest = [-math.inf] * count
        self._came = [-math.inf] * count
        self._is_settled = True
        self.steps = 0
        """Steps by which sensors are read late."""

    def note(self, sensor: int, time: float, newest: float) -> None:
        """Note the newest sample of a sensor at the time of a step, both in [s]."""
        before = self._newest[sensor]
        if newest == before:
            return
        self._newest[sensor], self._came[sensor] = newest, time
        self._is_settled = False
        lag = time - self._dt - before  # at the last step without it
        if newest < before or lag > self._most * self._dt:
            return
        missing = max(lag, 0.0) - self._lags[sensor]
        self._lags[sensor] += (_UP if missing > 0.0 else _DOWN) * missing

    def settle(self, time: float) -> None:
        """Find the steps that cover the sensors that are heard, at the time of a step in [s]."""
        if self._is_settled:
            return
        self._is_settled = True
        longest, is_heard = 0.0, False
        for lag, came in zip(self._lags, self._came, strict=True):
            if time - came < _SILENT:
                longest, is_heard = max(longest, lag), True
        needed = min(math.ceil(longest / self._dt - 0.01), self._most)
        if needed > self.steps or (is_heard and needed < self.steps - _KEPT):
            self.steps = needed
