# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Is the wind there? Rate and age of the samples, and what to call their state."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
import time

import numpy as np

from tree_sway.core.wind.gate import WindGate
from tree_sway_ros.reports.diagnostics import OK, STALE, Status, WARN

_WINDOW = 5.0
_PERIODS = 3.0
_LATEST = 21
_SHORTER = 0.8
"""Share of the gaps between samples that are shorter than the period: some come in bursts."""
STALE_AFTER = 5.0
"""Number of time-outs after which a lost wind is stale, the trees are at rest again."""


class WindReport:
    """Good samples by arrival, in wall time: stamps do not show whether a sensor is alive."""

    def __init__(self) -> None:
        self._arrivals: deque[float] = deque(maxlen=1000)

    def add(self) -> None:
        """Count a good sample."""
        self._arrivals.append(time.monotonic())

    @property
    def age(self) -> float | None:
        """Time since the last good sample in [s]; None if there was none."""
        return time.monotonic() - self._arrivals[-1] if self._arrivals else None

    @property
    def rate(self) -> float:
        """Good samples per second over the last five seconds [Hz]."""
        now = time.monotonic()
        recent = [arrival for arrival in list(self._arrivals) if now - arrival <= _WINDOW]
        if len(recent) < 2 or now - recent[-1] > 1.0 + 2.0 * (recent[-1] - recent[-2]):
            return 0.0
        return (len(recent) - 1) / max(1e-9, recent[-1] - recent[0])

    @property
    def _period(self) -> float:
        """Period of the sensor [s]; 0 before the second sample. Few dropouts do not change it."""
        gaps = sorted(np.diff(list(self._arrivals)[-_LATEST:]).tolist())
        return float(gaps[int(_SHORTER * len(gaps))]) if gaps else 0.0

    def status(self, timeout: float, gate: WindGate, types_not_read: Sequence[str] = ()) -> Status:
        """
        Report by what the gate refused or found odd, and types on the topic that are not read.

        The wind counts as lost when its last good sample is older than a timeout [s]; three
        periods of a sensor that is slower.
        """
        age, timeout = self.age, max(timeout, _PERIODS * self._period)
        values: dict[str, object] = {
            'rate [Hz]': self.rate,
            'age [s]': 'never' if age is None else age,
            'refused': gate.counts.refused,
            **vars(gate.counts),
        }
        level, text = OK, f'{self.rate:.1f} Hz'
        if age is None:
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
