# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Going over from a steady wind into a curve: a mix of the two, and so never beyond them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

from tree_sway.core.wind.curve import Vector, WindCurve


@dataclass(frozen=True)
class Fade:
    """A mix of a steady wind and a curve [m/s], its share 0 to 1 from ``start`` to ``end`` [s]."""

    before: Vector
    start: float
    end: float

    def later(self, delay: float) -> Fade:
        """Return the same fade, later by a delay in [s]."""
        return replace(self, start=self.start + delay, end=self.end + delay)

    def value(self, curve: WindCurve, time: float) -> Vector:
        """Return the mix at a time in [s]."""
        return curve.value(time) if time >= self.end else self._mixed(curve.value(time), time)

    def mean(self, curve: WindCurve, start: float, end: float) -> Vector:
        """Return the exact mean of the mix over an interval in [s], ``start < end``."""
        if start >= self.end:
            return curve.mean(start, end)
        x = y = z = 0.0
        bounds = (start, *(t for t in (self.start, self.end) if start < t < end), end)
        for since, until in pairwise(bounds):
            first, last = self._share(since), self._share(until)
            cx, cy, cz = curve.mean(since, until, (first, last))
            rest, span = 1.0 - 0.5 * (first + last), (until - since) / (end - start)
            x += span * (rest * self.before[0] + cx)
            y += span * (rest * self.before[1] + cy)
            z += span * (rest * self.before[2] + cz)
        return x, y, z

    def _share(self, time: float) -> float:
        if time >= self.end:
            return 1.0
        return max(0.0, (time - self.start) / (self.end - self.start))

    def _mixed(self, value: Vector, time: float) -> Vector:
        share = self._share(time)
        x, y, z = (b + share * (v - b) for b, v in zip(self.before, value, strict=True))
        return x, y, z
