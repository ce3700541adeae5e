# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Samples of a motion sensor: checked as they come, and read at any time.

A sample has an acceleration, an angular rate, an orientation, or several of them, in the sensor's
own frame. A sample that is not finite, beyond any sensor, stuck at the limit of the sensor, or out
of order is refused and counted.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.observe.sensor_place import SensorPlace, turn_between

QUANTITIES = ('acceleration', 'rate', 'orientation')
"""Quantities of a sample: [m/s^2], [rad/s], and a quaternion x y z w."""

MOST_ACCELERATION, MOST_RATE = 320.0, 2500.0
"""Largest values of sensors: 32 g in [m/s^2]; 2,000 degrees per second, also in degrees."""

_SATURATED = {'acceleration': 15.0, 'rate': 4.0}
"""Values above which a repeated number is the limit of a sensor; below, one that moves little."""
_REPEATED = 3
_QUEUE = 4096
_CLOCK_BACK = 1.0
_LONGEST_GAP = 0.25
_SILENT_PERIODS = 4.0
_SAME_TIME = 0.01


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
        self.period = math.nan
        """Time between samples in [s], a running median; not a number before two samples."""
        self._samples: deque[tuple[float, Floats]] = deque(maxlen=_QUEUE)
        self._newest = -math.inf
        self._behind = 0
        self._same = np.zeros(6, dtype=np.int64)
        self._before = np.full(6, np.nan)
        self._reference: Floats | None = None

    @property
    def newest(self) -> float:
        """Time of the newest sample in [s]; minus infinity before any."""
        return self._newest

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
            Rotation of the sensor's frame to east, north, up as x y z w, (4,).

        Returns
        -------
        bool
            Whether it was accepted; refusals are counted.

        """
        given = {'acceleration': acceleration, 'rate': rate, 'orientation': orientation}
        if not self.quantities:
            self.quantities = tuple(name for name in QUANTITIES if given[name] is not None)
        values = np.full(9, np.nan)
        try:
            for name, rows in _ROWS.items():
                if name in self.quantities and name != 'orientation':
                    values[rows] = given[name]
            if 'orientation' in self.quantities:
                values[_ROWS['orientation']] = self._turn(np.asarray(orientation, dtype=float))
            time = float(time)
        except (TypeError, ValueError):
            self.counts.not_finite += 1
            return False
        if not self._is_good(time, values):
            return False
        self._keep(time, values)
        return True

    def _turn(self, quaternion: Floats) -> Floats:
        """Rotation vector from the first orientation, (3,); not finite for no quaternion."""
        length = float(np.linalg.norm(quaternion))
        if quaternion.shape != (4,) or not 0.5 < length < 2.0:
            return np.full(3, np.nan)
        unit = quaternion / length
        if self._reference is None:
            self._reference = unit
        return turn_between(self._reference, unit)

    @property
    def reference(self) -> Floats | None:
        """First orientation, x y z w; None without orientations."""
        return self._reference

    def _is_good(self, time: float, values: Floats) -> bool:
        """Check a sample, and count the first reason against it."""
        counts = self.counts
        asked = np.concatenate([values[_ROWS[name]] for name in self.quantities] or [values])
        if not (math.isfinite(time) and np.isfinite(asked).all()):
            counts.not_finite += 1
            return False
        motion = np.nan_to_num(values[:6])
        if np.abs(motion[:3]).max() > MOST_ACCELERATION or np.abs(motion[3:]).max() > MOST_RATE:
            counts.too_large += 1
            return False
        if time <= self._newest:
            return self._is_restart(time)
        self._behind = 0
        self._same = np.where(values[:6] == self._before, self._same + 1, 0)
        self._before = values[:6]
        limits = np.repeat([_SATURATED['acceleration'], _SATURATED['rate']], 3)
        if ((self._same >= _REPEATED) & (np.abs(motion) > limits)).any():
            counts.saturated += 1
            return False
        return True

    def _is_restart(self, time: float) -> bool:
        """Refuse a sample of the past; several in a row, far back, are those of a new clock."""
        self._behind += time < self._newest - _CLOCK_BACK
        if self._behind >= _REPEATED:
            self.counts.restarted += 1
            self._samples.clear()
            self._newest, self._behind = -math.inf, 0
            return True
        self.counts.out_of_order += 1
        return False

    def _keep(self, time: float, values: Floats) -> None:
        step = time - self._newest
        if math.isfinite(step):
            # A running median: up or down by a twentieth.
            known = step if math.isnan(self.period) else self.period
            self.period = known * (1.05 if step > known else 0.95 if step < known else 1.0)
        self._samples.append((time, values))
        self._newest = time
        self.counts.accepted += 1

    @property
    def longest_gap(self) -> float:
        """Longest time between samples that is bridged in [s]."""
        return max(_LONGEST_GAP, 0.0 if math.isnan(self.period) else _SILENT_PERIODS * self.period)

    def at(self, time: float, dt: float) -> Floats | None:
        """
        Read the motion about a time.

        Samples within a step of dt [s] about the time are averaged; elsewhere the samples before
        and after are joined. Older samples are forgotten.

        Returns
        -------
        Floats or None
            Acceleration, rate and rotation, (9,), not a number where not measured; None where no
            sample is near.

        """
        samples = self._samples
        while len(samples) > 2 and samples[1][0] < time - 0.5 * dt:
            samples.popleft()
        total, count = np.zeros(9), 0
        before: tuple[float, Floats] | None = None
        after: tuple[float, Floats] | None = None
        for stamp, values in samples:
            if stamp > time + 0.5 * dt:
                after = (stamp, values) if after is None else after
                break
            if stamp > time - 0.5 * dt:
                total += values
                count += 1
            if stamp <= time:
                before = (stamp, values)
            elif after is None:
                after = (stamp, values)
        if count > 1:
            return total / count
        if before is not None and time - before[0] < _SAME_TIME * dt:
            return before[1]
        if before is None or after is None or after[0] - before[0] > self.longest_gap:
            return None
        share = (time - before[0]) / (after[0] - before[0])
        return before[1] + share * (after[1] - before[1])


_ROWS = {'acceleration': slice(0, 3), 'rate': slice(3, 6), 'orientation': slice(6, 9)}
"""Where each quantity is in a sample."""
