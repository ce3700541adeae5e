# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A number type that counts what is done with it, and the form of a kernel that it can run.

Additions, subtractions and multiplications count 1; divisions and square roots 4, as in the
Livermore loops (McMahon 1986); sines, cosines and exponentials 20, a polynomial and its range
reduction in double precision. Comparisons, signs and absolute values are free.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
import math
from types import FunctionType
from typing import Any

import numpy as np
from numpy.typing import NDArray

WEIGHTS = {'add': 1, 'multiply': 1, 'divide': 4, 'sqrt': 4, 'transcendental': 20}


class CountedNumber:
    """A float that reports every operation to the tally it was made with."""

    __slots__ = ('tally', 'value')

    def __init__(self, value: float, tally: Counter[str]) -> None:
        self.value = float(value)
        self.tally = tally

    def _make(self, kind: str, value: float) -> CountedNumber:
        self.tally[kind] += 1
        return CountedNumber(value, self.tally)

    def __add__(self, other: Any) -> CountedNumber:
        return self._make('add', self.value + float(other))

    def __sub__(self, other: Any) -> CountedNumber:
        return self._make('add', self.value - float(other))

    def __rsub__(self, other: Any) -> CountedNumber:
        return self._make('add', float(other) - self.value)

    def __mul__(self, other: Any) -> CountedNumber:
        return self._make('multiply', self.value * float(other))

    def __truediv__(self, other: Any) -> CountedNumber:
        return self._make('divide', self.value / float(other))

    def __rtruediv__(self, other: Any) -> CountedNumber:
        return self._make('divide', float(other) / self.value)

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self) -> CountedNumber:
        return CountedNumber(-self.value, self.tally)

    def __abs__(self) -> CountedNumber:
        return CountedNumber(abs(self.value), self.tally)

    def sqrt(self) -> CountedNumber:
        """Square root, found by `numpy.sqrt`."""
        return self._make('sqrt', math.sqrt(self.value))

    def sin(self) -> CountedNumber:
        """Sine, found by `numpy.sin`."""
        return self._make('transcendental', math.sin(self.value))

    def cos(self) -> CountedNumber:
        """Cosine, found by `numpy.cos`."""
        return self._make('transcendental', math.cos(self.value))

    def __float__(self) -> float:
        return self.value

    def __eq__(self, other: object) -> bool:
        return self.value == float(other)  # type: ignore[arg-type]

    def __lt__(self, other: Any) -> bool:
        return self.value < float(other)

    def __le__(self, other: Any) -> bool:
        return self.value <= float(other)

    def __gt__(self, other: Any) -> bool:
        return self.value > float(other)

    def __ge__(self, other: Any) -> bool:
        return self.value >= float(other)

    __hash__ = None  # type: ignore[assignment]


def counted(values: Any, tally: Counter[str]) -> NDArray[Any]:
    """Array of counted numbers of the same shape."""
    wrap = np.frompyfunc(lambda value: CountedNumber(value, tally), 1, 1)
    return np.asarray(wrap(np.asarray(values, dtype=float)), dtype=object)


def flops(tally: Counter[str]) -> int:
    """Weighted sum of a tally."""
    return sum(WEIGHTS[kind] * times for kind, times in tally.items())


def plain(function: Callable[..., Any], _done: dict[Any, Any] | None = None) -> Callable[..., Any]:
    """Return a kernel and all that it calls as plain Python that takes any number type."""
    done = {} if _done is None else _done
    source = getattr(function, 'py_func', function)
    if source in done:
        return done[source]  # type: ignore[no-any-return]
    scope = dict(source.__globals__)
    twin = FunctionType(source.__code__, scope, source.__name__, source.__defaults__)
    done[source] = twin
    for name in source.__code__.co_names:
        if hasattr(scope.get(name), 'py_func'):
            scope[name] = plain(scope[name], done)
    return twin
