# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What all sensors measure beyond the model, at the newest step that their samples cover.

A sensor that sends late is read at an earlier step, and compared with the motion that the model
had then.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np

from tree_sway.core.arrays import Floats
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
        self._sensed = np.zeros((_KEPT, len(tracks), ROWS))
        self._forces = np.zeros((_KEPT, unknown.count))
        self.forces = self._forces[0]
        """Force of the wind on each coordinate at the step that was read, (n,)."""
        self._swing = np.zeros(3 * len(unknown.all_stiffness))
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
        self._rows = np.array(rows).reshape(-1, len(self._swing))

    def note(self, step: int, swing: tuple[Floats, ...]) -> None:
        """Note displacement, rate and force of each coordinate in the wind alone, (m,)."""
        m, slot, n = len(swing[0]), step % _KEPT, self._unknown.count
        state, forces = self._swing, self._forces[slot]
        state[:m], state[m : 2 * m], state[2 * m :] = swing
        np.dot(self._rows, state, out=self._sensed[slot].reshape(-1))
        # The force of the wind on a tree that stands still.
        np.multiply(self._unknown.air_damping, swing[1][:n], out=forces)
        forces += swing[2][:n]

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
            due = next((track for track in self._tracks if track.is_due), None)
            if due is None:
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
