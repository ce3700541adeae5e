# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Samples of a motion sensor: checked as they come, and read at any time.

A sample has an acceleration, an angular rate, an orientation, or several of them, in the sensor's
own frame. A sample that is not finite, beyond any sensor, stuck at the limit of the sensor, out of
order, or far from those about it is refused and counted, and so are those of a sensor that repeats
its numbers (`sample_ring`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import compress
from math import inf, nan

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.twin.alignment import matrix_of
from tree_sway.twin.sample_ring import SampleRing
from tree_sway.twin.sensor_place import SensorPlace, turn_between

_QUANTITIES = ('acceleration', 'rate', 'orientation')
"""Quantities of a sample: [m/s^2], [rad/s], and a quaternion x y z w."""

_MANY = 100
"""Samples that were kept from which on a quantity that is missing was lost."""

_WINDOW, _AHEAD, _BEHIND = 2.0, 0.1, 0.3
"""
Time [s] over which stamps are compared with arrivals; by how much all of them are after these if
the clock of the sensor is ahead, and by how much all are before if it may be behind [s].
"""

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
        self.unusable: tuple[str, ...] = ()
        """Quantities that it sends, but not as numbers from the beginning."""
        self.trouble = ''
        """Why its newest sample was refused, and what to do; empty if it was not."""
        self.stated_noise = (0.0, 0.0, 0.0)
        """Noise that its maker states: acceleration, rate, rotation; 0 where it does not."""
        self._sample = np.full(9, nan)
        self.ring = SampleRing(self._sample)
        """Its last samples."""
        self.reference: Floats | None = None
        """First orientation, x y z w; None without orientations."""
        self._first_turn: Floats = np.eye(3)
        self._unit = np.zeros(4)
        self._began = -inf
        # Least and most time from stamp to arrival, in this window and in the one before.
        self._late = self._late_before = -inf, inf

    @property
    def lateness(self) -> float:
        """
        Time in [s] from stamp to arrival that all samples of the last seconds had at least.

        It is negative where all came before their stamps; 0 before it is known.
        """
        least, most = zip(self._late, self._late_before, strict=True)
        return max(most) if max(most) < 0.0 else max(min(least), 0.0)

    @property
    def is_behind(self) -> bool:
        """Whether its samples come so late that its clock may be behind."""
        return self.lateness > _BEHIND

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
                outcome = 'ahead'  # it came before its time
            else:
                outcome = self.ring.keep(stamp)
                if outcome == 'others':
                    # An orientation of zeros is not measured.
                    self._begin((acceleration is not None, rate is not None))
                    outcome = self.ring.keep(stamp)
        except (TypeError, ValueError, OverflowError):
            outcome = 'not_finite'
        counts = self.counts
        setattr(counts, outcome, getattr(counts, outcome) + 1)
        if outcome == 'restarted':
            counts.accepted += 1
        self.trouble = _REASONS.get(outcome, '')
        if outcome == 'ahead':
            self.trouble = f'its times are {-self.lateness:+.1f} s from the steps: check its clock'
        return not self.trouble

    def _is_ahead(self, late: float, arrival: float) -> bool:
        """Note how late a sample comes in [s]; whether all of the last seconds came too soon."""
        if not 0.0 <= arrival - self._began < _WINDOW:
            self._began, self._late_before, self._late = arrival, self._late, (inf, -inf)
        least, most = self._late
        self._late = min(least, late), max(most, late)
        return max(self._late[1], self._late_before[1]) < -_AHEAD

    def _begin(self, is_sent: tuple[bool, bool]) -> None:
        """Begin anew with the quantities of the sample that is offered, of those that are sent."""
        is_given = np.isfinite(self._sample.reshape(3, 3)).all(axis=1).tolist()
        before, self.quantities = self.quantities, tuple(compress(_QUANTITIES, is_given))
        if self.counts.accepted > _MANY:
            self.lost = tuple([name for name in before if name not in self.quantities])
        known = *self.quantities, *self.lost
        sent = compress(_QUANTITIES, is_sent)
        self.unusable = tuple([name for name in sent if name not in known])
        self.ring.ask_for(is_given)
        if is_given[2]:
            self.reference = None
            self._sample[6:9] = self._turn(self._unit)

    def _turn(self, quaternion: Floats) -> Floats:
        """
        Rotation vector from the first orientation, in the frame of the sensor, (3,).

        It is not finite for no quaternion.
        """
        length = float(np.linalg.norm(quaternion))
        if quaternion.shape != (4,) or not 0.5 < length < 2.0:
            return np.full(3, np.nan)
        unit = self._unit = quaternion / length
        if self.reference is None:
            self.reference = unit
            self._first_turn = matrix_of(unit)
        return turn_between(self.reference, unit) @ self._first_turn
