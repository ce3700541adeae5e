# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stiffness and damping of the real tree, from the wind and the motion of its sensors.

A candidate is the model with other stiffness and damping. The force of the known wind on it gives
a motion Y0 of each sensor, up to a factor a for its drag; what is beyond has the spectrum S of the
candidate under unknown forces, up to its level and to how fast gusts weaken with the frequency.
The most likely candidate has the largest p (Whittle 1953, Arkiv för Matematik 2, 423-434)::

    -ln p = sum over frequencies of  ln S(f) + |Y(f) - a Y0(f)|^2 / S(f)

with the mean over stretches of the record (Welch 1967, IEEE Transactions on Audio and
Electroacoustics 15, 70-73). Level and a are those of highest likelihood. Stiffness and damping
have spreads of their own before anything is measured: those of wood within a species, and of
damping among trees. The result is a mean over a grid of both, weighted by the likelihood.

The noise of a sensor is part of S: without it, the flat spectrum of a calm is that of a tree whose
damping is large. One stretch of time is fitted after another, each with the air and the leaves of
its own. What is known from those before goes on, but for a little that the stiffness changes from
one to the next: wet leaves make a tree as slow as soft wood does.

The phase between wind and motion tells a frequency far better than the height of a spectrum. Where
the anemometer is so far away that its wind explains nothing, a is zero and the spectrum remains.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Complexes, Floats
from tree_sway.core.drag import DRAG
from tree_sway.core.setup import one_thread

_STIFFNESS_SPREAD, _DAMPING_SPREAD = 0.2, 0.5
"""Standard deviations of the logarithms of stiffness and damping, before any measurement."""

_ODD, _UNSURE = 3.0, 1.5
"""
Deviations of stiffness and damping from which a tree is none of its species, and error of the
stiffness over its spread from which what is told does not fit together.
"""

_STIFFNESSES = np.geomspace(0.5, 1.8, 53)
_DAMPINGS = np.geomspace(0.35, 3.0, 9)
_SLOPES = np.array([0.0, 1.0, 2.0, 3.0])
N_CANDIDATES = len(_STIFFNESSES) * len(_DAMPINGS)
"""Number of candidates of a fit."""

_MOST_DRAG = 2.0
_LEAST_DRAG = 0.2

_GUST_ERROR = 0.15
"""Error of the drag, of its logarithm, for gusts at the anemometer are not those of the crown."""

_LEAST = 1e-4
"""Least variance of a pattern of static bends that counts, over the largest [-]."""

_LEAST_SWAY = 1e-3
"""Least power of the sway over all that is measured [-]."""

_INDEPENDENT = 0.02
"""
Independent values in an averaged periodogram over all.

Hann windows that overlap by half have 0.6. The rest is for what the spectrum of a candidate lacks:
with 0.6, fits missed the known stiffness of made-up trees by 2.4 of their stated errors (root mean
square over 22 fits of six kinds of tree), and with 0.1 that of trees beside a mast by up to 7.
"""


class TreeFit(NamedTuple):
    """
    Factors on stiffness, damping and drag of the model, their errors, and the hours behind.

    The errors are standard deviations; ``hours`` the length of the motion.
    """

    stiffness: float
    damping: float
    stiffness_error: float
    damping_error: float
    drag: float
    drag_error: float
    hours: float

    @property
    def is_odd(self) -> bool:
        """Whether no tree of the species sways so: as the one of another sensor's tree."""
        beyond = math.hypot(
            math.log(self.stiffness) / _STIFFNESS_SPREAD, math.log(self.damping) / _DAMPING_SPREAD
        )
        # Less is known than before where two tell of different trees, such as place and frequency.
        return beyond > _ODD or self.stiffness_error > _UNSURE * _STIFFNESS_SPREAD

    def __str__(self) -> str:
        stiffer = f'{self.stiffness:.2g} times (+- {self.stiffness_error:.2g}) as stiff'
        return f'{stiffer}, {self.damping:.2g} times as damped'


class Spectrum(NamedTuple):
    """
    A measured spectrum, and the sensor's rows on displacement, rate and force, (3, 3 m).

    ``products`` are those of `SensorSpectrum` at circular frequencies (f,), averaged over a number
    of stretches, from an amount of motion in [s]. ``noise`` is the power of the sensor's noise at
    each of them, of one axis.
    """

    rows: Floats
    products: Complexes
    circular: Floats
    n_stretches: int
    seconds: float
    noise: float = 0.0


class Known(NamedTuple):
    """
    What is known from motion of an amount in [s].

    ``chances`` are those of each stiffness and damping, (s, d). ``drag`` is the information on the
    logarithm of the drag, and that times the logarithm.
    """

    chances: Floats
    drag: tuple[float, float]
    seconds: float

    def later(self) -> Known:
        """Return what is left of it for motion that comes later."""
        beside = np.pad(self.chances, ((1, 1), (0, 0)), 'edge')
        return self._replace(chances=(beside[:-2] + beside[1:-1] + beside[2:]) / 3.0)


def _known_before() -> Known:
    """Return what is known of trees of a species before any measurement."""
    stiffness = np.log(_STIFFNESSES) / _STIFFNESS_SPREAD
    damping = np.log(_DAMPINGS) / _DAMPING_SPREAD
    unlikely = np.square(stiffness)[:, None] + np.square(damping)
    return Known(np.exp(-0.5 * unlikely), (0.0, 0.0), 0.0)


def fit_of(
    spectra: Sequence[Spectrum],
    stiffness: Floats,
    damping: Floats,
    air_damping: Floats,
    covariance: Floats,
    drag: float = 1.0,
    before: Known | None = None,
) -> tuple[TreeFit, Known]:
    """
    Try all candidates on all sensors; return what is known then, too.

    Parameters
    ----------
    spectra
        Spectra of the sensors.
    stiffness, damping, air_damping
        Stiffness [1/s^2] and damping [1/s] of wood and air of the coordinates, (m,).
    covariance
        Covariance of the unknown forces, (m, m).
    drag
        Factor on the damping by the air, as the drag of the last fit.
    before
        What is known from earlier motion; that of the species if None.

    """
    before = before or _known_before()
    bends, sizes = _patterns(covariance, stiffness)
    sensors = [_Misfit(each, bends * sizes, stiffness) for each in spectra]
    table = np.zeros((len(_STIFFNESSES), len(_DAMPINGS), len(_SLOPES)))
    # Information on the logarithm of the drag, and that times the logarithm.
    told = np.zeros((2, *table.shape))
    for i, stiff in enumerate(_STIFFNESSES.tolist()):
        for j, damped in enumerate(_DAMPINGS.tolist()):
            # A damping ratio that stays is a damping that goes with the root of the stiffness.
            damping_there = damped * math.sqrt(stiff) * damping + drag * air_damping
            for each in sensors:
                with one_thread():
                    misfit, drags, known = each.of(stiff, damping_there)
                table[i, j] += misfit
                told[0, i, j] += known
                told[1, i, j] += known * np.log(np.maximum(drags, _LEAST_DRAG))
    likelihood = np.exp(table.min() - table)
    chances = before.chances * likelihood.sum(axis=2)
    chances /= chances.sum()
    weight = before.chances[..., None] * likelihood
    found = (told * weight).reshape(2, -1).sum(axis=1) / weight.sum()
    information, weighted = (found + before.drag).tolist()
    seconds = before.seconds + max(each.seconds for each in spectra)
    stiffer, stiffness_error = _mean(np.log(_STIFFNESSES), chances.sum(axis=1))
    more_damped, damping_error = _mean(np.log(_DAMPINGS), chances.sum(axis=0))
    dragged, drag_error = _drag(information, weighted)
    fit = TreeFit(
        math.exp(stiffer),
        math.exp(more_damped),
        stiffness_error,
        damping_error,
        math.exp(dragged),
        drag_error,
        seconds / 3600.0,
    )
    return fit, Known(chances, (information, weighted), seconds)


def _drag(information: float, weighted: float) -> tuple[float, float]:
    """Logarithm of the drag and its error, by what the motion tells and by its spread."""
    prior = 1.0 / DRAG**2
    if information <= 0.0:
        return 0.0, DRAG
    measured = 1.0 / (1.0 / information + _GUST_ERROR**2)
    both = prior + measured
    return measured * (weighted / information) / both, math.sqrt(1.0 / both)


def _mean(values: Floats, weight: Floats) -> tuple[float, float]:
    mean = float(weight @ values)
    step = values[1] - values[0]
    return mean, math.sqrt((weight @ np.square(values - mean)) + step * step / 12.0)


def _patterns(covariance: Floats, stiffness: Floats) -> tuple[Floats, Floats]:
    """
    Find the patterns of forces that matter, (m, r), and their deviations, (r,).

    They are uncorrelated, and those that bend the tree little are left out.
    """
    soft = 1.0 / stiffness
    values, vectors = np.linalg.eigh(soft[:, None] * covariance * soft)
    kept = values > _LEAST * values[-1]
    return stiffness[:, None] * vectors[:, kept], np.sqrt(values[kept])


class _Misfit:
    """
    How far the spectrum of a sensor is from that of a candidate.

    Parameters
    ----------
    measured
        The measured spectrum.
    unknown
        A root of the covariance of the unknown forces, (m, k).
    stiffness
        Stiffness of the model of the sensor's rows, (m,).

    """

    def __init__(self, measured: Spectrum, unknown: Floats, stiffness: Floats) -> None:
        self._n_stretches = measured.n_stretches
        self._noise = measured.noise
        self._circular = measured.circular
        self._stiffness = stiffness
        self._n_unknown = unknown.shape[1]
        w = self._circular
        weaker = np.exp(-_SLOPES[:, None] * np.log(w / w[0]))
        self._weaker = weaker[:, None]
        products = measured.products
        # All forces of the wind are sums of few patterns, for the wind is one.
        known, _ = _patterns(products[:, 2:, 2:].real.sum(axis=0), stiffness)
        shares = known / np.square(stiffness)[:, None]
        self._forces = shares.T @ products[:, 2:, 2:] @ shares
        self._shared = np.moveaxis(shares.T @ products[:, 2:, :2], 2, 0)
        self._power = products[:, (0, 1), (0, 1)].real.T
        # East and north motion by each pattern, of displacement, rate and force.
        patterns = np.hstack([unknown, known])
        by_eta, by_rate, by_force = np.moveaxis(measured.rows[:2].reshape(2, 3, -1), 1, 0)
        parts = [each[:, None] * patterns.T for each in (by_eta, by_rate, by_force)]
        self._by_eta, self._by_rate, by_force = parts
        self._by_stiffer = by_force * stiffness
        self._by_force = by_force.sum(axis=2)[..., None]

    def of(self, stiff: float, damping: Floats) -> tuple[Floats, Floats, Floats]:
        """
        Return -ln p, the drag and the information on its logarithm for each slope, (s,) each.

        Parameters
        ----------
        stiff
            Stiffness of the candidate over that of the model.
        damping
            Its damping, (m,).

        """
        motion = self._motion(stiff, damping)
        unknown = motion[:, : self._n_unknown]
        level = (np.square(unknown.real) + np.square(unknown.imag)).sum(axis=1)
        # The window spreads the power of a frequency to its neighbours.
        spread = level[:, :-2] + 4.0 * level[:, 1:-1] + level[:, 2:]
        level[:, 1:-1] = spread / 6.0
        shaped = self._with_noise(np.maximum(level * self._weaker, 1e-300))
        powers = self._powers(motion[:, self._n_unknown :])
        told, common, alone = ((each / shaped).mean(axis=2) for each in powers)
        # The factor of the drag, and the level of what it leaves.
        factor = common.sum(axis=1) / np.maximum(alone.sum(axis=1), 1e-300)
        factor = np.clip(factor, 0.0, _MOST_DRAG)
        drag = factor[:, None]
        left = told - 2.0 * drag * common + drag * drag * alone
        left = np.maximum(left, 1e-300)
        n_frequencies = len(self._circular)
        logs = np.log(shaped).sum(axis=(1, 2))
        logs += n_frequencies * np.log(left).sum(axis=1)
        count = _INDEPENDENT * self._n_stretches
        known = (alone / left).sum(axis=1)
        return count * logs, factor, count * n_frequencies * factor**2 * known

    def _with_noise(self, shaped: Floats) -> Floats:
        """Add the noise of the sensor to spectra of the sway up to their level, (s, 2, f)."""
        if not self._noise:
            return shaped
        total = self._power.sum()
        sway = max(total - self._noise * self._power.size, _LEAST_SWAY * total)
        return shaped * (sway / shaped.sum(axis=(1, 2), keepdims=True)) + self._noise

    def _motion(self, stiff: float, damping: Floats) -> Complexes:
        """East and north motion of a candidate by each pattern, (2, patterns, f)."""
        w = self._circular
        stiffness = (stiff * self._stiffness)[:, None]
        response = 1.0 / (stiffness - w * w + 1j * w * damping[:, None])
        # Real matrices on real and imaginary parts, side by side.
        parts = response.view(np.float64)
        by_eta = self._by_eta - (stiff - 1.0) * self._by_stiffer
        by_displacement = (by_eta @ parts).view(np.complex128)
        by_rate = (self._by_rate @ parts).view(np.complex128)
        return by_displacement + 1j * w * by_rate + self._by_force

    def _powers(self, known: Complexes) -> tuple[Floats, Floats, Floats]:
        """
        Return powers of the motion that was measured, of that expected, and what both share.

        The expected motion is by the patterns of the wind that is known, (2, patterns, f).
        """
        by_pattern = known.swapaxes(1, 2)
        forced = (by_pattern[:, :, None] @ self._forces)[:, :, 0]
        expected = (forced * by_pattern.conj()).sum(axis=2)
        shared = (by_pattern * self._shared).sum(axis=2)
        return self._power, shared.real, expected.real
