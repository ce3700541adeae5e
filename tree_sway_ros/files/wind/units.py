"""Units and conventions that wind files come in, to m/s, blowing to, east, north, up."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.errors import ParameterError

Velocity = tuple[float, float, float]

SPEED_UNITS = {
    "m/s": 1.0, "ms": 1.0, "mps": 1.0, "ms-1": 1.0, "m s-1": 1.0, "m s^-1": 1.0,
    "meters/second": 1.0, "metres/second": 1.0, "cm/s": 0.01,
    "km/h": 1.0 / 3.6, "kmh": 1.0 / 3.6, "kph": 1.0 / 3.6,
    "kn": 1852.0 / 3600.0, "kt": 1852.0 / 3600.0, "kts": 1852.0 / 3600.0,
    "knot": 1852.0 / 3600.0, "knots": 1852.0 / 3600.0,
    "mph": 0.44704, "miles/hour": 0.44704, "ft/s": 0.3048,
}  # fmt: skip
"""Units of speed in [m/s]."""

TIME_UNITS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0,
              "h": 3600.0}  # fmt: skip
"""Units of time in [s]."""

ANGLE_UNITS = {"deg": pi / 180.0, "degrees": pi / 180.0, "degree": pi / 180.0, "°": pi / 180.0,
               "degm": pi / 180.0, "degt": pi / 180.0, "rad": 1.0, "radians": 1.0}  # fmt: skip
"""Units of angle in [rad]."""


def check_convention(direction_convention: str) -> None:
    """Raise a ParameterError unless the convention is ``to`` or ``from``."""
    if direction_convention not in ("to", "from"):
        raise ParameterError(
            f"direction_convention is '{direction_convention}'", cure="use 'to' or 'from'"
        )


def from_bearing(speed: float, bearing: float, direction_convention: str = "from") -> Velocity:
    """
    Velocity from a speed and a compass bearing.

    Parameters
    ----------
    speed
        Speed in [m/s].
    bearing
        Clockwise from north in [rad].
    direction_convention
        ``from``: where the wind comes from, as meteorology says it; ``to``: where it blows.

    """
    sign = -1.0 if direction_convention == "from" else 1.0
    return sign * speed * sin(bearing), sign * speed * cos(bearing), 0.0


def turned(velocity: Floats, yaw: float, direction_convention: str = "to") -> Floats:
    """
    Velocities from a sensor's axes to east, north, up.

    Parameters
    ----------
    velocity
        In the sensor's axes, z up, in [m/s], (n, 3).
    yaw
        From east to the sensor's x axis, counter-clockwise seen from above, in [rad].
    direction_convention
        ``to`` if the components are positive where the wind blows, ``from`` if where it comes from.

    """
    sign = -1.0 if direction_convention == "from" else 1.0
    c, s = cos(yaw), sin(yaw)
    rotation = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(sign * velocity @ rotation, dtype=np.float64)


def degrees_to_bearing(degrees: float) -> float | None:
    """Bearing in [rad] from degrees in [0, 360]; None if outside, as a sensor's error value is."""
    return radians(degrees) if 0.0 <= degrees <= 360.0 else None
