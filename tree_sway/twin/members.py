# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Uncertainty of the observed motion: an ensemble of 64 trees that the real one might be.

Each member differs from the model in its wood, its damping, its drag area and the gusts that its
limbs meet, each drawn from a published spread:

- Wood: Young's modulus of clear wood of one species varies by 22 % (Forest Products Laboratory,
  Wood Handbook, 2010, table 5-6).
- Damping: standard deviation 0.5 of its logarithm; the 0.01 to 0.08 of bare stems (Moore & Maguire
  2005) are +-2 of them.
- Drag and leaf area: `load_spreads`.
- Gusts: a share of each reaches the crown at once (`USUAL_COHERENCE`), the rest one limb after
  the other, as in `crown_wind`. The delay of a limb is not known, so each member draws its own.
  Where an anemometer averages fast gusts away, each member meets its own, by the law of
  `disturbance`. At a known distance from the anemometer each meets a stretch of its own of what
  is drawn beside the expected wind (`far_wind`).

A member is an oscillator for each of the first coordinates, driven by the forces on the model and
those of its gusts::

    x'' + (z s^1/2 c + a d) x' + s k x = a (F + d q') + g

x is the member's coordinate and q the model's; k, c stiffness and damping of the wood, d damping
by the air, F the force on the model; s, z, a the member's stiffness, damping and drag over those
of the model, g the force of its gusts.

Where there are sensors, the filter runs once for each member, on a simulated measurement of it.
The band is what remains between the members and the filter's estimates of them (an ensemble as in
Evensen 2003, Ocean Dynamics 53, 343-367, with fixed gains). Arrays are (coordinates n, members e).
"""

from __future__ import annotations

import math
from typing import NamedTuple, TYPE_CHECKING

import numpy as np
from scipy.special import ndtri

from tree_sway.core.arrays import Floats
from tree_sway.core.model.load_spreads import DRAG, LEAVES, SHARE_WITHIN
from tree_sway.core.oscillators.propagator import held_propagator
from tree_sway.core.wind.crown_wind import N_DELAYS, USUAL_COHERENCE
from tree_sway.core.wind.far_wind import FarWind, SAMPLES
from tree_sway.twin.disturbance import GUST, part_slopes

if TYPE_CHECKING:
    from tree_sway.core.run.simulator import SwaySimulator
    from tree_sway.twin.observer import Observer

N_MEMBERS = 64
"""Number of members."""

WOOD_SPREAD, DAMPING_SPREAD = 0.22, 0.5
"""Log-deviations of Young's modulus within a species, and of damping among trees."""

_LEAST_FAST = 0.04
"""
Least deviation of fast gusts over the mean wind [-], where an anemometer averages them away: a
sixth of the variance of a turbulence of 0.1, the least over open land.
"""

_ALONG, _ACROSS = 4.0 / 3.0, 2.0 / 3.0
"""Slopes of the drag along the wind and across it, over the mean that `disturbance` takes."""

_AVERAGED = 30.0
"""Time over which the variance of fast gusts is averaged [s]."""
_BIAS_TIME = 60.0
"""Time over which the mean of a simulated measurement is removed, as of a real one [s]."""


class Uncertainty(NamedTuple):
    """Log-deviations of a tree's stiffness, damping and drag area over the model's."""

    stiffness: float = WOOD_SPREAD
    damping: float = DAMPING_SPREAD
    drag: float = DRAG


def uncertainty_of(*, in_leaf: bool) -> Uncertainty:
    """Return the spreads for a tree without measurements."""
    leaf = LEAVES if in_leaf else 0.0
    return Uncertainty(drag=math.hypot(DRAG, leaf))


def uncorrelated_draws(count: int, n_values: int, rng: np.random.Generator) -> Floats:
    """
    Draw values of the normal distribution, (n_values, count), one from each stratum.

    Independent draws would be correlated by chance, and the lean of a tree varies with the ratio
    of its wood and drag. Ranks are taken from draws whose correlation is removed (Iman & Conover
    1982, Communications in Statistics B11, 311-334).
    """
    strata = ndtri((np.arange(count) + 0.5) / count)
    drawn = np.stack([rng.permutation(strata) for _ in range(n_values)])
    covariance = np.cov(drawn) + 1e-9 * np.eye(n_values)
    root = np.linalg.cholesky(covariance)
    uncorrelated = np.linalg.solve(root, drawn)
    order = uncorrelated.argsort(axis=1)
    ranks = order.argsort(axis=1)
    return np.asarray(strata[ranks])


def most_of(found: Floats) -> Floats:
    """Find the bounds of the middle 80 %, (2, ...), of a value of each member, (..., e)."""
    ordered = np.sort(found, axis=-1)
    rank = 0.5 * (1.0 - SHARE_WITHIN) * (N_MEMBERS + 1) - 1.0
    low = int(rank)
    share = rank - int(rank)
    from_below = (1.0 - share) * ordered[..., low] + share * ordered[..., low + 1]
    from_above = (1.0 - share) * ordered[..., -low - 1] + share * ordered[..., -low - 2]
    return np.stack([from_below, from_above])


class Members:
    """
    The ensemble, stepped beside the model.

    Parameters
    ----------
    observer
        The observer of the model.
    dt
        Time step in [s].
    spreads
        How far members differ from the model.
    far
        Winds of a tree apart from its anemometer, and the tree; None for one beside it.

    """

    def __init__(
        self,
        observer: Observer,
        dt: float,
        spreads: Uncertainty,
        far: tuple[FarWind, SwaySimulator] | None = None,
    ) -> None:
        self._far = far
        self._offsets = SAMPLES // N_MEMBERS * np.arange(N_MEMBERS)
        self._observer = observer
        self._dt = dt
        self.spreads = spreads
        n = self._count = observer.count
        self._rng = np.random.default_rng(0)
        self._drawn = uncorrelated_draws(N_MEMBERS, len(spreads), self._rng)
        self._limb_draws = np.zeros((0, N_MEMBERS))
        self._per_delay = np.zeros((n * N_MEMBERS, 3 * N_DELAYS))
        self._late = np.zeros((n, N_MEMBERS))
        self._winds = np.zeros((3, N_DELAYS))
        self.motion = np.zeros((2, n, N_MEMBERS))
        """Displacement and rate of each, (2, n, e)."""
        self._gust, self._force, self._away = np.zeros((3, n, N_MEMBERS))
        self._next = np.zeros((2, n, N_MEMBERS))
        self._felt = np.zeros((3, n, N_MEMBERS))
        self._estimate = np.zeros((3, n, N_MEMBERS))
        self._moved = np.zeros((3, 3, n, N_MEMBERS))
        self._bias = np.zeros((0, N_MEMBERS))
        self._slow: tuple[float, float] = (0.0, 0.0)
        self._fast = 0.0
        self._steps = self._measured = 0
        self._filled_for: tuple[object, object, object] = (None, None, None)
        self.stiffness = np.ones(N_MEMBERS)
        """Stiffness of each over the model's, (e,)."""
        self.errors = np.zeros((n, N_MEMBERS))
        """Displacement of each member less the filter's estimate of it, (n, e)."""

    def _fill(self) -> None:
        """Find propagator, drag and gusts of each member for the present wind and spreads."""
        observer = self._observer
        n = self._count
        unknown = observer.unknown
        spreads = self.spreads
        factors = np.exp(np.array(spreads)[:, None] * self._drawn)
        self.stiffness, loss, self._drag = factors
        stiffness = np.outer(observer.stiffness, self.stiffness)
        damping = np.outer(observer.damping[:n], loss * np.sqrt(self.stiffness))
        self._air = unknown.air_damping[:, None]
        damping += self._air * self._drag
        step = held_propagator(damping.ravel(), stiffness.ravel(), self._dt)
        self._step = step.reshape(2, 3, n, N_MEMBERS)
        self._stiff = stiffness
        self._damp = damping
        values, vectors = np.linalg.eigh(unknown.covariance)
        kept = values > 1e-4 * values[-1]
        self._decay = math.exp(-self._dt / unknown.time_constant)
        driven = math.sqrt(1.0 - self._decay**2)
        self._gusts = driven * vectors[:, kept] * np.sqrt(values[kept])
        self._noise = np.zeros((self._gusts.shape[1], N_MEMBERS))
        self._unit = unknown.speed * GUST
        if self._far is None:
            self._draw_delays(unknown.limb_slopes, unknown.reach)
        else:
            slopes = part_slopes(self._far[1], unknown.speed, n)
            self._per_part = np.ascontiguousarray(slopes.reshape(-1, n).T)

    def _draw_delays(self, slopes: Floats, reach: Floats) -> None:
        """Find the force on each member per wind of each delay, summed over its limbs."""
        if len(self._limb_draws) != len(reach):
            self._limb_draws = self._rng.random((len(reach), N_MEMBERS))
        drawn_reach = self._limb_draws * reach[:, None]
        delays = np.rint(drawn_reach * (N_DELAYS - 1)).astype(np.intp)
        n = self._count
        by_member = np.zeros((N_MEMBERS, N_DELAYS, 3, n))
        for forces, of_limb in zip(by_member, delays.T, strict=True):
            np.add.at(forces, of_limb, slopes)
        by_member *= self._drag[:, None, None, None]
        by_coordinate = by_member.transpose(3, 0, 2, 1)
        self._per_delay = by_coordinate.reshape(n * N_MEMBERS, -1).copy()

    def step(self, swing: tuple[Floats, ...], wind: tuple[float, float], apart: Floats) -> None:
        """
        Step every member, and the filter's estimate of it.

        Parameters
        ----------
        swing
            Displacement, rate and force of each coordinate in the wind alone, (m,).
        wind
            Horizontal wind over the step [m/s].
        apart
            Wind of each delay less the wind on the model [m/s], (`N_DELAYS`, 3).

        """
        observer = self._observer
        n = self._count
        eta, rate, force = (each[:n, None] for each in swing)
        present = (observer.unknown, observer.stiffness, self.spreads)
        if any(now is not then for now, then in zip(present, self._filled_for, strict=True)):
            self._fill()
            self._filled_for = present
        if not self._steps:
            self.motion[0] = eta
            self.motion[1] = rate
            self._slow = wind
            self._steps = 1
            self.errors[:] = 0.0
            return
        self._steps += 1
        if self._far is not None:
            winds = self._far[0].others(self._offsets, _ALONG, _ACROSS)
            np.matmul(self._per_part, winds.reshape(N_MEMBERS, -1).T, out=self._late)
            self._late *= self._drag
        else:
            self._blow(*wind)
            self._reach_limbs(apart)
        total = self._force
        x = self.motion[0]
        v = self.motion[1]
        np.multiply(force + self._air * rate, self._drag, out=total)
        total += self._gust
        total += self._late
        for to, by in zip(self._next, self._step, strict=True):
            np.multiply(by[0], x, out=to)
            to += np.multiply(by[1], v, out=self._away)
            to += np.multiply(by[2], total, out=self._away)
        self.motion, self._next = self._next, self.motion
        if observer.is_active:
            self._filter(eta, rate, force)
        else:
            self._estimate[:] = 0.0
            self._measured = 0
            np.subtract(self.motion[0], eta, out=self.errors)

    def _blow(self, x: float, y: float) -> None:
        """Step the forces of the gusts that an anemometer averages away, in a wind [m/s]."""
        share = 1.0 - self._decay
        slow_x, slow_y = self._slow
        slow_x = slow_x + share * (x - slow_x)
        slow_y = slow_y + share * (y - slow_y)
        self._slow = slow_x, slow_y
        fast = 0.5 * ((x - slow_x) ** 2 + (y - slow_y) ** 2)
        share_of_step = max(self._dt / _AVERAGED, 1.0 / self._steps)
        self._fast += share_of_step * (fast - self._fast)
        self._gust *= self._decay
        least_fast = _LEAST_FAST * math.hypot(slow_x, slow_y)
        missing = least_fast**2 - self._fast
        if missing <= 0.0:
            return
        size = (1.0 - USUAL_COHERENCE) * math.sqrt(missing) / self._unit
        self._rng.standard_normal(out=self._noise)
        np.dot(self._gusts, self._noise, out=self._away)
        self._away *= size
        self._gust += self._away

    def _reach_limbs(self, apart: Floats) -> None:
        """Find the forces of gusts that reach the limbs of each member after its own delays."""
        x, y = self._slow
        speed = max(math.hypot(x, y), 1e-9)
        along = (apart[:, 0] * x + apart[:, 1] * y) / speed
        more = (_ALONG - _ACROSS) * along / speed
        winds = self._winds
        np.multiply(_ACROSS, apart.T, out=winds)
        winds[0] += more * x
        winds[1] += more * y
        np.dot(self._per_delay, winds.reshape(-1), out=self._late.reshape(-1))

    def _filter(self, eta: Floats, rate: Floats, force: Floats) -> None:
        """Correct the estimate of each member by the simulated measurement of its motion."""
        n = self._count
        gains = self._observer.gains
        assert gains is not None
        estimate = self._estimate
        felt = self._felt
        stiffness = self._observer.stiffness[:, None]
        damping = self._observer.damping[:n, None]
        np.multiply(gains.law.step[..., None], estimate, out=self._moved)
        np.add.reduce(self._moved, axis=1, out=estimate)
        np.subtract(self.motion[0], eta, out=felt[0])
        np.subtract(self.motion[1], rate, out=felt[1])
        # The force that makes a sensor's rows give the difference of the two accelerations.
        np.multiply(self._stiff, self.motion[0], out=self._away)
        np.subtract(self._force, self._away, out=felt[2])
        felt[2] -= np.multiply(self._damp, self.motion[1], out=self._away)
        felt[2] -= force - damping * rate - stiffness * eta
        felt[2] += stiffness * felt[0] + self._observer.damped[:, None] * felt[1]
        told = gains.sensed @ felt.reshape(3 * n, -1)
        if len(self._bias) != len(told):
            self._bias = np.zeros_like(told)
            self._measured = 0
        self._measured += 1
        share = max(self._dt / _BIAS_TIME, 1.0 / self._measured)
        self._bias += share * (told - self._bias)
        told -= self._bias
        told += self._observer.noise[:, None] * self._rng.standard_normal(told.shape)
        told -= gains.sensed @ estimate.reshape(3 * n, -1)
        estimate += (gains.gain @ told).reshape(estimate.shape)
        np.multiply(estimate[0], self._observer.trust[:, None], out=self._away)
        np.subtract(felt[0], self._away, out=self.errors)

    def band(self, readout: Floats, scale: Floats | None = None) -> Floats:
        """
        Find the interval of the middle 80 % of the members.

        Parameters
        ----------
        readout
            Value per unit of each coordinate, (..., m).
        scale
            Further differences of the members to add, (..., e).

        Returns
        -------
        Floats
            Lower and upper bound, less the corrected motion, (2, ...).

        """
        found = self.differences(readout)
        return most_of(found if scale is None else found + scale)

    def differences(self, readout: Floats) -> Floats:
        """Find a value of each member less the corrected motion, (..., e); `readout` as above."""
        return np.asarray(readout[..., : self._count] @ self.errors)

    def reset(self) -> None:
        """Begin anew from the motion of the model."""
        self._steps = self._measured = 0
        self._estimate[:] = 0.0
        self._gust[:] = 0.0
