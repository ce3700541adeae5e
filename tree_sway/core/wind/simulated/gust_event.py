# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A gust, step or turn of the wind as data: what happens, when, and how often.

Speeds add along the wind in [m/s]; angles turn it about the vertical in [rad], counter-clockwise
seen from above (REP-103). Gusts pass; steps and turns last.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of, within

_LARGEST_SPEED, _LARGEST_ANGLE, _LONGEST = 100.0, 1e3, 1e6


class _Shape(NamedTuple):
    """Share of the amplitude at a share x of the duration; whether it turns the wind, lasts."""

    share: Callable[[Floats], Floats]
    is_turn: bool = False
    lasts: bool = False


_SHAPES = {
    # A 1-cos gust, at its peak halfway: IEC 61400-1:2005, 6.3.2.
    'one_minus_cos': _Shape(lambda x: 0.5 * (1.0 - np.cos(2.0 * np.pi * x))),
    # A dip, a peak of 0.74, a dip: 6.3.2.2, where the amplitude is 3.3 s / (1 + 0.1 D / Lambda1).
    'extreme_operating_gust': _Shape(
        lambda x: -0.37 * np.sin(3.0 * np.pi * x) * (1.0 - np.cos(2.0 * np.pi * x))
    ),
    'step': _Shape(lambda x: x, lasts=True),
    # 6.3.2.4, where the angle is 4 atan(s / (U (1 + 0.1 D / Lambda1))).
    'direction_change': _Shape(lambda x: 0.5 * (1.0 - np.cos(np.pi * x)), True, True),
    'turn': _Shape(lambda x: x, True, True),
}
EVENT_KINDS = tuple(_SHAPES)


@dataclass(frozen=True)
class GustEvent:
    """
    One event of the wind.

    Parameters
    ----------
    kind
        ``one_minus_cos``, ``extreme_operating_gust``, ``step`` (speeds), ``direction_change`` or
        ``turn`` (angles).
    amplitude
        Speed in [m/s], negative for a lull, or angle in [rad]; more than 2 pi goes round.
    duration
        Duration in [s]; of a step the time over which it rises, linearly, which may be 0.
    start
        Time it begins in [s].
    every
        Time after which it happens again in [s], at least `duration`; 0 for once. What lasts
        (step, direction change, turn) goes back every second time.

    Raises
    ------
    ParameterError
        If the kind is unknown or a value is out of its range.

    """

    kind: str
    amplitude: float
    duration: float
    start: float = 0.0
    every: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is out of range, and repeats that overlap."""
        one_of('event', self.kind, EVENT_KINDS)
        largest, unit = (_LARGEST_ANGLE, 'rad') if self.is_turn else (_LARGEST_SPEED, 'm/s')
        within('angle' if self.is_turn else 'amplitude', self.amplitude, -largest, largest, unit)
        within('duration', self.duration, 0.0, _LONGEST, 's', above=self.kind != 'step')
        within('start', self.start, -_LONGEST, _LONGEST, 's')
        if self.every != 0.0:
            within('every', self.every, self.duration, _LONGEST, 's', above=self.duration == 0.0)

    @property
    def is_turn(self) -> bool:
        """Whether it turns the wind, rather than adds to its speed."""
        return _SHAPES[self.kind].is_turn

    def at(self, time: ArrayLike) -> Floats:
        """Return the speed to add in [m/s], or the angle to turn by in [rad], at times in [s]."""
        shape, elapsed = _SHAPES[self.kind], np.asarray(time, dtype=np.float64) - self.start
        cycle = np.maximum(np.floor(elapsed / self.every), 0.0) if self.every else 0.0 * elapsed
        elapsed = elapsed - cycle * self.every
        if self.duration == 0.0:
            share = np.where(elapsed >= 0.0, 1.0, 0.0)
        else:
            share = shape.share(np.clip(elapsed / self.duration, 0.0, 1.0))
        goes_back = shape.lasts & (cycle % 2 == 1)
        return np.asarray(self.amplitude * np.where(goes_back, 1.0 - share, share))


def with_events(
    time: ArrayLike, base: ArrayLike, events: Iterable[GustEvent], bearing_to: float
) -> Floats:
    """
    Add events to a wind: the speeds along the mean wind, then the turns of the whole.

    The wind blows to ENU in [m/s] at times in [s], (n, 3) or (3,); its mean to a bearing clockwise
    from north in [rad].
    """
    wind = np.array(base, dtype=np.float64)
    angle = np.zeros(wind.shape[:-1])
    for event in events:
        if event.is_turn:
            angle = angle + event.at(time)
        else:
            speed = event.at(time)
            wind[..., 0] += speed * np.sin(bearing_to)
            wind[..., 1] += speed * np.cos(bearing_to)
    turned = (wind[..., 0] + 1j * wind[..., 1]) * np.exp(1j * angle)
    wind[..., 0], wind[..., 1] = turned.real, turned.imag
    return wind
