# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Whether the spectrum of a sensor has another shape than in the same wind before.

A tree that loses a limb sways less at the frequencies of the limb, and more at others. So does one
in another wind. The logarithms of the power in narrow bands are therefore a Gaussian process over
frequency and wind (Rasmussen & Williams 2006, *Gaussian Processes for Machine Learning*, 2.2): a
part is the same in all winds, a part increases with the speed, a part is alike in like winds only,
and a part is by chance. What the blocks of motion before foretell for the mean of the last blocks
has an error by this law. For a rise of all bands of a window the most likely size over its error
is ``z = t' S^-1 r / sqrt(t' S^-1 t)``, r the difference, S its covariance and t the window. The
largest of all windows is the change. In winds unlike all of those before, the error is large.

A change is told until the window is again as before it, as surely as it was told.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.setup import one_thread

WATCHED_BAND = (0.5, 8.0)
"""Frequencies over the first one of the tree."""

_RATIO = 1.1
"""Upper over lower edge of a band."""

_INDEPENDENT = 0.75
"""Independent values of an averaged periodogram, over the length times the resolution."""

_LEAST_POWER = 0.3
"""Least power of the sway in a band, over the deviation of the power of noise [-]."""

_LENGTH = 0.15
"""Logarithm of the ratio of frequencies within which a change of the shape is alike."""

_LIKE_SPEED, _LIKE_DIRECTION = 0.3, 0.35
"""Differences of the logarithm of the speed and of the direction [rad] of like winds."""

_LOCAL, _BY_SPEED, _BY_CHANCE = 1.5, 0.4, 0.1
"""
Deviations of the logarithm of the power of a band: alike in like winds, per logarithm of the
speed, and from block to block.

Tried on simulated trees for two hours each: deviations twice as large or half as large change
which limbs are seen little.
"""

_POWER_BY_SPEED = 3.0
"""Exponent of the power of sway over the speed."""

_MOST_PAST = 8
"""Blocks before that are compared, those in the winds that are most alike."""

_WINDOWS = (2, 4, 8)
"""Bands of a window."""

_RECENT = (2, 4, 6)
"""Numbers of last blocks that are compared with those before."""

_LEAST_PAST = 3

_USUAL = 3.0
"""Largest z of a block by chance [-], which is known as by one block."""

CHANGED = 6.0
"""Least z of a change [-]."""


class BandChange(NamedTuple):
    """
    A change of power by a factor from ``low`` to ``high`` [Hz].

    ``size`` is over its error, and ``window`` the number of the window of bands.
    """

    power: float
    low: float
    high: float
    size: float
    window: int = 0


class Block(NamedTuple):
    """
    Logarithms of the power of each band, of east and then of north, (2 k,), and their variances.

    They are over the power that goes with the speed. ``speed`` is the logarithm of that of the
    mean wind in [m/s], ``direction`` its own [rad].
    """

    power: Floats
    variance: Floats
    speed: float
    direction: float


class SpectrumChange:
    """
    Blocks of the spectrum of a sensor, and how the last ones differ.

    Parameters
    ----------
    frequencies
        Frequencies in [Hz], (f,).
    first
        First frequency of the tree in [Hz].

    """

    def __init__(self, frequencies: Floats, first: float) -> None:
        lowest = first * WATCHED_BAND[0]
        highest = min(first * WATCHED_BAND[1], frequencies[-1])
        n_bands = int(math.log(highest / lowest) / math.log(_RATIO))
        self._edges = lowest * _RATIO ** np.arange(n_bands + 1)
        ends = np.searchsorted(frequencies, self._edges).tolist()
        self._bands = [slice(begin, end) for begin, end in pairwise(ends)]
        self._resolution = frequencies[1] - frequencies[0]
        self._same, self._by_speed, self._alike, self._by_chance = _laws(n_bands)
        self._windows = _windows(n_bands)
        self._blocks: list[Block] = []
        self._squares: list[float] = []
        self._told: BandChange | None = None
        self._n_past = 0

    def add(
        self, power: Floats, noise: float, seconds: float, wind: tuple[float, float]
    ) -> BandChange:
        """
        Add a block, and find the largest change.

        Parameters
        ----------
        power
            Mean power of east and north at each frequency, (f, 2).
        noise
            Power of the noise of the sensor at each frequency.
        seconds
            Length of the block in [s].
        wind
            Mean wind to east and north in [m/s].

        Returns
        -------
        BandChange
            The change; its size is 0 where there is no past.

        """
        means, variances = np.zeros((2, 2, len(self._bands)))
        for k, band in enumerate(self._bands):
            within = power[band]
            mean = within.mean(axis=0)
            # A peak within the band has fewer independent values.
            values = np.square(within.sum(axis=0)) / np.square(within).sum(axis=0)
            variance = 1.0 / (_INDEPENDENT * seconds * self._resolution * values)
            least = _LEAST_POWER * np.sqrt(variance) * noise
            sway = np.maximum(mean - noise, np.maximum(least, 1e-300))
            means[:, k] = np.log(sway)
            variances[:, k] = variance * np.square(mean / sway)
        east, north = wind
        speed = math.log(max(math.hypot(east, north), 0.1))
        own = means.ravel() - _POWER_BY_SPEED * speed
        self._blocks.append(Block(own, variances.ravel(), speed, math.atan2(north, east)))
        return self._largest()

    def _largest(self) -> BandChange:
        """Find the largest change of the last blocks."""
        n_blocks = len(self._blocks)
        past = n_blocks - 1 if self._told is None else self._n_past
        last = self._change(past, self._blocks[-1:]).size if past else _USUAL
        self._squares.append((last / _USUAL) ** 2)
        if self._told is not None:
            return self._followed(self._told)
        largest = BandChange(1.0, 0.0, 0.0, 0.0)
        for n_recent in _RECENT:
            first = n_blocks - n_recent
            if first < _LEAST_PAST:
                break
            found = self._over_usual(first, self._change(first, self._blocks[first:]))
            if found.size > max(largest.size, CHANGED):
                self._told, self._n_past = found, first
            largest = max(largest, found, key=lambda each: each.size)
        return largest

    def _over_usual(self, n_past: int, found: BandChange) -> BandChange:
        """Return a change whose size is over that which is usual among the first blocks."""
        usual = (1.0 + sum(self._squares[:n_past])) / (1.0 + n_past)
        return found._replace(size=found.size / math.sqrt(usual))

    def _followed(self, told: BandChange) -> BandChange:
        """Return the change that was told, or what is there now if that is no change."""
        n_recent = _RECENT[0]
        recent = self._blocks[-n_recent:]
        now = self._over_usual(self._n_past, self._change(self._n_past, recent, told.window))
        if now.size > CHANGED:
            return told
        # Its error [-] follows from its size.
        change = math.log(now.power)
        error = abs(change) / max(now.size, 1e-9)
        if abs(change - math.log(told.power)) <= CHANGED * error:
            return told
        self._told = None
        for each in (self._blocks, self._squares):
            del each[self._n_past : -n_recent]
        return now

    def _covariance(self, one: Block, other: Block) -> Floats:
        """Covariance of the logarithms of two blocks, (2 k, 2 k)."""
        alike = math.exp(-0.5 * _unlike(one, other))
        found = self._same + one.speed * other.speed * self._by_speed + alike * self._alike
        if one is other:
            found = found + self._by_chance + np.diag(one.variance)
        return found

    def _change(
        self, n_past: int, recent: Sequence[Block], window: int | None = None
    ) -> BandChange:
        """Compare the mean of some blocks with the first blocks in like winds, in a window."""
        blocks = self._blocks[:n_past]
        blocks.sort(key=lambda each: min(_unlike(each, other) for other in recent))
        past = blocks[:_MOST_PAST]
        with one_thread():
            before = np.block([[self._covariance(a, b) for b in past] for a in past])
            means = [np.mean([self._covariance(a, b) for b in recent], axis=0) for a in past]
            shared = np.vstack(means)
            own = np.mean([self._covariance(a, b) for a in recent for b in recent], axis=0)
            by_past = np.linalg.solve(before, shared).T
            told = np.concatenate([each.power for each in past])
            now = np.mean([each.power for each in recent], axis=0)
            beyond = now - by_past @ told
            covariance = own - by_past @ shared
            weighted = np.linalg.solve(covariance, self._windows.T)
        information = (self._windows.T * weighted).sum(axis=0)
        sizes = beyond @ weighted / np.sqrt(information)
        which = np.abs(sizes).argmax() if window is None else window
        n_bands = len(self._bands)
        bands = np.flatnonzero(self._windows[which]) % n_bands
        low, high = self._edges[[bands.min(), bands.max() + 1]].tolist()
        power = math.exp(sizes[which] / math.sqrt(information[which]))
        return BandChange(power, low, high, abs(sizes[which]), which)


def _unlike(one: Block, other: Block) -> float:
    """How unlike the winds of two blocks are."""
    turned = math.sin(one.direction - other.direction) / _LIKE_DIRECTION
    faster = (one.speed - other.speed) / _LIKE_SPEED
    return turned**2 + faster**2


def _laws(n_bands: int) -> tuple[NDArray[Any], ...]:
    """
    Covariances of the logarithms of the power, (2 k, 2 k) each.

    They are those of the part that is the same in all winds, of that per logarithm of the speed,
    of that alike in like winds, and of that by chance.
    """
    at = math.log(_RATIO) * np.arange(n_bands)
    level = np.ones((n_bands, n_bands))
    slope = np.outer(at, at)
    local = np.exp(-0.5 * np.square((at[:, None] - at) / _LENGTH))
    axes = np.eye(2)
    same = np.kron(axes, 400.0 * level + 9.0 * np.eye(n_bands))
    by_speed = np.kron(axes, 0.09 * level + 0.25 * slope + _BY_SPEED**2 * local)
    by_speed += np.kron(np.ones((2, 2)), level)
    alike = np.kron(axes, level + 0.25 * slope + _LOCAL**2 * local)
    by_chance = np.kron(axes, 0.09 * level + 0.0225 * slope + _BY_CHANCE**2 * local)
    return same, by_speed, alike, by_chance


def _windows(n_bands: int) -> Floats:
    """Return windows of neighbouring bands, of east, of north and of both, (w, 2 k)."""
    found = []
    for width in (min(each, n_bands) for each in _WINDOWS):
        for begin in range(n_bands - width + 1):
            window = np.zeros(n_bands)
            window[begin : begin + width] = 1.0
            found += [np.kron(axes, window) for axes in ((1, 0), (0, 1), (1, 1))]
    return np.array(found)
