# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Report of the wind node: rate, age and state of the samples."""

from __future__ import annotations

from collections.abc import Sequence
import math
import time

from tree_sway.core.wind.gate import WindGate
from tree_sway.core.wind.sensor_timing import SensorTiming
from tree_sway_ros.reports.diagnostics import OK, STALE, Status, WARN

_PERIODS = 3.0
STALE_AFTER = 5.0
"""Number of time-outs after which a lost wind is stale, and the trees are at rest."""


class WindReport:
    """Good samples by arrival in wall time, which shows whether a sensor is live."""

    def __init__(self) -> None:
        self._timing, self._newest = SensorTiming(0.0), -math.inf

    def add(self) -> None:
        """Count a good sample."""
        now = time.monotonic()
        self._timing.note_interval(now - self._newest)
        self._newest = now

    @property
    def age(self) -> float:
        """Time since the last good sample in [s]; infinite if there was none."""
        return time.monotonic() - self._newest

    @property
    def rate(self) -> float:
        """Good samples per second [Hz], 0 without one for a second and two periods."""
        period = self._timing.period or math.inf
        return 0.0 if self.age > 1.0 + 2.0 * period else 1.0 / max(period, 1e-9)

    def status(self, timeout: float, gate: WindGate, types_not_read: Sequence[str] = ()) -> Status:
        """
        Report the counts of the gate, and types on the topic that are not read.

        The wind counts as lost when its last good sample is older than a timeout [s]; three
        periods of a sensor that is slower.
        """
        age, timeout = self.age, max(timeout, _PERIODS * (self._timing.period or 0.0))
        values: dict[str, object] = {
            'rate [Hz]': self.rate,
            'age [s]': 'never' if math.isinf(age) else age,
            'refused': gate.counts.refused,
            **vars(gate.counts),
        }
        level, text = OK, f'{self.rate:.1f} Hz'
        if math.isinf(age):
            level, text = WARN, 'no wind yet'
            if gate.counts.refused:
                text += f'; {gate.counts.refused} samples refused'
            if types_not_read:
                text += f'; set input_type to read {", ".join(types_not_read)}'
        elif age > STALE_AFTER * timeout:
            level, text = STALE, f'no wind for {age:.0f} s'
        elif age > timeout:
            level, text = WARN, f'no wind for {age:.1f} s, its force decays'
        elif gate.is_frozen:
            level, text = WARN, 'frozen: the sensor repeats the same sample'
        return Status('wind', level, text, values)
