# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Numbers, units and directions as instruments write them."""

from __future__ import annotations

import math
from typing import Any

from tree_sway.files.text_file import finite
from tree_sway.files.wind.compass import degrees_of
from tree_sway.files.wind.reading import Reading, Refusal, WindReading

_CALM = 0.05
"""Speed [m/s] up to which a direction may be missing: WindSonics have none below 0.05."""
_LONGEST = 40
"""Length of the longest text that may be a number or a direction."""


def number(value: Any) -> float | None:
    """Return a value of JSON or a text as a finite number; None for any other."""
    if isinstance(value, str):
        return finite(value.strip()[:_LONGEST])
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        found = float(value)
    except OverflowError:
        return None
    return found if math.isfinite(found) else None


def bearing_of(value: Any) -> float | None:
    """Bearing [rad] from degrees, or from a point of the compass such as NNW."""
    degrees = number(value)
    if isinstance(value, str):
        degrees = float(degrees_of([value.strip()[:_LONGEST]])[0])
    return None if degrees is None or not 0.0 <= degrees <= 360.0 else math.radians(degrees)


def reading_of(
    kind: str,
    speed: Any,
    direction: Any,
    *,
    factor: float = 1.0,
    turn: float = 0.0,
    rise: float = 0.0,
    up: float | None = None,
    **fields: Any,
) -> Reading:
    """
    Make a reading of a speed and a direction as they were sent, or the refusal of what is none.

    Parameters
    ----------
    kind
        Sentence or format of the message.
    speed, direction
        Numbers or texts; the direction is None where none is measured, and does not matter in a
        calm.
    factor
        Metres per second in a unit of the speed.
    turn
        Direction of the instrument's north [rad].
    rise, up
        Elevation of the wind [rad], or its vertical component [m/s].
    **fields
        Further ones of `WindReading`.

    """
    value = number(speed)
    if value is None or value < 0.0:
        return Refusal(kind, f"speed is '{str(speed)[:20]}'")
    size = factor * value
    bearing = None if direction is None else bearing_of(direction)
    if bearing is None and direction is not None:
        if size > _CALM:
            return Refusal(kind, f"direction is '{str(direction)[:20]}'")
        bearing = 0.0
    turned = None if bearing is None else (bearing + turn) % math.tau
    rising = size * math.sin(rise) if up is None else up
    return WindReading(kind, size * math.cos(rise), turned, rising, **fields)
