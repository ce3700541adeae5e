# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A wind reading, or the refusal of one, from a message of an instrument."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math

from tree_sway.core.wind import velocity_of_bearing

Velocity = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class WindReading:
    """
    A measured wind.

    Parameters
    ----------
    kind
        Sentence or format of the message.
    speed
        Horizontal speed [m/s].
    bearing
        Direction that it comes from, clockwise from north [rad]; None where it is not measured.
    up
        Vertical component [m/s].
    gust
        Largest speed in the interval [m/s]; None where it is not reported.
    interval
        Length of time of a mean [s]; 0 for the wind of an instant, None where it is not known.
    time
        Time of the measurement since 1970 [s]; None for that of its arrival.
    place
        Name of the station, where the message has it.
    sender
        What the message says of the instrument that it is of, as its serial number.
    assumed
        What was assumed of it, and how to change that; empty if nothing was.

    """

    kind: str
    speed: float
    bearing: float | None = None
    up: float = 0.0
    gust: float | None = None
    interval: float | None = None
    time: float | None = None
    place: str = ''
    sender: str = ''
    assumed: str = ''

    def velocity(self, bearing: float) -> Velocity:
        """
        Velocity east, north, up [m/s], the way the air goes.

        ``bearing`` is the direction that it comes from where none was measured [rad].
        """
        used = bearing if self.bearing is None else self.bearing
        x, y, _ = velocity_of_bearing(self.speed, used)
        return x, y, self.up


@dataclass(frozen=True, slots=True)
class Refusal:
    """A message about the wind that cannot be used, of a kind, and the reason."""

    kind: str
    reason: str


Reading = WindReading | Refusal
Readings = Sequence[Reading]


def of_velocity(kind: str, velocity: Velocity) -> WindReading:
    """Make a reading of a velocity east, north, up [m/s], the way the air goes."""
    east, north, up = velocity
    bearing = math.atan2(-east, -north) % math.tau
    return WindReading(kind, math.hypot(east, north), bearing, up, interval=0.0)
