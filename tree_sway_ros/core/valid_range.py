"""One check for numbers that must lie in a range."""

from __future__ import annotations

import math
from typing import SupportsFloat

from tree_sway_ros.errors import ParameterError


def within(
    name: str,
    value: SupportsFloat,
    low: float,
    high: float,
    unit: str = "",
    *,
    above: bool = False,
) -> float:
    """
    Return a number if it lies in a closed range.

    Parameters
    ----------
    name
        Name of the parameter, for the error.
    value
        The number.
    low, high
        The range; not-a-number lies in none.
    unit
        Unit of the range, for the error.
    above
        Refuse `low` itself too.

    Returns
    -------
    float
        The number.

    Raises
    ------
    ParameterError
        If it lies outside, or is no number.

    """
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not (low <= number <= high) or (above and number == low):
        lower = f"above {low:g}, up to" if above else f"{low:g} to"
        cure = f"use {lower} {high:g} {unit}".rstrip()
        raise ParameterError(f"{value!r} is out of range", where=name, cure=cure)
    return number
