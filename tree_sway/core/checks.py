# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Checks of numbers that come from outside: one error, with the range, instead of a crash."""

from __future__ import annotations

from collections.abc import Collection
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.errors import nearest, ParameterError


def number_of(name: str, value: object) -> float:
    """
    Return a number, which may be infinite or not-a-number.

    A `ParameterError` refuses text, arrays and other kinds of values.
    """
    number = _float_of(value)
    if number is None:
        cure = 'give a number, without quotes'
        raise ParameterError(f'{value!r} is not a number', where=name, cure=cure)
    return number


def _float_of(value: Any) -> float | None:
    """Return a number; not-a-number beyond the range of floats, None for other kinds of values."""
    if isinstance(value, float):
        return value
    try:
        return None if isinstance(value, str | bytes) or np.ndim(value) else float(value)
    except OverflowError:
        return math.nan
    except (TypeError, ValueError):
        return None


def within(
    name: str,
    value: object,
    low: float,
    high: float,
    unit: str = '',
    *,
    above: bool = False,
) -> float:
    """
    Return a number if it lies in a closed range; not-a-number lies in none.

    ``above`` refuses the low end itself too. A `ParameterError` gives name, value, range and unit,
    or names what is no number.
    """
    number = _float_of(value)
    if number is None or not low <= number <= high or (above and number == low):
        fault = 'is not a number' if number is None else 'is out of range'
        if math.isinf(high):
            allowed = f'above {low:g}' if above else f'at least {low:g}'
        else:
            allowed = f'above {low:g}, up to {high:g}' if above else f'{low:g} to {high:g}'
        cure = f'use {allowed} {unit}'.rstrip()
        raise ParameterError(f'{value!r} {fault}', where=name, cure=cure)
    return number


def whole(name: str, value: object, low: int, high: int) -> int:
    """Return a whole number in a closed range; a `ParameterError` refuses fractions and truths."""
    number = math.nan if isinstance(value, bool | np.bool_) else within(name, value, low, high)
    if not number.is_integer():
        cure = f'use a whole number from {low} to {high}'
        raise ParameterError(f'{name} of {value}', where=name, cure=cure)
    return int(number)


GREATEST = 1e18
"""Bound of the numbers of a model, a state and a description, in SI: no tree comes near it."""
LONGEST_STEP = 0.5
"""Longest step of a simulator [s]; a stall beyond it is skipped, or solved in several steps."""


def refuse_time_step(dt: float, longest: float = LONGEST_STEP) -> None:
    """Refuse a time step [s] that is not above 0, longer than the longest, or not finite."""
    if not (0.0 < number_of('step', dt) <= longest and math.isfinite(dt)):
        limit = f' and up to {longest:g} s: take several for more' if longest < math.inf else ''
        raise ParameterError(
            f'time step of {dt} s', where='step', cure=f'give a finite one above 0{limit}'
        )


def refuse_other_kind(name: str, value: object, kind: type, cure: str) -> None:
    """Refuse a value of another type than the expected one."""
    if not isinstance(value, kind):
        what = f'a {type(value).__name__}, where a {kind.__name__} is expected'
        raise ParameterError(what, where=name, cure=cure)


def refuse_named_columns(name: str, values: object) -> None:
    """Refuse a data frame: which of its columns is which would be guessed by their order."""
    if (columns := getattr(values, 'columns', None)) is not None:
        names = ', '.join(map(str, columns))
        cure = 'give numbers, such as frame[["x", "y", "z"]].to_numpy(), in SI units'
        raise ParameterError(f'a table of {names:.80}', where=name, cure=cure)


def one_of(name: str, value: object, known: Collection[object]) -> None:
    """Refuse a value that is not known; a `ParameterError` names those that are."""
    if value not in known:
        near = nearest(str(value), [str(each) for each in known])
        cure = f'{near} use one of: {", ".join(map(str, known))}'.lstrip()
        raise ParameterError(f"unknown {name} '{value}'", cure=cure)


def three_numbers(name: str, vector: ArrayLike) -> tuple[float, float, float]:
    """
    Return the three components of a vector, which may be infinite or not-a-number.

    A `ParameterError` reports other values than three numbers.
    """
    try:
        numbers: Any = vector
        if isinstance(vector, np.ndarray):
            numbers = vector.tolist()
        elif isinstance(vector, str | bytes):
            raise ValueError
        x, y, z = numbers
        return float(x), float(y), float(z)  # lists, of a matrix, are no floats
    except (TypeError, ValueError, OverflowError):
        text = ' '.join(repr(vector).split())[:80]
        raise ParameterError(
            f'{text} is not three numbers', where=name, cure='give x, y and z'
        ) from None


def array_to_fill(name: str, array: object, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """
    Return an array if native code can write all of a shape into it.

    Native code checks no bounds: a short array would be written past its end. Raises a
    `ParameterError` for no array of float64 in the machine's own order, of that shape, whole in
    one piece of memory, row after row, and free to be written.
    """
    found = f'a {type(array).__name__}'
    if isinstance(array, np.ndarray):
        if array.dtype == np.float64 and array.shape == shape and array.flags.carray:
            return array
        found = f'an array of {array.dtype} and shape {array.shape}, or spread or read-only,'
    raise ParameterError(
        f'{found} cannot be filled', where=name, cure=f'give np.empty({shape}) or nothing'
    )


def array_to_read(name: str, values: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """
    Return numbers as native code reads them: float64, in one piece, and as many as it will read.

    Raises a `ParameterError` for a wrong shape, or other values than numbers.
    """
    try:
        numbers = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError('not all are numbers', where=name) from None
    if numbers.shape != shape:
        raise ParameterError(
            f'an array of shape {numbers.shape}', where=name, cure=f'give one of shape {shape}'
        )
    return numbers


def one_of_each(name: str, values: ArrayLike, count: int, what: str) -> NDArray[np.float64]:
    """
    Return a number for each thing, (count,), none of them negative.

    Raises a `ParameterError` for another shape, or a number that is negative or not finite.
    """
    numbers = array_to_read(name, values, (count,))
    bad = np.flatnonzero(~(np.isfinite(numbers) & (numbers >= 0.0)))
    if len(bad):
        raise ParameterError(
            f'{numbers[bad[0]]} of {what} {bad[0]}',
            where=name,
            cure='give finite numbers, 0 or more',
        )
    return numbers
