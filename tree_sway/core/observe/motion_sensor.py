# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Samples of a motion sensor: checked as they come, and read at any time.

A sample has an acceleration, an angular rate, an orientation, or several of them, in the sensor's
own frame. A sample that is not finite, beyond any sensor, stuck at the limit of the sensor, or out
of order is refused and counted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of
from tree_sway.core.observe.alignment import matrix_of
from tree_sway.core.observe.sample_ring import (
    empty_ring,
    keep_sample,
    KEPT,
    longest_gap,
    NEWEST,
    NOT_FINITE,
    OUT_OF_ORDER,
    PERIOD,
    read_samples,
    RESTARTED,
    SATURATED,
    TOO_LARGE,
)
from tree_sway.core.observe.sensor_place import SensorPlace, turn_between

QUANTITIES = ('acceleration', 'rate', 'orientation')
"""Quantities of a sample: [m/s^2], [rad/s], and a quaternion x y z w."""

_ROWS = {'acceleration': slice(0, 3), 'rate': slice(3, 6), 'orientation': slice(6, 9)}
"""Where each quantity is in a sample."""

_COUNTED = {
    KEPT: 'accepted',
    NOT_FINITE: 'not_finite',
    TOO_LARGE: 'too_large',
    SATURATED: 'saturated',
    OUT_OF_ORDER: 'out_of_order',
    RESTARTED: 'restarted',
}


@dataclass
class SensorCounts:
    """
    Counts of the samples of a sensor.

    ``not_finite``, ``too_large``, ``saturated`` and ``out_of_order`` are reasons for a refusal;
    ``restarted`` counts how often its clock was set back; ``silent`` the times that it fell
    silent, ``disagreed`` the times that its motion was not that of the tree, ``clamped`` the steps
    in which its correction was limited to what storms do.
    """

    accepted: int = 0
    not_finite: int = 0
    too_large: int = 0
    saturated: int = 0
    out_of_order: int = 0
    restarted: int = 0
    silent: int = 0
    disagreed: int = 0
    clamped: int = 0

    @property
    def refused(self) -> int:
        """Number of refused samples."""
        return self.not_finite + self.too_large + self.saturated + self.out_of_order

    @property
    def why_refused(self) -> str:
        """Why most refused samples were, and what to do."""
        reasons = {
            'some values are no numbers': self.not_finite,
            'beyond any sensor: give m/s^2 or g, and rad/s or degrees per second': self.too_large,
            'stuck at the limit of the sensor: give it a larger range': self.saturated,
            'their times do not rise': self.out_of_order,
        }
        return max(reasons, key=lambda reason: reasons[reason])


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
        """Quantities of its first sample; others are ignored."""
        self.stated_noise = (0.0, 0.0, 0.0)
        """Noise that its maker states: acceleration, rate, rotation; 0 where it does not."""
        self._is_measured = np.ones(9, dtype=np.bool_)
        self._sample, self._found = np.full((2, 9), np.nan)
        self.ring = empty_ring()
        """Its last samples, (1,) of `RING`."""
        self._reference: Floats | None = None
        self._first_turn: Floats = np.eye(3)

    @property
    def newest(self) -> float:
        """Time of the newest sample in [s]; minus infinity before any."""
        return float(self._clock[NEWEST])

    @property
    def period(self) -> float:
        """Time between samples in [s], a running median; not a number before two samples."""
        return float(self._clock[PERIOD])

    @cached_property
    def _clock(self) -> Floats:
        return np.asarray(self.ring['clock'][0])

    @cached_property
    def _keep(self) -> Callable[[float], int]:
        """Check and keep the sample in `_sample`, of a time."""
        call = entry_of(keep_sample, self.ring, 0.0, self._sample, self._is_measured)
        return lambda time: call(self.ring, time, self._sample, self._is_measured)

    @cached_property
    def _read(self) -> Callable[..., bool]:
        return partial(entry_of(read_samples, self.ring, 0.0, 0.0, self._found), self.ring)

    def offer(
        self,
        time: float,
        *,
        acceleration: ArrayLike | None = None,
        rate: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
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
            up, as x y z w, (4,). Four zeros in the first sample mean that it is not measured.

        Returns
        -------
        bool
            Whether it was accepted; refusals are counted.

        """
        if not self.quantities:
            is_turned = orientation is not None and bool(np.any(orientation))
            self._begin(acceleration is not None, rate is not None, is_turned)
        values = self._sample
        try:
            if 'acceleration' in self.quantities:
                values[0:3] = acceleration
            if 'rate' in self.quantities:
                values[3:6] = rate
            if 'orientation' in self.quantities:
                values[6:9] = self._turn(np.asarray(orientation, dtype=float))
            outcome = self._keep(float(time))
        except (TypeError, ValueError, OverflowError):
            outcome = NOT_FINITE
        counts, name = self.counts, _COUNTED[outcome]
        setattr(counts, name, getattr(counts, name) + 1)
        if outcome == RESTARTED:
            counts.accepted += 1
        return outcome in {KEPT, RESTARTED}

    def _begin(self, *is_given: bool) -> None:
        """Take the quantities of the first sample as those of the sensor."""
        pairs = zip(QUANTITIES, is_given, strict=True)
        self.quantities = tuple(name for name, given in pairs if given)
        if self.quantities:
            self._is_measured[:] = np.repeat(is_given, 3)

    def _turn(self, quaternion: Floats) -> Floats:
        """
        Rotation vector from the first orientation, in the frame of the sensor, (3,).

        It is not finite for no quaternion.
        """
        length = float(np.linalg.norm(quaternion))
        if quaternion.shape != (4,) or not 0.5 < length < 2.0:
            return np.full(3, np.nan)
        unit = quaternion / length
        if self._reference is None:
            self._reference = unit
            self._first_turn = matrix_of(unit)
        return np.asarray(turn_between(self._reference, unit) @ self._first_turn)

    @property
    def reference(self) -> Floats | None:
        """First orientation, x y z w; None without orientations."""
        return self._reference

    @property
    def longest_gap(self) -> float:
        """Longest time between samples that is bridged in [s]."""
        return longest_gap(self.period)

    def at(self, time: float, dt: float) -> Floats | None:
        """
        Read the motion about a time.

        Samples within a step of dt [s] about the time are averaged; elsewhere the samples before
        and after are joined. Older samples are forgotten.

        Returns
        -------
        Floats or None
            Acceleration, rate and rotation, (9,), not a number where not measured; None where no
            sample is near. The array is reused.

        """
        return self._found if self._read(time, dt, self._found) else None
