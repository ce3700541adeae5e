# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Samples of a motion sensor: checked as they come, and read at any time.

A sample has an acceleration, an angular rate, an orientation, or several of them, in the sensor's
own frame. A sample that is not finite, beyond any sensor, stuck at the limit of the sensor, out of
order, or far from those about it is refused and counted, and so are those of a sensor that repeats
its numbers.

What a sensor measures is decided by a majority vote (Boyer and Moore 1991, Automated Reasoning,
105-117), so that neither a bad first sample nor a part that stops makes the others useless.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import dist, inf, isfinite, nan

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.twin.alignment import LEAST_NOISE, matrix_of
from tree_sway.twin.sample_ring import (
    KEPT,
    NOT_FINITE,
    OUT_OF_ORDER,
    RESTARTED,
    SampleRing,
    SATURATED,
    TOO_LARGE,
)
from tree_sway.twin.sensor_place import SensorPlace, turn_between

QUANTITIES = ('acceleration', 'rate', 'orientation')
"""Quantities of a sample: [m/s^2], [rad/s], and a quaternion x y z w."""

_ROWS = slice(0, 3), slice(3, 6), slice(6, 9)
"""Numbers of each quantity."""

_MOST_LEAD = 100
"""Most votes by which the quantities of a sensor lead."""

_STILL = 0.15
_LEAST_STILL = 5
"""
Time [s] and number of equal samples after which they are left out: a second of a dead sensor would
throw the tree about.
"""

_APART = 20.0
_LEAST_CHANGE = LEAST_NOISE.tolist()
"""Change of a quantity that is a spike, over a running median of its changes, or over noise."""
_SPIKES, _USUAL = 3, 20
"""Spikes in a row that may be, and samples before the first."""

_WINDOW, _AHEAD, _BEHIND = 2.0, 0.1, 0.3
"""
Time [s] over which stamps are compared with arrivals; by how much all of them are after these if
the clock of the sensor is ahead, and by how much all are before if it may be behind [s].
"""

STUCK, SPIKE, AHEAD = 6, 7, 8
"""Results of `MotionSensor.offer` beside those of `SampleRing.keep`."""

_COUNTED = {
    NOT_FINITE: 'not_finite',
    TOO_LARGE: 'too_large',
    SATURATED: 'saturated',
    OUT_OF_ORDER: 'out_of_order',
    RESTARTED: 'restarted',
    STUCK: 'stuck',
    SPIKE: 'spikes',
    AHEAD: 'ahead',
}

_REASONS = {
    'not_finite': 'some values are no numbers, or a quantity is missing',
    'too_large': 'beyond any sensor: give m/s^2 or g, and rad/s or degrees per second',
    'saturated': 'stuck at the limit of the sensor: give it a larger range',
    'out_of_order': 'their times do not rise',
    'stuck': 'it repeats the same numbers: restart the sensor',
    'spikes': 'single values far from the others: check its cable and supply',
    'ahead': 'their times are after their arrival: synchronise its clock',
}
"""What is wrong with a sample that is refused, and what to do."""


@dataclass
class SensorCounts:
    """
    Counts of the samples of a sensor.

    ``not_finite`` to ``ahead`` are reasons for a refusal; ``restarted`` counts how often its
    clock was set back; ``silent`` the times that it fell silent, ``disagreed`` the times that its
    motion was not that of the tree, ``clamped`` the steps in which its correction was limited to
    what storms do.
    """

    accepted: int = 0
    not_finite: int = 0
    too_large: int = 0
    saturated: int = 0
    out_of_order: int = 0
    stuck: int = 0
    spikes: int = 0
    ahead: int = 0
    restarted: int = 0
    silent: int = 0
    disagreed: int = 0
    clamped: int = 0

    @property
    def refused(self) -> int:
        """Number of refused samples."""
        return sum(getattr(self, name) for name in _REASONS)

    @property
    def why_refused(self) -> str:
        """Why most refused samples were, and what to do."""
        return _REASONS[max(_REASONS, key=lambda name: getattr(self, name))]


class MotionSensor:
    """
    A sensor on a tree.

    Parameters
    ----------
    name
        Name of the sensor.
    place
        Where it sits.

    """

    def __init__(self, name: str, place: SensorPlace) -> None:
        self.name, self.place = name, place
        self.counts = SensorCounts()
        self.quantities: tuple[str, ...] = ()
        """Quantities of most samples; others are ignored."""
        self.lost: tuple[str, ...] = ()
        """Quantities that it measured before, and no more."""
        self.trouble = ''
        """Why its newest sample was refused, and what to do; empty if it was not."""
        self.stated_noise = (0.0, 0.0, 0.0)
        """Noise that its maker states: acceleration, rate, rotation; 0 where it does not."""
        self._is_measured = np.ones(9, dtype=np.bool_)
        self._sample = np.full(9, nan)
        self.ring = SampleRing(self._sample, self._is_measured)
        """Its last samples."""
        self._reference: Floats | None = None
        self._first_turn: Floats = np.eye(3)
        self._unit = np.zeros(4)
        self._is_given: tuple[bool, ...] = ()
        self._lead = 0
        self._numbers = b''
        self._moved_at, self._n_still = inf, 0
        self._kept: list[float] = []
        self._changes = [0.0] * 3  # running medians
        self._n_spikes = -_USUAL
        self._began = -inf
        # Least and most time from stamp to arrival, in this window and in the one before.
        self._soonest, self._latest = -inf, inf
        self._soonest_before, self._latest_before = -inf, inf

    @property
    def lateness(self) -> float:
        """
        Time in [s] from stamp to arrival that all samples of the last seconds had at least.

        It is negative where all came before their stamps; 0 before it is known.
        """
        latest = max(self._latest, self._latest_before)
        if latest < 0.0:
            return latest
        return max(min(self._soonest, self._soonest_before), 0.0)

    @property
    def is_behind(self) -> bool:
        """Whether its samples come so late that its clock may be behind."""
        return self.lateness > _BEHIND

    @property
    def newest(self) -> float:
        """Time of the newest sample in [s]; minus infinity before any."""
        return self.ring.newest

    @property
    def period(self) -> float:
        """Time between samples in [s], a running median; not a number before two samples."""
        return self.ring.period

    def offer(
        self,
        time: float,
        *,
        acceleration: ArrayLike | None = None,
        rate: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        arrival: float | None = None,
    ) -> bool:
        """
        Add a sample.

        Parameters
        ----------
        time
            Time of the sample in [s], on the clock of the steps.
        acceleration
            Acceleration with or without gravity in [m/s^2] or g, (3,): the specific force, upward
            at rest.
        rate
            Angular rate in [rad/s] or degrees per second, (3,).
        orientation
            Rotation of the sensor's frame to any frame with an upright axis, such as east, north,
            up, as x y z w, (4,). Four zeros mean that it is not measured.
        arrival
            Time in [s] at which it came, on the same clock; None for a record.

        Returns
        -------
        bool
            Whether it was accepted; refusals are counted.

        """
        values = self._sample
        values[:] = nan
        if self.place.is_strain:
            acceleration = rate = None  # gauges measure neither
        try:
            if acceleration is not None:
                values[0:3] = acceleration
            if rate is not None:
                values[3:6] = rate
            if orientation is not None:
                values[6:9] = self._turn(np.asarray(orientation, dtype=float))
        except (TypeError, ValueError, OverflowError):
            pass  # what is no vector stays not a number
        try:
            stamp = float(time)
            if arrival is not None and self._is_ahead(arrival - stamp, arrival):
                outcome = AHEAD
            else:
                outcome = self._check(stamp, values.tolist())
        except (TypeError, ValueError, OverflowError):
            outcome = NOT_FINITE
        counts = self.counts
        if outcome == KEPT:
            counts.accepted += 1
            self.trouble = ''
            return True
        name = _COUNTED[outcome]
        setattr(counts, name, getattr(counts, name) + 1)
        if outcome == RESTARTED:
            counts.accepted += 1
        self.trouble = _REASONS.get(name, '')
        if outcome == AHEAD:
            self.trouble = f'its times are {-self.lateness:+.1f} s from the steps: check its clock'
        return not self.trouble

    def _is_ahead(self, late: float, arrival: float) -> bool:
        """Note how late a sample comes in [s]; whether all of the last seconds came too soon."""
        if not 0.0 <= arrival - self._began < _WINDOW:
            self._began = arrival
            self._soonest_before, self._latest_before = self._soonest, self._latest
            self._soonest, self._latest = inf, -inf
        if late < self._soonest:
            self._soonest = late
        if late > self._latest:
            self._latest = late
        return self._latest < -_AHEAD and self._latest_before < -_AHEAD

    def _check(self, time: float, numbers: list[float]) -> int:
        """Keep the sample in `_sample` unless it is bad; return what became of it."""
        a, b, c, d, e, f, g, h, i = numbers
        is_given = isfinite(a + b + c), isfinite(d + e + f), isfinite(g + h + i)
        self._vote(is_given)
        if any(is_given) and self._is_still(time):
            self._kept = []
            return STUCK
        if self._kept and self._is_spike(numbers):
            return SPIKE
        outcome = self.ring.keep(time)
        if outcome in {KEPT, RESTARTED}:
            self._kept = numbers
        return outcome

    def _vote(self, is_given: tuple[bool, ...]) -> None:
        """Let a sample vote for its quantities; a majority for others begins the sensor anew."""
        if is_given == self._is_given:
            if self._lead < _MOST_LEAD:
                self._lead += 1
            return
        self._lead -= any(is_given)
        if self._lead >= 0:
            return
        before, pairs = self.quantities, zip(QUANTITIES, is_given, strict=True)
        self.quantities = tuple([name for name, is_there in pairs if is_there])
        if self.counts.accepted > _MOST_LEAD:
            self.lost = tuple([name for name in before if name not in self.quantities])
        self._is_given, self._lead = is_given, 1
        self._is_measured[:] = np.repeat(is_given, 3)
        self._kept, self._n_spikes = [], -_USUAL
        self.ring.clear()
        if is_given[2]:
            self._reference = None
            self._sample[6:9] = self._turn(self._unit)

    def _is_still(self, time: float) -> bool:
        """Whether the sensor has repeated its numbers for too long: it is dead, not at rest."""
        numbers = self._sample.tobytes()
        if numbers != self._numbers:
            self._numbers, self._moved_at, self._n_still = numbers, time, 0
            return False
        self._moved_at = min(self._moved_at, time)
        self._n_still += 1
        return self._n_still >= _LEAST_STILL and time - self._moved_at >= _STILL

    def _is_spike(self, numbers: list[float]) -> bool:
        """Whether a sample is far from the one before, unless it is the last of several."""
        is_far, kept, changes = False, self._kept, self._changes
        for k, is_given in enumerate(self._is_given):
            if not is_given:
                continue
            rows = _ROWS[k]
            change = dist(kept[rows], numbers[rows])
            usual = changes[k] or change
            if usual < _LEAST_CHANGE[k]:
                usual = _LEAST_CHANGE[k]
            if change > usual:
                # A running median: up or down by a twentieth.
                changes[k] = 1.05 * usual
                is_far = is_far or change > _APART * usual
            else:
                changes[k] = 0.95 * usual
        self._n_spikes += 1
        if self._n_spikes <= 0:
            return False
        if is_far and self._n_spikes <= _SPIKES:
            return True
        self._n_spikes = 0
        return False

    def _turn(self, quaternion: Floats) -> Floats:
        """
        Rotation vector from the first orientation, in the frame of the sensor, (3,).

        It is not finite for no quaternion.
        """
        length = float(np.linalg.norm(quaternion))
        if quaternion.shape != (4,) or not 0.5 < length < 2.0:
            return np.full(3, np.nan)
        unit = self._unit = quaternion / length
        if self._reference is None:
            self._reference = unit
            self._first_turn = matrix_of(unit)
        return np.asarray(turn_between(self._reference, unit) @ self._first_turn)

    @property
    def reference(self) -> Floats | None:
        """First orientation, x y z w; None without orientations."""
        return self._reference
