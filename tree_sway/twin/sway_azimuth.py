# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Which way a sensor faces, from its lean in slow gusts and from the ellipse of its sway.

The wind that is known tells some of the slow lean, x, which reaches a sensor, y, turned by an
angle and less of it the faster. The rest n is that of gusts which the anemometer does not meet::

    R(angle) y(f) = b exp(-a |f|) x(f) + n(f)

Gusts load a tree by ``2 U u`` along the mean wind and by ``U v`` across it, so that n is an
ellipse, the longer axis of which the mean lean of the model tells: G G' + (k - 1) l l', where G is
the lean per load to east and north, and l that in the mean wind. It tells an axis whatever the
distance of the anemometer; x tells which of its ends is which.

So does the skewness of the lean: a load by the square of the wind leans a tree farther downwind of
its mean than upwind of it, and gusts near a canopy are skewed the same way (Raupach, Finnigan &
Brunet 1996, Boundary-Layer Meteorology 78, 351-382).

The covariance of n in a band of frequencies is taken to be of a Wishart distribution about that
ellipse (Gupta & Nagar 2000, *Matrix Variate Distributions*, 3.4), of any size, so that a tree
whose own ellipse is another is not sure of a wrong angle. The probabilities of angles are sums
over all a and b.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Complexes, Floats, Ints
from tree_sway.twin.waves import power_of, way_in

_EDGES = (0.0, 0.06, 0.12, 0.25, 0.45, 0.75, 1.4)
"""Edges of the bands, over the first frequency [-]."""

_LONGER = 4.0
"""Power of the load of gusts along the mean wind over that across it, k [-]."""

_KNOWN = 5.0
"""How well the ellipse is known, as that of so many lines of a spectrum."""

_LOSSES = (0.0, 5.0, 20.0)
_GAINS = {0.0: 1.0, 0.25: 2.0, 0.5: 3.0, 1.0: 4.0, 2.0: 2.0}
"""
Values of a in [s], and of b with their weights [-]: a sensor whose lean has nothing of the wind
has both ends of its axis, and all that are right are found later the more that counts.
"""

_SKEWED = 1.8
"""
Logarithm of the likelihood of an angle by a skewness along the mean lean of 1, which is the most
that counts: on 17 trees of the laboratory it is 0.4, with a deviation of 0.5 over 30 to 120 s.
"""

_ANGLES = np.radians(np.arange(-180.0, 180.0, 4.0))
_TURNS = np.array([[np.cos(_ANGLES), -np.sin(_ANGLES)], [np.sin(_ANGLES), np.cos(_ANGLES)]])
"""Turns by these angles, (2, 2, a)."""

_WIDTH, _LEAST_WIDTH = 0.3, 4
_MOST_NOISE, _LEAST_NOISE = 0.95, 0.01
_LEAST_ERROR = 0.03
"""Least error of an angle [rad], half a step of the angles."""


class Sway(NamedTuple):
    """
    What is known of the sway of a place.

    ``bend`` is its lean per load to east and north, of any unit, (2, 2), ``frequency`` the first
    one of the tree [Hz], and ``dt`` a step [s].
    """

    bend: Floats
    frequency: float
    dt: float

    @property
    def period(self) -> int:
        """Steps in a period of the first sway."""
        return max(round(1.0 / (self.frequency * self.dt)), 1)


def sway_azimuth(moved: Floats, model: Floats, noise: float, sway: Sway) -> tuple[float, float]:
    """
    Find the angle from east to north by which a motion is to be turned, and its error [rad].

    Motions are leans to east and north, of the sensor and of the model from its rest, (n, 2);
    ``noise`` is the deviation of that of the sensor.
    """
    lean = model.mean(axis=0)
    found = _by_bands(_bands(moved, model, noise, sway), _ellipse(sway.bend, lean))
    ways = np.einsum('ija,i->ja', _TURNS, lean)
    found += _SKEWED * _skewness(moved, ways, sway)
    weights = np.array(list(_GAINS.values()))
    chance = np.einsum('ija,j->a', np.exp(found - found.max()), weights)
    chance /= chance.sum()
    best = float(_ANGLES[np.argmax(chance)])
    away = _between(_ANGLES, best)
    near = chance * (np.abs(away) < 0.5 * np.pi)
    best += float(near @ away / near.sum())
    variance = chance @ np.square(_between(_ANGLES, best))
    return best, math.hypot(_LEAST_ERROR, math.sqrt(variance))


class _Band(NamedTuple):
    """
    Lines of the spectra of two motions in a band, over the deviation of the sensor's near each.

    ``hertz`` is (n, 1), lines of the sensor and of the model are (n, 2); ``noisy`` is the share of
    noise in the power of the sensor.
    """

    hertz: Floats
    sensor: Complexes
    model: Complexes
    noisy: float


def _bands(moved: Floats, model: Floats, noise: float, sway: Sway) -> Iterator[_Band]:
    count = len(moved)
    seconds = count * sway.dt
    fade = 0.5 - 0.5 * np.cos(np.pi * way_in(count)[:, None])
    most = int(_EDGES[-1] * sway.frequency * seconds)
    lines = np.arange(1, min(most, count // 2) + 1)
    y, x = (
        np.fft.rfft(fade * (each - each.mean(axis=0)), axis=0)[lines] for each in (moved, model)
    )
    power = _smoothed(power_of(y).sum(axis=1), lines)
    share = 2.0 * noise**2 * np.square(fade).sum() / power
    size = np.sqrt(power)[:, None]
    edges = np.searchsorted(lines, np.array(_EDGES) * sway.frequency * seconds, 'right')
    noisy = np.clip(share, _LEAST_NOISE, _MOST_NOISE)
    for first, last in pairwise(edges.tolist()):
        if first < last:
            rows = slice(first, last)
            hertz = lines[rows, None] / seconds
            yield _Band(hertz, y[rows] / size[rows], x[rows] / size[rows], noisy[rows].mean())


def _smoothed(power: Floats, lines: Ints) -> Floats:
    """Mean power of the lines near each, (n,)."""
    sums = np.concatenate([[0.0], np.cumsum(power)])
    width = np.maximum(_LEAST_WIDTH, _WIDTH * lines).astype(int)
    first = np.maximum(lines - 1 - width, 0)
    last = np.minimum(lines + width, len(lines))
    return np.maximum((sums[last] - sums[first]) / (last - first), 1e-300)


def _by_bands(bands: Iterator[_Band], ellipse: Floats) -> Floats:
    """Logarithm of the likelihood by a, b and the angle, (losses, gains, a), of all bands."""
    found = np.zeros((len(_LOSSES), len(_GAINS), len(_ANGLES)))
    for hertz, y, x, share in bands:
        n = len(hertz)
        whitened = np.linalg.inv((1.0 - share) * ellipse + 0.5 * share * np.eye(2))
        own = np.einsum('ija,jk,lka->ila', _TURNS, _products(y, y), _TURNS)
        own += _LEAST_NOISE**2 * n * np.eye(2)[..., None]
        for i, loss in enumerate(_LOSSES):
            told = x * np.exp(-loss * hertz)
            shared = np.einsum('ija,jk->ika', _TURNS, _products(y, told))
            shared = shared + shared.swapaxes(0, 1)
            alone = _products(told, told)[..., None]
            for j, gain in enumerate(_GAINS):
                left = own - gain * shared + gain**2 * alone
                trace = np.einsum('ij,ija->a', whitened, left)
                size = left[0, 0] * left[1, 1] - left[0, 1] ** 2
                found[i, j] += _of_any_size(trace, size * np.linalg.det(whitened), n)
    return found


def _between(angles: Floats, angle: float) -> Floats:
    """Angles from another one, between -pi and pi [rad]."""
    return np.angle(np.exp(1j * (angles - angle)))


def _ellipse(bend: Floats, lean: Floats) -> Floats:
    """Return the expected covariance of the lean, of trace 1, by the mean lean, (2, 2)."""
    load = float(np.linalg.norm(np.linalg.pinv(bend, rcond=0.05) @ lean))
    along = lean / max(load, 1e-300)
    found = bend @ bend.T + (_LONGER - 1.0) * np.outer(along, along)
    return found / max(np.trace(found), 1e-300)


def _skewness(moved: Floats, ways: Floats, sway: Sway) -> Floats:
    """Skewness of a lean (n, 2) along some ways (2, a), -1 to 1, (a,); spikes do not count."""
    n_periods = len(moved) // sway.period
    slow = np.median(moved[: n_periods * sway.period].reshape(-1, sway.period, 2), axis=1)
    along = (slow - slow.mean(axis=0)) @ ways
    size = np.maximum(np.square(along).mean(axis=0), 1e-100) ** 1.5
    return np.clip((along**3).mean(axis=0) / size, -1.0, 1.0)


def _products(one: Complexes, other: Complexes) -> Floats:
    """Sum the products of lines, (2, 2)."""
    return (one.T @ other.conj()).real


def _of_any_size(trace: Floats, det: Floats, n: int) -> Floats:
    """
    Logarithm of the likelihood of the products of n lines over those expected, of any size.

    It is ``2 k ln s - (n + k) ln (s^2 + s trace + det)`` at the likeliest size s, k = `_KNOWN`.
    """
    det = np.maximum(det, 1e-9 * np.square(trace))
    less = (n - _KNOWN) * trace
    size = (np.sqrt(np.square(less) + 16.0 * _KNOWN * n * det) - less) / (4.0 * n)
    square = np.square(size) + size * trace + det
    return 2.0 * _KNOWN * np.log(size) - (n + _KNOWN) * np.log(square)
