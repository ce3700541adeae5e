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
from tree_sway.core.drag import DRAG, LEAVES, SHARE_WITHIN
from tree_sway.core.oscillators import held_propagator
from tree_sway.core.species import WOOD_SPREAD
from tree_sway.core.wind.gusts import FarWind, N_DELAYS, SAMPLES, USUAL_COHERENCE
from tree_sway.twin.disturbance import ACROSS, ALONG, GUST, part_slopes

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator
    from tree_sway.twin.disturbance import Disturbance
    from tree_sway.twin.observer import Observer

_N_MEMBERS = 64
"""Number of members."""

_DAMPING_SPREAD = 0.5
"""Log-deviation of damping among trees."""

_LEAST_FAST = 0.04
"""
Least deviation of fast gusts over the mean wind [-], where an anemometer averages them away: a
sixth of the variance of a turbulence of 0.1, the least over open land.
"""

_AVERAGED = 30.0
"""Time over which the variance of fast gusts is averaged [s]."""
_BIAS_TIME = 60.0
"""Time over which the mean of a simulated measurement is removed, as of a real one [s]."""


class Uncertainty(NamedTuple):
    """Log-deviations of a tree's stiffness, damping and drag area over the model's."""

    stiffness: float = WOOD_SPREAD
    damping: float = _DAMPING_SPREAD
    drag: float = DRAG


def uncertainty_of(*, in_leaf: bool) -> Uncertainty:
    """Return the spreads for a tree without measurements."""
    return Uncertainty(drag=math.hypot(DRAG, LEAVES * in_leaf))


def uncorrelated_draws(count: int, n_values: int, rng: np.random.Generator) -> Floats:
    """
    Draw values of the normal distribution, (n_values, count), one from each stratum.

    Independent draws would be correlated by chance, and the lean of a tree varies with the ratio
    of its wood and drag. Ranks are taken from draws whose correlation is removed (Iman & Conover
    1982, Communications in Statistics B11, 311-334).
    """
    middles = (np.arange(count) + 0.5) / count
    strata = ndtri(middles)
    drawn = np.stack([rng.permutation(strata) for _ in range(n_values)])
    least = 1e-9 * np.eye(n_values)
    covariance = np.cov(drawn) + least
    root = np.linalg.cholesky(covariance)
    uncorrelated = np.linalg.solve(root, drawn)
    order = uncorrelated.argsort(axis=1)
    ranks = order.argsort(axis=1)
    return strata[ranks]


def most_of(found: Floats) -> Floats:
    """Find the bounds of the middle 80 %, (2, ...), of a value of each member, (..., e)."""
    beyond = 0.5 * (1.0 - SHARE_WITHIN)
    return np.quantile(found, [beyond, 1.0 - beyond], axis=-1, method='weibull')


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
        self._observer = observer
        self._dt = dt
        self._far = far
        self.spreads = spreads
        n = self._count = observer.count
        self._rng = np.random.default_rng(0)
        self._drawn = uncorrelated_draws(_N_MEMBERS, len(spreads), self._rng)
        apart = SAMPLES // _N_MEMBERS
        self._offsets = apart * np.arange(_N_MEMBERS)
        self._limb_draws = np.zeros((0, _N_MEMBERS))
        self._per_delay = np.zeros((n * _N_MEMBERS, 3 * N_DELAYS))
        self.motion = np.zeros((2, n, _N_MEMBERS))
        """Displacement and rate of each, (2, n, e)."""
        self._force = np.zeros((n, _N_MEMBERS))
        self._gust = np.zeros((n, _N_MEMBERS))
        self._estimate = np.zeros((3, n, _N_MEMBERS))
        self._bias = np.zeros((0, _N_MEMBERS))
        self._slow = np.zeros(2)
        self._fast = 0.0
        self._steps = 0
        self._measured = 0
        self._filled_for: tuple[object, object, object] = (None, None, None)
        self.stiffness = np.ones(_N_MEMBERS)
        """Stiffness of each over the model's, (e,)."""
        self.errors = np.zeros((n, _N_MEMBERS))
        """Displacement of each member less the filter's estimate of it, (n, e)."""

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
        eta, rate, force = (each[: self._count, None] for each in swing)
        self._fill_anew()
        self._steps += 1
        if self._steps == 1:
            self.motion[:] = eta, rate
            self._slow = np.array(wind)
            self.errors[:] = 0.0
            return
        if self._far is None:
            self._blow(np.array(wind))
            late = self._late_gusts(apart)
        else:
            late = self._far_gusts(self._far[0])
        in_still_air = force + self._air * rate
        self._force = in_still_air * self._drag
        self._force += self._gust
        self._force += late
        state = np.stack([*self.motion, self._force])
        parts = self._step * state
        self.motion = parts.sum(axis=1)
        if self._observer.is_active:
            self._filter(eta, rate, force)
        else:
            self._estimate[:] = 0.0
            self._measured = 0
            self.errors = self.motion[0] - eta

    def _fill_anew(self) -> None:
        """Find the law of the members again where wind, model or spreads have changed."""
        unknown = self._observer.unknown
        forces = unknown.present_forces(keeps_old=self._observer.is_active)
        now = forces, self._observer.stiffness, self.spreads
        if any(one is not other for one, other in zip(now, self._filled_for, strict=True)):
            self._fill(forces)
            self._filled_for = now

    def _fill(self, forces: Disturbance) -> None:
        """Find propagator, drag and gusts of each member for the present wind and spreads."""
        n, unknown = self._count, self._observer.unknown
        deviations = np.array(self.spreads)[:, None]
        factors = np.exp(deviations * self._drawn)
        self.stiffness, loss, self._drag = factors
        self._stiff = np.outer(unknown.stiffness, self.stiffness)
        of_wood = loss * np.sqrt(self.stiffness)
        self._air = forces.air_damping[:, None]
        self._damp = np.outer(unknown.all_damping[:n], of_wood)
        self._damp += self._air * self._drag
        damping, stiffness = self._damp.ravel(), self._stiff.ravel()
        step = held_propagator(damping, stiffness, self._dt)
        self._step = step.reshape(2, 3, n, _N_MEMBERS)
        self._find_patterns(forces)
        if self._far is None:
            self._find_delays(forces.limb_slopes, forces.reach)
        else:
            slopes = part_slopes(self._far[1], forces.speed, n)
            by_part = slopes.reshape(-1, n)
            self._per_part = np.ascontiguousarray(by_part.T)

    def _find_patterns(self, forces: Disturbance) -> None:
        """Find the patterns of the gusts that an anemometer averages away, and their decay."""
        values, vectors = np.linalg.eigh(forces.covariance)
        kept = values > 1e-4 * values[-1]
        self._decay = math.exp(-self._dt / forces.time_constant)
        driven = math.sqrt(1.0 - self._decay**2)
        deviations = np.sqrt(values[kept])
        self._gusts = driven * vectors[:, kept] * deviations
        self._unit = forces.speed * GUST

    def _find_delays(self, slopes: Floats, reach: Floats) -> None:
        """Find the force on each member per wind of each delay, summed over its limbs."""
        n, n_limbs = self._count, len(reach)
        if len(self._limb_draws) != n_limbs:
            self._limb_draws = self._rng.random((n_limbs, _N_MEMBERS))
        drawn_reach = self._limb_draws * reach[:, None]
        delays = np.rint(drawn_reach * (N_DELAYS - 1)).astype(np.intp)
        by_member = np.zeros((_N_MEMBERS, N_DELAYS, 3, n))
        for forces, of_limb in zip(by_member, delays.T, strict=True):
            np.add.at(forces, of_limb, slopes)
        by_member *= self._drag[:, None, None, None]
        by_coordinate = by_member.transpose(3, 0, 2, 1)
        self._per_delay = by_coordinate.reshape(n * _N_MEMBERS, -1).copy()

    def _blow(self, wind: Floats) -> None:
        """Step the forces of the gusts that an anemometer averages away, in a wind [m/s], (2,)."""
        self._slow += (1.0 - self._decay) * (wind - self._slow)
        beyond = wind - self._slow
        variance = 0.5 * np.square(beyond).sum()
        share = max(self._dt / _AVERAGED, 1.0 / self._steps)
        self._fast += share * (variance - self._fast)
        self._gust *= self._decay
        least = _LEAST_FAST * math.hypot(*self._slow)
        missing = least**2 - self._fast
        if missing > 0.0:
            size = (1.0 - USUAL_COHERENCE) * math.sqrt(missing) / self._unit
            n_patterns = self._gusts.shape[1]
            drawn = self._rng.standard_normal((n_patterns, _N_MEMBERS))
            self._gust += size * (self._gusts @ drawn)

    def _late_gusts(self, apart: Floats) -> Floats:
        """Find forces of gusts that reach the limbs after the delays of each member, (n, e)."""
        ahead = self._slow / max(math.hypot(*self._slow), 1e-9)
        along = apart[:, :2] @ ahead
        winds = ACROSS * apart
        winds[:, :2] += (ALONG - ACROSS) * np.outer(along, ahead)
        by_axis = winds.T.ravel()
        found = self._per_delay @ by_axis
        return found.reshape(self._count, _N_MEMBERS)

    def _far_gusts(self, wind: FarWind) -> Floats:
        """Find forces of what is drawn beside the expected wind, a stretch for each, (n, e)."""
        winds = wind.others(self._offsets, ALONG, ACROSS)
        by_member = winds.reshape(_N_MEMBERS, -1)
        found = self._per_part @ by_member.T
        return found * self._drag

    def _filter(self, eta: Floats, rate: Floats, force: Floats) -> None:
        """Correct the estimate of each member by the simulated measurement of its motion."""
        gains = self._observer.gains
        assert gains is not None
        estimate = self._estimate
        moved = gains.law.step[..., None] * estimate
        estimate[:] = moved.sum(axis=1)
        beyond = self._beyond(eta, rate, force)
        flat = estimate.reshape(len(beyond), -1)
        measured = self._measure(gains.sensed @ beyond)
        innovation = measured - gains.sensed @ flat
        correction = gains.gain @ innovation
        estimate += correction.reshape(estimate.shape)
        ahead = beyond[: self._count]
        trust = self._observer.trust[:, None]
        lean = estimate[2] / self._observer.stiffness[:, None]
        leaning = trust.max() * self._observer.leaning[:, None]
        told = trust * estimate[0] + np.maximum(leaning - trust, 0.0) * lean
        self.errors = ahead - told

    def _beyond(self, eta: Floats, rate: Floats, force: Floats) -> Floats:
        """Displacement, rate and force of each member beyond those of the model, (3 n, e)."""
        unknown = self._observer.unknown
        stiffness, damping = unknown.stiffness[:, None], unknown.all_damping[: self._count, None]
        displacement, own_rate = self.motion
        ahead, faster = displacement - eta, own_rate - rate
        # The force that makes a sensor's rows give the difference of the two accelerations.
        more = self._force - self._stiff * displacement - self._damp * own_rate
        more -= force - damping * rate - stiffness * eta
        more += stiffness * ahead + unknown.damped[:, None] * faster
        return np.concatenate([ahead, faster, more])

    def _measure(self, told: Floats) -> Floats:
        """Return what sensors tell, (p, e), about its mean and with their noise."""
        if len(self._bias) != len(told):
            self._bias = np.zeros_like(told)
            self._measured = 0
        self._measured += 1
        share = max(self._dt / _BIAS_TIME, 1.0 / self._measured)
        self._bias += share * (told - self._bias)
        drawn = self._rng.standard_normal(told.shape)
        noise = self._observer.noise[:, None] * drawn
        return told - self._bias + noise

    def differences(self, readout: Floats) -> Floats:
        """
        Find a value of each member less that of the corrected motion, (..., e).

        The readout is the value per unit of each coordinate, (..., m).
        """
        return readout[..., : self._count] @ self.errors

    def reset(self) -> None:
        """Begin anew from the motion of the model."""
        self._steps = self._measured = 0
        self._estimate[:] = 0.0
        self._gust[:] = 0.0
