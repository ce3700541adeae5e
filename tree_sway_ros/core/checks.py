"""Checks of numbers that come from outside: one error, with the range, instead of a crash."""

from __future__ import annotations

import math
from typing import SupportsFloat

import numpy as np
from numpy.typing import ArrayLike

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


def three_numbers(name: str, vector: ArrayLike) -> tuple[float, float, float]:
    """
    Return the components of a vector, which may be infinite or not-a-number.

    Parameters
    ----------
    name
        What it is, for the error.
    vector
        Anything of shape (3,).

    Returns
    -------
    tuple of float
        Its three components.

    Raises
    ------
    ParameterError
        If it is not three numbers.

    """
    try:
        x, y, z = np.asarray(vector, dtype=np.float64).tolist()
        return float(x), float(y), float(z)  # lists, of a matrix, are no floats
    except (TypeError, ValueError, OverflowError):
        text = " ".join(repr(vector).split())[:80]
        raise ParameterError(f"{text} is not three numbers", where=name) from None
