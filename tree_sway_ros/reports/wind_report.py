# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Is the wind there? Rate and age of the samples, and what to call their state."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
import time

from tree_sway.core.wind.gate import WindGate
from tree_sway_ros.reports.diagnostics import OK, STALE, Status, WARN

_WINDOW = 5.0
_PERIODS = 3.0
_SHORTER = 0.8
"""Share of the gaps between samples that are shorter than the period: some come in bursts."""
STALE_AFTER = 5.0
"""In time-outs: a wind that was lost for this time is stale, the trees are at rest again."""


class WindReport:
    """Counts samples by arrival, in wall time: stamps do not show whether a sensor is alive."""

    def __init__(self) -> None:
        self._arrivals: deque[float] = deque(maxlen=1000)
        self._latest: float | None = None
        self._gaps: deque[float] = deque(maxlen=20)

    def add(self, is_accepted: bool) -> None:
        """Count a sample."""
        now = time.monotonic()
        self._arrivals.append(now)
        if is_accepted:
            if self._latest is not None:
                self._gaps.append(now - self._latest)
            self._latest = now

    @property
    def age(self) -> float | None:
        """Time since the last good sample in [s]; None if there was none."""
        return None if self._latest is None else time.monotonic() - self._latest

    @property
    def rate(self) -> float:
        """Return the samples per second over the last five seconds in [Hz]."""
        now = time.monotonic()
        recent = [arrival for arrival in list(self._arrivals) if now - arrival <= _WINDOW]
        if len(recent) < 2 or now - recent[-1] > 1.0 + 2.0 * (recent[-1] - recent[-2]):
            return 0.0
        return (len(recent) - 1) / max(1e-9, recent[-1] - recent[0])

    @property
    def _period(self) -> float:
        """Of the sensor in [s]; 0 before the second sample. A few dropouts do not change it."""
        gaps = sorted(self._gaps)
        return gaps[int(_SHORTER * len(gaps))] if gaps else 0.0

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
        if age is None:
            refused = f'; {gate.counts.refused} samples refused' if gate.counts.refused else ''
            others = (
                f'; set input_type to read {", ".join(types_not_read)}' if types_not_read else ''
            )
            return Status('wind', WARN, f'no wind yet{refused}{others}', values)
        if age > STALE_AFTER * timeout:
            return Status('wind', STALE, f'no wind for {age:.0f} s', values)
        if age > timeout:
            return Status('wind', WARN, f'no wind for {age:.1f} s, its force decays', values)
        if gate.is_frozen:
            return Status('wind', WARN, 'frozen: the sensor repeats the same sample', values)
        return Status('wind', OK, f'{self.rate:.1f} Hz', values)
