# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Live motion sensors of an observed tree: their samples, with times on the clock of its steps.

Samples have times of `time.monotonic`. The difference to the time of the steps is averaged, as
steps jitter, and taken anew where it jumps.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import time
from typing import NamedTuple

from tree_sway.live.camera.film import LiveFilm
from tree_sway.live.motion.live_motion import LiveMotion
from tree_sway.twin import ObservedTree
from tree_sway.twin.camera import Camera, FilmedTree

_NEWEST = 0.02
"""Weight of the newest difference of the clocks in their mean."""
_JUMP = 0.1
"""Change of the difference [s] that is no jitter: the steps were paused or late."""


class PlacedSensor(NamedTuple):
    """A live sensor, and its place as `place_on` takes it."""

    live: LiveMotion
    at: str


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
        self.film: LiveFilm | None = None
        """A camera that films the tree; None without one."""
        self._ahead = math.nan  # mean time of the steps less that of the clock [s]

    @property
    def places(self) -> dict[str, str]:
        """Place of each sensor, for `ObservedTree`."""
        return {name: each.at for name, each in self.sensors.items()}

    @property
    def camera(self) -> Camera | None:
        """Where the camera stands; None without one."""
        return None if self.film is None else self.film.camera

    def feed(self, simulator: object, until: float) -> None:
        """
        Offer the samples that have come to an observed tree; drop them for any other.

        Parameters
        ----------
        simulator
            The simulator that is stepped.
        until
            Present time of its steps in [s].

        """
        difference = until - time.monotonic()
        if math.isnan(self._ahead) or abs(difference - self._ahead) > _JUMP:
            self._ahead = difference
        self._ahead += _NEWEST * (difference - self._ahead)
        sightings = self.film.drain() if self.film is not None else []
        if isinstance(simulator, FilmedTree):
            for seen in sightings:
                simulator.film(seen.time + self._ahead, seen.reference, seen.points)
        for name, each in self.sensors.items():
            samples = each.live.drain()
            if not isinstance(simulator, ObservedTree) or name not in simulator.sensors:
                continue
            for sample in samples:
                simulator.offer(
                    name,
                    sample.time + self._ahead,
                    acceleration=sample.acceleration,
                    rate=sample.rate,
                    orientation=sample.orientation,
                )
