# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Report of the wind node: rate, age and state of the samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
import time

from tree_sway.core.wind import SensorTiming, WindGate
from tree_sway_ros.reports.diagnostics import ERROR, OK, Status, WARN
from tree_sway_ros.reports.one_publisher import OnePublisher
from tree_sway_ros.reports.recent_counts import is_fault, listed, RecentCounts
from tree_sway_ros.reports.sequence_gaps import SequenceGaps

_PERIODS = 3.0
_REFUSALS = {
    'not_finite': 'not a number',
    'sentinel': "a sensor's code for no reading",
    'too_fast': 'faster than max_speed ({gate.max_speed:g} m/s)',
    'spike': 'too far from the last good one',
    'repeated': 'sent twice',
    'no_time': 'no later than the one before',
}
"""Counts of refused samples, and their reasons in words."""
_STAMPS = {
    'future_stamp': "ahead of this machine's clock",
    'old_stamp': "far behind this machine's clock",
    'out_of_order': 'out of order',
}
"""Counts of refused stamps; a driver that gives none at all is no fault."""
_NEWEST = 0.02
"""Weight of the newest sample in the mean square of what the projection leaves out."""
_LEAST_LEFT_OUT = 0.05
"""Component across the force plane that is worth a word [m/s]."""
LOST_AFTER = 5.0
"""Number of time-outs after which a lost wind is an error, and the trees are at rest."""


class WindReport:
    """Good samples by arrival in wall time, which shows whether a sensor is live."""

    def __init__(self) -> None:
        self._timing = SensorTiming(0.0)
        self._newest = -math.inf
        self._counts = RecentCounts()
        self._square_left_out = 0.0
        self.gaps = SequenceGaps()
        """Samples that were lost on their way to the node."""
        self.followed = OnePublisher()
        """The publisher whose samples are used."""

    def add(self, left_out: float = 0.0) -> None:
        """Count a good sample, of which a component in [m/s] across the plane was left out."""
        self._square_left_out += _NEWEST * (left_out**2 - self._square_left_out)
        now = time.monotonic()
        self._timing.note_interval(now - self._newest)
        self._newest = now

    @property
    def age(self) -> float:
        """Time since the last good sample in [s]; infinite if there was none."""
        return time.monotonic() - self._newest

    @property
    def left_out(self) -> float:
        """Component of late across the force plane, which the trees do not feel, rms [m/s]."""
        return math.sqrt(self._square_left_out)

    @property
    def rate(self) -> float:
        """Good samples per second [Hz], 0 without one for a second and two periods."""
        period = self._timing.period or math.inf
        return 0.0 if self.age > 1.0 + 2.0 * period else 1.0 / max(period, 1e-9)

    def status(
        self,
        timeout: float,
        gate: WindGate,
        types_not_read: Sequence[str] = (),
        publishers: Sequence[str] = ('',),
        replay: float | None = None,
    ) -> Status:
        """
        Report the samples, and why some of them are not used.

        The wind counts as lost when its last good sample is older than a timeout [s]; three
        periods of a sensor that is slower.

        Parameters
        ----------
        timeout
            Age of a lost wind in [s].
        gate
            Gate of the samples.
        types_not_read
            Types of messages on the topic that are not read.
        publishers
            Names of the nodes that publish the samples.
        replay
            Seconds of the record per second of the machine; None for a live wind.

        """
        age = self.age
        timeout = max(timeout, _PERIODS * (self._timing.period or 0.0))
        recent = self._counts.growth(vars(gate.counts))
        lost = self.gaps.report(len(publishers))
        refusals = _shares(recent, _REFUSALS, gate)
        values: dict[str, object] = {
            'rate [Hz]': self.rate,
            'age [s]': 'never' if math.isinf(age) else age,
            'publishers': len(publishers),
            'lost': self.gaps.lost,
            'of other publishers, refused': self.followed.refused,
            'across the force plane, left out [m/s]': round(self.left_out, 3),
            'refused': gate.counts.refused,
            **vars(gate.counts),
        }
        if replay is not None:
            values['replay rate'] = replay
        level = OK
        text = f'{self.rate:.1f} Hz'
        if self.left_out >= _LEAST_LEFT_OUT:
            text += f', {self.left_out:.2g} m/s across the force plane are left out'
        if replay is not None:
            text = f'replay at {replay:.2g}x, {text}'
        if math.isinf(age):
            level = WARN
            text = 'no wind yet'
            if types_not_read:
                text += f'; set input_type to read {", ".join(types_not_read)}'
        elif age > LOST_AFTER * timeout:
            level = ERROR
            text = f'no wind for {age:.0f} s'
        elif age > timeout:
            level = WARN
            text = f'no wind for {age:.1f} s, its force decays'
        elif gate.is_frozen:
            level = WARN
            text = f'frozen: the sensor repeats the same sample; {text}'
        elif gate.is_still:
            level = WARN
            text = f'exactly 0 m/s: calm air at a cup, or a stuck sensor; {text}'
        faults = []
        if refusals:
            faults.append(f'{sum(refusals.values())} of {_total(recent)} samples refused: ')
            faults[-1] += listed(refusals)
        elif math.isinf(age) and gate.counts.refused:
            faults.append(f'{gate.counts.refused} samples refused')
        if stamps := _shares(recent, _STAMPS, gate):
            faults.append(f'stamps replaced by the time of arrival: {listed(stamps)}')
        if lost:
            faults.append(f'{lost} samples lost on the way')
        faults += self.followed.faults(publishers)
        level = max(level, WARN) if faults else level
        return Status('wind', level, '; '.join([text, *faults]), values)


def _total(recent: Mapping[str, int]) -> int:
    return recent['accepted'] + sum(recent[name] for name in _REFUSALS)


def _shares(recent: Mapping[str, int], names: Mapping[str, str], gate: WindGate) -> dict[str, int]:
    """Return counts of samples by a reason in words; none if they are few."""
    counts = {names[name]: recent[name] for name in names if recent[name]}
    total = sum(counts.values())
    if not is_fault(total, _total(recent)):
        return {}
    return {name.format(gate=gate): count for name, count in counts.items()}
