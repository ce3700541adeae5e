# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Playout buffer: turns frames that arrive irregularly into smooth motion, as ``static/playout.js``.

States are shown with a short delay, on a curve through them (Catmull & Rom 1974). Where they are
close together the next one is predicted on the parabola of the last three, as a tree has inertia.
"""

from __future__ import annotations

from collections import deque
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.stream.protocol import PAUSED, RESTARTED

_DELAY = 0.15
"""Longest playout delay, and initial delay [s]."""

_YOUNGEST, _CALMS = 0.25, 12.0
"""Time constant of the largest lateness [s]: the age of the connection, at least and at most."""
_DOWN, _UP = 0.05, 0.2
"""Fastest change of the delay, down and up, per time that passes [-]."""
_PREDICTED = 0.03
"""States closer together than this are continued by a predicted one [s]."""
_WINDOW = 30.0
"""Time in which the quickest state gives the offset of the clocks [s]."""
_OTHER_CLOCK = 5.0
"""Change of the offset that is no jitter: the sender has started again [s]."""
_OUT_OF_ORDER = 1.0
"""States older than the newest by less than this are dropped [s]."""
_LONGEST_GAP = 0.5
"""States further apart than this are not joined by a curve [s]."""
_BLEND = 0.4
"""Time over which the motion is blended after such a gap [s]."""
_KEPT = 64
"""Number of states that are kept."""


class Moment(NamedTuple):
    """
    A state at a time.

    Parameters
    ----------
    stamp
        Time by the sender's clock [s].
    coordinates
        Coordinates in their own unit, (m,).
    wind
        Wind, blowing to, in [m/s], (3,).
    flags
        Flags, as in a frame.

    """

    stamp: float
    coordinates: Floats
    wind: Floats
    flags: int = 0


class ClockOffset:
    """
    Difference of two clocks from one-way times.

    Arrival less stamp is offset plus travel, so that the smallest of the last half minute is the
    offset and the shortest travel time.
    """

    def __init__(self) -> None:
        self._least: deque[tuple[float, float]] = deque()

    def add(self, stamp: float, arrival: float) -> None:
        """Add a stamp of the sender's clock and its arrival by the own clock [s]."""
        value = arrival - stamp
        # After a restart of the sender, or a step back of its clock, the clock is a different one.
        if self._least and abs(value - self.value) > _OTHER_CLOCK:
            self._least.clear()
        while self._least and self._least[-1][1] >= value:
            self._least.pop()
        self._least.append((arrival, value))
        while self._least[0][0] < arrival - _WINDOW:
            self._least.popleft()

    @property
    def value(self) -> float:
        """Own clock less the sender's, and shortest travel time [s]; 0 before a stamp."""
        return self._least[0][1] if self._least else 0.0


class Playout:
    """
    The newest states, and interpolation between them.

    Parameters
    ----------
    delay
        Time from a state's stamp to its display, without the shortest travel time [s]; if None,
        the lateness of states within some seconds, and one period more without extrapolation.

    """

    def __init__(self, delay: float | None = None) -> None:
        self.delay = _DELAY if delay is None else delay
        self._adapts = delay is None
        self._spacing = 0.0
        self._jitter = 0.5 * _DELAY
        self._age = _YOUNGEST
        self._ahead = 0.0
        self.clock = ClockOffset()
        self.received = self.late = 0
        """Numbers of states, and of late ones."""
        self._moments: deque[Moment] = deque(maxlen=_KEPT)
        self._shown: Moment | None = None
        self._before: Floats | None = None
        self._blend_from = 0.0

    def clear(self) -> None:
        """Forget every state, for a new tree."""
        self._moments.clear()
        self._before = self._shown = None

    def push(self, moment: Moment, arrival: float) -> None:
        """Add a state that arrived at a time of the own clock [s]."""
        if self._moments:
            gap = moment.stamp - self._moments[-1].stamp
            if -_OUT_OF_ORDER < gap <= 0.0:
                return  # twice, or out of order
            if gap <= 0.0 or gap > _LONGEST_GAP or moment.flags & RESTARTED:
                self._before = None if self._shown is None else self._shown.coordinates
                self._blend_from = arrival
                self._moments.clear()
        self.clock.add(moment.stamp, arrival)
        self.received += 1
        lateness = arrival - moment.stamp - self.clock.value
        self.late += lateness > self.delay + self._ahead
        if self._moments and self._adapts:
            self._adapt(moment.stamp - self._moments[-1].stamp, lateness)
        self._moments.append(moment)

    def _adapt(self, span: float, lateness: float) -> None:
        """Move the delay towards what the connection needs, a time [s] after the last state."""
        self._spacing += 0.1 * (span - self._spacing)
        self._age += span
        calms = min(self._age, _CALMS)  # the first estimate of a connection decays faster
        self._jitter = max(lateness, self._jitter * math.exp(-span / calms))
        self._ahead = self._spacing if self._spacing < _PREDICTED else 0.0
        change = min(self._spacing - self._ahead + self._jitter, _DELAY) - self.delay
        self.delay += min(max(change, -_DOWN * span), _UP * span)

    def sample(self, now: float) -> Moment | None:
        """State to show at a time of the own clock [s]; None before the first."""
        moments = list(self._moments)
        if not moments:
            return self._shown
        if self._ahead and len(moments) > 2 and moments[-1].stamp - moments[-2].stamp < _PREDICTED:
            moments.append(predicted(*moments[-3:]))
        time = now - self.clock.value - self.delay
        newest = len(moments) - 1
        after = next((i for i, each in enumerate(moments) if each.stamp > time), newest)
        end = max(after, min(1, newest))
        begin = max(end - 1, 0)
        a = moments[begin]
        b = moments[end]
        span = b.stamp - a.stamp
        u = min(max((time - a.stamp) / span, 0.0), 1.0) if span > 0.0 else 1.0
        curve = _catmull_rom(moments[max(begin - 1, 0)], a, b, moments[min(end + 1, newest)], u)
        wind = a.wind + u * (b.wind - a.wind)
        stamp = a.stamp + u * span
        self._shown = Moment(stamp, self._blended(curve, now), wind, b.flags & PAUSED)
        return self._shown

    def _blended(self, coordinates: Floats, now: float) -> Floats:
        """Blend from the motion before a gap in the stream."""
        before = self._before
        u = (now - self._blend_from) / _BLEND
        if before is None or u >= 1.0 or before.shape != coordinates.shape:
            self._before = None
            return coordinates
        return before + u * u * (3.0 - 2.0 * u) * (coordinates - before)


def predicted(a: Moment, b: Moment, c: Moment) -> Moment:
    """Extrapolate a, b and c by one period, on their parabola."""
    if not len(a.coordinates) == len(b.coordinates) == len(c.coordinates):
        return c
    span = c.stamp - b.stamp
    before = b.stamp - a.stamp
    step = c.coordinates - b.coordinates
    last_step = (b.coordinates - a.coordinates) * span / before
    values = c.coordinates + step + 2.0 * span / (span + before) * (step - last_step)
    return Moment(c.stamp + span, values, c.wind, c.flags & PAUSED)


def _catmull_rom(a: Moment, b: Moment, c: Moment, d: Moment, u: float) -> Floats:
    """
    Coordinates on the curve through b and c, whose slopes there come from the neighbours.

    Parameters
    ----------
    a, b, c, d
        States in the order of their stamps; at an end of the stream a is b, or d is c.
    u
        Share of the way from b to c, 0 to 1.

    """
    span = c.stamp - b.stamp
    a_to_c = c.stamp - a.stamp
    b_to_d = d.stamp - b.stamp
    u2 = u * u
    u3 = u * u * u
    states = [each.coordinates for each in (a, b, c, d)]
    # There are more coordinates while a branch is pulled.
    p, q, r, s = (each[: min(map(len, states))] for each in states)
    curve = (2.0 * u3 - 3.0 * u2 + 1.0) * q + (3.0 * u2 - 2.0 * u3) * r
    if a_to_c > 0.0:
        curve += (u3 - 2.0 * u2 + u) * span / a_to_c * (r - p)
    if b_to_d > 0.0:
        curve += (u3 - u2) * span / b_to_d * (s - q)
    return np.concatenate([curve, c.coordinates[len(curve) :]])
