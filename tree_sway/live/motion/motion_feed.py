# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Live motion sensors of an observed tree: their samples, with times on the clock of its steps.

Samples have times of `time.monotonic`, and so has each step, however late it is taken. Where time
was left out of the steps, by a pause or because this machine was late, the samples of that time
have no step: they are refused, counted, and said to be so.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import time
from typing import NamedTuple

from tree_sway.live.camera.film import LiveFilm
from tree_sway.live.camera.page_film import PageFilm
from tree_sway.live.motion.live_motion import LiveMotion
from tree_sway.twin import ObservedTree
from tree_sway.twin.camera import FilmedTree

_ROUNDING = 1e-6
"""Largest change [s] of the difference of the clocks that is none."""


class PlacedSensor(NamedTuple):
    """A live sensor, and its place as `place_on` takes it."""

    live: LiveMotion
    at: str


class _LeftOut(NamedTuple):
    """Time that was left out of the steps."""

    ahead: float
    """Time of the steps before it less that of the clock [s]."""
    since: float
    """Its begin, by the steps [s]."""
    until: float
    """Its end, by the clock [s]."""


class MotionFeed:
    """
    Sensors on one tree.

    Parameters
    ----------
    sensors
        The sensors and their places.

    """

    def __init__(self, sensors: Sequence[PlacedSensor] = ()) -> None:
        self.sensors = {f'{each.live.name} at {each.at}': each for each in sensors}
        """Sensors by their names; of two of one name and place, the last."""
        self.film: LiveFilm | PageFilm | None = None
        """A camera that films the tree; None without one."""
        self._ahead = math.nan  # time of a step less the time of the clock at which it is due [s]
        self._stepped = -math.inf  # time of the last step [s]
        self._left_out = _LeftOut(0.0, -math.inf, -math.inf)

    @property
    def places(self) -> dict[str, str]:
        """Place of each sensor, for `ObservedTree`."""
        return {name: each.at for name, each in self.sensors.items()}

    def feed(self, simulator: object, until: float, due: float | None = None) -> None:
        """
        Offer the samples that have come to an observed tree; drop them for any other.

        Parameters
        ----------
        simulator
            The simulator that is stepped.
        until
            Present time of its steps in [s].
        due
            Time of `time.monotonic` at which that step is due [s]; now if None.

        """
        moment = time.monotonic() if due is None else due
        ahead = until - moment
        if self._ahead - ahead > _ROUNDING:
            self._left_out = _LeftOut(self._ahead, self._stepped, self._stepped - ahead)
        self._ahead, self._stepped = ahead, until
        if film := self.film:
            sightings = film.drain()
            if isinstance(simulator, FilmedTree):
                simulator.camera = film.camera
                for seen in sightings:
                    simulator.film(seen.time + self._ahead, seen.reference, seen.points)
        for name, placed in self.sensors.items():
            samples = placed.live.drain(moment)
            if not isinstance(simulator, ObservedTree) or name not in simulator.sensors:
                continue
            for sample in samples:
                at = self._time_of(sample.time or moment)
                if at is None:
                    placed.live.left_out += 1
                    continue
                simulator.offer(
                    name,
                    at,
                    acceleration=sample.acceleration,
                    rate=sample.rate,
                    orientation=sample.orientation,
                )

    def _time_of(self, moment: float) -> float | None:
        """Return the time of the steps at a moment of the clock [s]; None if it was left out."""
        gap = self._left_out
        if moment >= gap.until:
            return moment + self._ahead
        before = moment + gap.ahead
        return before if before <= gap.since else None
