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
from tree_sway.core.native import LIBRARY, NativeReadings
from tree_sway.twin.late_wind import LateWind, LONGEST_WAY
from tree_sway.twin.later_work import LaterWork
from tree_sway.twin.sensor_track import (
    FoundMounting,
    LagRange,
    ROWS,
    SensorTrack,
)
from tree_sway.twin.unknown_motion import UnknownMotion

LATEST = 30
"""Largest number of steps by which sensors are read late."""

_KEPT = 64
"""Steps whose measurements are kept, ``SWAY_SLOTS`` of the native core."""

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
    tracks
        Sensors.
    swing
        Displacement, rate and force of each coordinate in the wind alone, (m,).
    wind
        Wind of the tree, which is made as late as the sensors tell.

    """

    def __init__(
        self,
        unknown: UnknownMotion,
        tracks: Sequence[SensorTrack],
        swing: Sequence[Floats],
        wind: LateWind,
    ) -> None:
        self._unknown, self._tracks = unknown, tracks
        self._dt, self._wind = unknown.dt, wind
        self._told_lag: SensorTrack | None = None
        self._search: tuple[SensorTrack, LaterWork[FoundMounting]] | None = None
        self._sensed = np.zeros((_KEPT, len(tracks), ROWS))
        self._forces = np.zeros((_KEPT, unknown.count))
        self.beyond = np.zeros((len(tracks), 9))
        """Motion of each beyond the model's, in the frame of the tree, (k, 9)."""
        self.is_known = np.zeros(len(tracks), dtype=np.bool_)
        """Which of them there are, (k,)."""
        shapes = [np.stack(each.motion) for each in tracks]
        self._law = np.zeros((2, len(unknown.all_stiffness)))
        eta, rate, force = swing
        self.native = NativeReadings(
            sensors=len(tracks), coordinates=len(eta), corrected=unknown.count,
            sensor=np.array([each.native.at for each in tracks], dtype=np.int64),
            shapes=np.array(shapes), stiffness=self._law[0], damping=self._law[1],
            air_damping=unknown.air_damping, eta=eta, rate=rate, force=force,
            sensed=self._sensed, still=self._forces, beyond=self.beyond, is_known=self.is_known,
        )  # fmt: skip
        """Readings in the native core."""
        self.read_model()

    def read_model(self) -> None:
        """Read stiffness and damping of the model again."""
        self._law[:] = self._unknown.all_stiffness, self._unknown.all_damping

    def read(self, time: float, step: int, done: int) -> int:
        """
        Compute what sensors would measure, and read them.

        Parameters
        ----------
        time
            Time of the end of the step in [s].
        step, done
            Number of the step, and of the newest one that was read before.

        Returns
        -------
        int
            The step that was read; -1 if it was done before, as sensors have become later.

        """
        for track in self._tracks:
            if track.heed() and self._search is not None and self._search[0] is track:
                self._search = None  # it looks at what the sensor measured before
        if self._wind.moves_model:
            self._find_mounting(step)
        counts = [each.native.count for each in self._tracks]
        found = int(LIBRARY.sway_read_sensors(self.native.at, step, done, time))
        if not self._wind.moves_model:
            for track, count in zip(self._tracks, counts, strict=True):
                track.native.count = count  # it remembers nothing of a model without wind
        return found

    def _find_mounting(self, step: int) -> None:
        """Go on with finding a mounting, or begin with that of the next sensor that is due."""
        if self._search is None:
            for due in self._tracks:
                if due.is_due:
                    break
            else:
                return
            for each in self._tracks:
                each.note_step(step)
            search = due.search(self._lags_of(due))
            self._search = due, LaterWork(search, _MOUNTED_AFTER)
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
        about, none = self._wind.lag_at(track.reach)
        others = tuple(
            each.beside(track, self._wind.lag_at(each.reach)[0])
            for each in self._tracks
            if each is not track and each.is_comparable
        )
        way = LagRange(
            0, 0, 1, about, none, self._wind.is_told, later=self._wind.later, others=others,
            of_wind=round(self._wind.known_late / self._dt), is_whole=self._wind.is_whole,
        )  # fmt: skip
        if way.is_told or self._told_lag not in (None, track):
            return way
        if delay:
            least = round(_LEAST_CHANGE / self._dt)
        else:
            least = max(round(_LEAST_LAG / self._dt), track.window)
        earliest, latest = -delay / self._dt, (LONGEST_WAY - delay) / self._dt
        return way._replace(earliest=math.ceil(earliest), latest=math.floor(latest), least=least)
