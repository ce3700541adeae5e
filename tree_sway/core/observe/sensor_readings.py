# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What all sensors measure beyond the model, at the newest step that their samples cover.

A sensor that sends late is read at an earlier step, and compared with the motion that the model
had then.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, kernel, WHY_PLAIN
from tree_sway.core.observe.late_wind import LateWind, LONGEST_WAY
from tree_sway.core.observe.lateness import Lateness
from tree_sway.core.observe.later_work import LaterWork, Submit
from tree_sway.core.observe.sensor_place import PlaceMotion
from tree_sway.core.observe.sensor_track import (
    FoundMounting,
    LagRange,
    NO_LAG,
    ROWS,
    sensed_rows,
    SensorTrack,
)
from tree_sway.core.observe.unknown_motion import UnknownMotion

LATEST = 30
"""Largest number of steps by which sensors are read late."""

_KEPT = 64

_MOUNTED_AFTER = 12
"""Steps after which a mounting that is looked for is known."""

_LEAST_LAG, _LEAST_CHANGE = 1.0, 0.2
"""
Least lag of the wind in [s] that is believed at first, and least change of it afterwards.

Gusts reach single limbs later than the stem too: only the sensor that found a lag changes it.
"""


class SensorReadings:
    """
    Readings of the sensors on a tree.

    Parameters
    ----------
    unknown
        Law of the unknown motion, with stiffness and damping of the model.
    tracks, places
        Sensors, and how each is moved by the coordinates of the model.
    dt
        Time step in [s].
    wind
        Wind of the tree, which is made as late as the sensors tell.
    submit
        As `LaterWork` takes it.

    """

    def __init__(
        self,
        unknown: UnknownMotion,
        tracks: Sequence[SensorTrack],
        places: Sequence[PlaceMotion],
        dt: float,
        wind: LateWind,
        submit: Submit | None = None,
    ) -> None:
        self._unknown, self._tracks, self._places = unknown, tracks, places
        self._dt, self._wind, self._submit = dt, wind, submit
        self._told_lag: SensorTrack | None = None
        self._search: tuple[SensorTrack, LaterWork[FoundMounting]] | None = None
        self.lateness = Lateness(len(tracks), dt, LATEST)
        """Steps by which sensors are read late."""
        self._compute: Callable[..., None] | None = None
        self._sensed = np.zeros((_KEPT, len(tracks), ROWS))
        self._forces = np.zeros((_KEPT, unknown.count))
        self.forces = self._forces[0]
        """Force of the wind on each coordinate at the step that was read, (n,)."""
        self.beyond = np.zeros((len(tracks), 9))
        """Motion of each beyond the model's, in the frame of the tree, (k, 9)."""
        self._beyond = list(self.beyond)
        self.is_known = np.zeros(len(tracks), dtype=np.bool_)
        """Which of them there are, (k,)."""
        self.read_model()

    def read_model(self) -> None:
        """Read stiffness and damping of the model again."""
        law = self._unknown.all_stiffness, self._unknown.all_damping
        rows = [sensed_rows(each, *law) for each in self._places]
        m = len(self._unknown.all_stiffness)
        self._rows = np.array(rows).reshape(-1, 3 * m).T.reshape(3, m, -1).copy()

    def note(self, step: int, swing: tuple[Floats, ...]) -> None:
        """Note displacement, rate and force of each coordinate in the wind alone, (m,)."""
        if self._compute is None:
            self._compute = self._computing(swing)
        damping, slot = self._unknown.air_damping, step % _KEPT
        self._compute(self._rows, damping, *swing, slot, self._sensed, self._forces)

    def _computing(self, swing: tuple[Floats, ...]) -> Callable[..., None]:
        """Return `compute` for arrays as these."""
        if WHY_PLAIN:
            return compute_in_numpy
        damping = self._unknown.air_damping
        return entry_of(compute, self._rows, damping, *swing, 0, self._sensed, self._forces)

    def read(self, time: float, step: int, done: int) -> bool:
        """
        Read the sensors.

        Parameters
        ----------
        time
            Time of the end of the step in [s].
        step, done
            Number of the step, and of the newest one that was read before.

        Returns
        -------
        bool
            Whether a step was read; not where sensors have become later.

        """
        for k, track in enumerate(self._tracks):
            if track.may_be_used:
                self.lateness.note(k, time, track.sensor.newest)
        self.lateness.settle(time)
        late = self.lateness.steps
        if step - late <= done:
            self.is_known[:] = False
            return False
        slot, when = (step - late) % _KEPT, time - late * self._dt
        self.forces = self._forces[slot]
        self._find_mounting()
        sensed = self._sensed[slot]
        for k, track in enumerate(self._tracks):
            self.is_known[k] = track.read(when, sensed[k], self._beyond[k])
        return True

    def _find_mounting(self) -> None:
        """Go on with finding a mounting, or begin with that of the next sensor that is due."""
        if self._search is None:
            for due in self._tracks:
                if due.is_due:
                    break
            else:
                return
            search = due.search(self._lags_of(due))
            self._search = due, LaterWork(search, _MOUNTED_AFTER, self._submit)
        track, work = self._search
        found = work.advance()
        if found is not None:
            self._search = None
            track.take(found)
            if found.lag:
                self._told_lag = track
                self._wind.delay_more(found.lag * self._dt)
                for each in self._tracks:
                    each.delay_model(found.lag)

    def _lags_of(self, track: SensorTrack) -> LagRange:
        """Find which lags of the wind a sensor may tell."""
        delay = self._wind.delay
        if self._told_lag not in (None, track):
            return NO_LAG
        if delay:
            least = round(_LEAST_CHANGE / self._dt)
        else:
            least = max(round(_LEAST_LAG / self._dt), track.window)
        earliest = -math.floor(delay / self._dt)
        return LagRange(earliest, math.floor((LONGEST_WAY - delay) / self._dt), least)


@kernel
def compute(
    rows: Floats, air_damping: Floats, eta: Floats, rate: Floats, force: Floats, slot: int,
    sensed: Floats, still: Floats,
) -> None:  # fmt: skip
    """
    Compute what sensors would measure, and the force of the wind on a tree that stands still.

    Parameters
    ----------
    rows
        Rows of all sensors by displacement, rate and force of each coordinate, (3, m, r).
    air_damping
        Damping of the first coordinates by the air [1/s], (n,).
    eta, rate, force
        Displacement, rate and force of each coordinate, (m,).
    slot
        Number of the step among those that are kept.
    sensed, still
        Measurements, (s, k, r / k), and forces, (s, n), of the steps that are kept, written.

    """
    found = sensed[slot].reshape(rows.shape[2])
    found[:] = 0.0
    for j in range(rows.shape[1]):
        for r in range(rows.shape[2]):
            found[r] += rows[0, j, r] * eta[j] + rows[1, j, r] * rate[j] + rows[2, j, r] * force[j]
    for i in range(len(air_damping)):
        still[slot, i] = air_damping[i] * rate[i] + force[i]


def compute_in_numpy(
    rows: Floats, air_damping: Floats, eta: Floats, rate: Floats, force: Floats, slot: int,
    sensed: Floats, still: Floats,
) -> None:  # fmt: skip
    """Compute what sensors would measure as `compute`."""
    found = sum(each @ by for each, by in zip((eta, rate, force), rows, strict=True))
    sensed[slot] = np.reshape(found, sensed.shape[1:])
    n = len(air_damping)
    still[slot] = air_damping * rate[:n] + force[:n]
