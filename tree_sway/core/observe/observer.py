# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What sensors tell about the motion of a tree beyond that in the wind alone.

The observer holds the difference between the real and the computed motion on the first coordinates
of a model. At each step the difference moves by its own law, and what the sensors measure beyond
the model corrects it (`steady_filter`). Sensors that are late are read at an earlier step, and the
difference is moved on to the present. Without a usable sensor the difference fades.

The motion of the present is the calm one of `Estimate`. The smoothed one is late by a fixed lag,
and knows what was measured since.

A sensor on the stem tells about a hanging twig only what both have in common by the law of the
gusts, and of all that the filter knows, that law is known least. A coordinate is corrected where
the sensors take away enough of its variance; elsewhere the tree sways in the wind alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
import math
from typing import NamedTuple, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.kernel import entry_of, kernel
from tree_sway.core.observe.disturbance import Disturbance, disturbance, TIME_CONSTANT
from tree_sway.core.observe.estimate import Estimate
from tree_sway.core.observe.lateness import Lateness
from tree_sway.core.observe.sensor_place import place_motion, PlaceMotion
from tree_sway.core.observe.sensor_track import as_felt, ROWS, sensed_rows, SensorTrack
from tree_sway.core.observe.steady_filter import (
    filter_in_parts,
    stationary_covariance,
    SteadyFilter,
    sway_law,
    SwayLaw,
    told_shares,
)
from tree_sway.core.observe.tree_fit import fits, SensorSpectrum, Spectrum, TreeFit
from tree_sway.core.setup.one_thread import one_thread

if TYPE_CHECKING:
    from tree_sway.core.run.simulator import SwaySimulator

MOST_COORDINATES = 32
"""Largest number of coordinates that sensors correct."""

_NOISE, _DOUBTED = 3.5, 8.0
"""Noise for which gains, and what the sensors tell, are found, over the noise of the sensors."""

_FADE = 0.3
_HISTORY = 64
_LATEST = 30
_RECENT = 30.0
_REDESIGN = 1.6
_SLOWEST_WIND = 2.0
_STIFFER, _MORE_DAMPED = 0.03, 0.2
"""Changes of the logarithms of stiffness and damping from which other gains are found."""

_FIRST_FIT, _FIT_LATER = 40.0, 1.4

_TELLS_LITTLE, _TELLS_ENOUGH = 0.25, 0.4
"""
Shares of the variance of a coordinate that the sensors take away below and above which its
correction is not applied, and applied whole.
"""

_TRUSTED_WITHIN = 2.0
"""Time constant in [s] with which the applied shares follow those of new gains."""

SMOOTHED_LAG, _WINDOW = 6, np.hanning(9)[1:-1] / np.hanning(9)[1:-1].sum()
"""Steps between the smoother's estimate and its newest measurement, and the window over it."""

LATE_STEPS = SMOOTHED_LAG + len(_WINDOW) // 2
"""Steps by which the smoothed state is late."""


class _Design(NamedTuple):
    """Numbers of sensors, their noise (p,), gains, and share told of each coordinate (n,)."""

    used: tuple[int, ...]
    noise: Floats
    gains: SteadyFilter
    told: Floats


@kernel
def find_energies(
    stiffness: Floats, eta: Floats, rate: Floats, correction: Floats, out: Floats
) -> None:
    """
    Find energies of a motion and its correction, all twice and per unit mass.

    Parameters
    ----------
    stiffness
        Stiffness of the first coordinates [1/s^2], (n,).
    eta, rate
        Displacement and rate, (n,) or more.
    correction
        What is added to both, (2, n) or more rows.
    out
        Elastic energy of the correction and of the corrected motion, and all energy of the
        corrected and of the uncorrected motion, (4,), written.

    """
    added, elastic, kinetic, own = 0.0, 0.0, 0.0, 0.0
    for i in range(len(stiffness)):
        k, q, v, dq, dv = stiffness[i], eta[i], rate[i], correction[0, i], correction[1, i]
        added += k * dq * dq
        elastic += k * (q + dq) * (q + dq)
        kinetic += (v + dv) * (v + dv)
        own += k * q * q + v * v
    out[0], out[1], out[2], out[3] = added, elastic, elastic + kinetic, own


class Observer:
    """
    The difference between a real tree and its model.

    Parameters
    ----------
    simulator
        The model in the wind alone.
    tracks
        Sensors on the tree.
    dt
        Time step in [s].
    is_smoothed
        Whether the smoothed state is kept too.

    """

    def __init__(
        self,
        simulator: SwaySimulator,
        tracks: Sequence[SensorTrack],
        dt: float,
        *,
        is_smoothed: bool = False,
    ) -> None:
        self.tracks, self._simulator, self._dt = list(tracks), simulator, dt
        shapes = simulator.banks[0].oscillators.shapes
        self.count = min(MOST_COORDINATES, shapes.shape[1])
        """Number of coordinates that are corrected."""
        self._is_smoothed = is_smoothed
        self._places = [place_motion(simulator, each.sensor.place) for each in self.tracks]
        self._lateness = Lateness(len(self.tracks), dt, _LATEST)
        self._computed = np.zeros((_HISTORY, len(self.tracks), ROWS))
        self._eta = np.zeros((_HISTORY, shapes.shape[1]))
        self._states = np.zeros((_HISTORY, self.count))
        self._forces = np.zeros((_HISTORY, self.count))
        frequency = float(simulator.frequencies(1)[0])
        self._spectra = [SensorSpectrum(frequency, dt, self.count) for _ in self.tracks]
        self._smoothed = np.zeros((len(_WINDOW), shapes.shape[1]))
        self._steps = 0
        self._done = -1
        self._used: tuple[int, ...] = ()
        self._designed_for = 0.0
        self._mean_speed = 0.0
        self._estimate: Estimate | None = None
        self._designing: Iterator[_Design | None] | None = None
        self._designed: tuple[int, ...] = ()
        self.trust = np.zeros(self.count)
        """Share of the correction of each coordinate that is applied [-], (count,)."""
        self._wanted_trust = np.zeros(self.count)
        self._unknown: Disturbance | None = None
        self._air_damping = np.zeros(self.count)
        self._fitting: Iterator[TreeFit | None] | None = None
        self._fit_after = _FIRST_FIT
        self.fit: TreeFit | None = None
        """Stiffness and damping by the sensors, over those of the model as it was made."""
        self._made = self._designed_with = (0.0 * shapes[0], 0.0 * shapes[0])
        self._open: Floats | None = None
        self.damped = np.zeros(self.count)
        """Damping of the coordinates that are corrected, by wood and air, [1/s], (count,)."""
        self.noise = np.zeros(0)
        """Standard deviation of the noise of the measurements in use, (p,)."""
        self._ahead: dict[int, Floats] = {}
        self._moved = np.zeros((3, self.count))
        self._terms = np.zeros((3, 3, self.count))
        self._values, self._is_known = np.zeros(0), np.zeros(0, dtype=np.bool_)
        self.energies = np.zeros(4)
        """Energies of the last correction, as `find_energies` writes them."""
        self._swing = np.zeros(3 * shapes.shape[1])
        with one_thread():
            self.refresh()
        self._made = (self._stiffness, self.damping)

    def refresh(self) -> None:
        """Read stiffness and damping of the model again, after a change."""
        tunable = self._simulator.banks[0].oscillators.tunable
        self._stiffness = np.array(tunable.stiffness) / tunable.inertia
        self.damping = np.array(tunable.damping) / tunable.inertia
        """Damping of each by the wood [1/s], (m,)."""
        self._first_stiffness = self._stiffness[: self.count].copy()
        self._rows = [
            np.ascontiguousarray(sensed_rows(each, self._stiffness, self.damping))
            for each in self._places
        ]
        if self._has_changed():
            self._designed_for = 0.0

    def _has_changed(self) -> bool:
        """Whether the gains were found for another tree."""
        stiffness, damping = self._designed_with
        if not stiffness.all() or not damping.all():
            return True
        stiffer = np.abs(np.log(self._stiffness / stiffness)).max()
        more_damped = np.abs(np.log(self.damping / damping)).max()
        return bool(stiffer > _STIFFER or more_damped > _MORE_DAMPED)

    @property
    def late(self) -> int:
        """Steps by which sensors are read late."""
        return self._lateness.steps

    @property
    def stiffness(self) -> Floats:
        """Stiffness of the coordinates that are corrected [1/s^2], (count,)."""
        return self._first_stiffness

    @property
    def is_active(self) -> bool:
        """Whether a sensor is in use."""
        return bool(self._used)

    def step(
        self, time: float, speed: float, swing: tuple[Floats, ...], n_periods: int = 1
    ) -> Floats:
        """
        Observe a step.

        Parameters
        ----------
        time
            Time of the end of the step in [s].
        speed
            Speed of the mean wind that moves the tree in [m/s], finite.
        swing
            Displacement, rate and force of each coordinate in the wind alone, (m,).
        n_periods
            Number of time steps that were joined to this one.

        Returns
        -------
        Floats
            Correction of displacement and rate, (2, count). The array is reused.

        """
        slot = self._steps % _HISTORY
        self._steps += 1
        self._note_wind(speed)
        m, state = len(self._stiffness), self._swing
        state[:m], state[m : 2 * m], state[2 * m :] = swing
        for k, rows in enumerate(self._rows):
            np.dot(rows, state, out=self._computed[slot, k])
        self._eta[slot] = swing[0]
        # The force of the wind on a tree that stands still.
        n = self.count
        self._forces[slot] = swing[2][:n] + self._air_damping * swing[1][:n]
        beyond = self._beyond(time)
        self._redesign()
        if self._estimate is None:
            self._moved[:] = 0.0
            self._smooth(None)
        elif not self._used:
            self._fade(self._estimate, n_periods)
            self._smooth(None)
        else:
            self._watch_refused(self._estimate, beyond)
            self._learn()
            self._correct(self._estimate, beyond, n_periods)
        self._moved *= self.trust
        self._find_energies(self._first_stiffness, swing[0], swing[1], self._moved, self.energies)
        return self._moved[:2]

    def _note_wind(self, speed: float) -> None:
        """Follow the mean speed of the wind [m/s]."""
        share = self._dt / _RECENT
        if self._steps * self._dt < _RECENT:
            share = 1.0 / self._steps
        self._mean_speed += share * (speed - self._mean_speed)

    @cached_property
    def _find_energies(self) -> Callable[..., None]:
        swing = self._swing
        return entry_of(
            find_energies, self._first_stiffness, swing, swing, self._moved, self.energies
        )

    def _beyond(self, time: float) -> list[Floats | None]:
        """Motion of each sensor beyond the model's, at the step that is late."""
        for k, track in enumerate(self.tracks):
            if track.may_be_used:
                self._lateness.note(k, time, track.sensor.newest)
        self._lateness.settle(time)
        at = self._steps - 1 - self.late
        if at <= self._done:  # more steps late than before: nothing new
            return [None] * len(self.tracks)
        computed, forces = self._computed[at % _HISTORY], self._forces[at % _HISTORY]
        when = time - self.late * self._dt
        found = [track.read(when, rows) for track, rows in zip(self.tracks, computed, strict=True)]
        for row, track, spectrum in zip(found, self.tracks, self._spectra, strict=True):
            if row is not None:
                spectrum.add(track.fitted_motion, forces)
            elif track.is_silent:
                spectrum.skip()
        return found

    @property
    def _is_outdated(self) -> bool:
        speed = max(self._mean_speed, _SLOWEST_WIND)
        return not 1.0 / _REDESIGN < speed / max(self._designed_for, 1e-9) < _REDESIGN

    def _redesign(self) -> None:
        """Find gains for the sensors in use and the present wind, a part at each step."""
        used = tuple(k for k, track in enumerate(self.tracks) if track.in_use)
        if not used:
            self._used, self._designing = (), None
            return
        if self._designing is None:
            if used == self._used and not self._is_outdated:
                return
            self._designed, self._designing = used, self._in_parts(used)
        elif used != self._designed:
            self._designed, self._designing = used, self._in_parts(used)
        found = next(self._designing)
        if found is None:
            return
        self._designing, self._used, self.noise = None, found.used, found.noise
        self._estimate = Estimate(found.gains, self._estimate)
        told = (found.told - _TELLS_LITTLE) / (_TELLS_ENOUGH - _TELLS_LITTLE)
        self._wanted_trust = np.clip(told, 0.0, 1.0)
        for k, track in enumerate(self.tracks):
            track.tells_little = k in found.used and not self._wanted_trust.any()
        self._values = np.zeros(len(found.gains.sensed))
        self._is_known = np.zeros(len(self._values), dtype=np.bool_)
        self._ahead = {}

    def _in_parts(self, used: tuple[int, ...]) -> Iterator[_Design | None]:
        """Find the gains of some sensors; None until they are found."""
        law = self._present_law()
        found = [self._felt(k, self.damped) for k in used]
        sensed = np.concatenate([rows for rows, _ in found])
        noise = np.concatenate([each for _, each in found])
        for doubted in filter_in_parts(law, sensed, _DOUBTED * noise):
            yield None
            if doubted is not None:
                told = told_shares(doubted)
        lag = SMOOTHED_LAG if self._is_smoothed else 0
        for gains in filter_in_parts(law, sensed, _NOISE * noise, lag):
            yield None if gains is None else _Design(used, noise, gains, told)

    def _present_law(self) -> SwayLaw:
        """Find the law of the unknown motion in the present wind, and its covariance."""
        speed = max(self._mean_speed, _SLOWEST_WIND)
        self._designed_for, n = speed, self.count
        unknown = self._unknown = disturbance(self._simulator, speed, n)
        self._designed_with = (self._stiffness, self.damping)
        self._air_damping = unknown.air_damping
        self.damped = self.damping[:n] + self._air_damping
        law = sway_law(
            self._stiffness[:n], self.damped, unknown.covariance, TIME_CONSTANT, self._dt
        )
        self._open = None
        return law

    @property
    def unknown(self) -> Disturbance:
        """What the wind does not tell, in the present wind."""
        if self._unknown is None or (not self._used and self._is_outdated):
            self._present_law()
        assert self._unknown is not None
        return self._unknown

    @property
    def gains(self) -> SteadyFilter | None:
        """Gains of the correction; None before any."""
        return None if self._estimate is None else self._estimate.gains

    def _felt(self, which: int, damping: Floats) -> tuple[Floats, Floats]:
        """Return the measurements of a sensor by the state, (k, 3 n), and their noise, (k,)."""
        track, place, n = self.tracks[which], self._places[which], self.count
        assert track.alignment is not None
        first = PlaceMotion(place.displacement[:, :n], place.rotation[:, :n])
        rows = sensed_rows(first, self._stiffness[:n], damping)
        felt = as_felt(rows, has_gravity=track.alignment.has_gravity).reshape(3, 3, -1)
        uses = list(track.uses)
        return felt[uses].reshape(3 * len(uses), -1), np.repeat(track.noise[uses], 3)

    def _learn(self) -> None:
        """Fit stiffness and damping, a candidate at each step, each time with more motion."""
        if self._fitting is not None:
            found = next(self._fitting, None)
            if found is not None:
                self.fit, self._fitting = found, None
            return
        measured = [(k, self._spectra[k]) for k in self._used if self._spectra[k].count]
        seconds = max((each.seconds for _, each in measured), default=0.0)
        if seconds < self._fit_after or self._unknown is None:
            return
        self._fit_after = _FIT_LATER * seconds
        n = self.count
        stiffness, damping = (each[:n] for each in self._made)
        spectra = [
            Spectrum(
                self._fitted_rows(k, stiffness, damping),
                each.products,
                each.circular,
                each.count,
                each.seconds,
            )
            for k, each in measured
        ]
        unknown = self._unknown
        self._fitting = fits(spectra, stiffness, damping, unknown.air_damping, unknown.covariance)

    def _fitted_rows(self, which: int, stiffness: Floats, damping: Floats) -> Floats:
        """Rows (3, 3 n) of the quantity of a sensor whose spectrum is fitted."""
        place, track, n = self._places[which], self.tracks[which], self.count
        first = PlaceMotion(place.displacement[:, :n], place.rotation[:, :n])
        has_gravity = track.alignment is None or track.alignment.has_gravity
        rows = as_felt(sensed_rows(first, stiffness, damping), has_gravity=has_gravity)
        return rows[3 * track.fitted : 3 * track.fitted + 3]

    def _correct(self, estimate: Estimate, beyond: list[Floats | None], n_periods: int) -> None:
        """Correct the estimate by the measurements of the step that is late."""
        at = self._steps - 1 - self.late
        if at > self._done:
            # More than one step where sensors have become less late.
            n_periods *= min(at - self._done, _LATEST)
            skipped = range(max(self._done + 1, at - _LATEST), at)
            self._done = at
            self._join(beyond)
            estimate.advance(self._values, self._is_known, n_periods)
            share = min(n_periods * self._dt / _TRUSTED_WITHIN, 1.0)
            self.trust += share * (self._wanted_trust - self.trust)
            self._judge(estimate.sizes(), beyond)
            if self._is_smoothed:
                for each in skipped:
                    self._states[each % _HISTORY] = estimate.state[0]
                self._smooth(estimate)
        if not self.late:
            self._moved[:] = estimate.calm
            return
        if self.late not in self._ahead:
            self._ahead[self.late] = estimate.gains.law.ahead(self.late)
        np.multiply(self._ahead[self.late], estimate.calm, out=self._terms)
        np.add.reduce(self._terms, axis=1, out=self._moved)

    def _join(self, beyond: list[Floats | None]) -> None:
        """Join the measurements of the sensors in use, and note which are known."""
        first = 0
        for k in self._used:
            track, row = self.tracks[k], beyond[k]
            picked = track.picked
            rows = slice(first, first + picked.stop - picked.start)
            first = rows.stop
            is_known = self._is_known[rows] = row is not None and track.in_use
            if row is not None and is_known:
                self._values[rows] = row[picked]

    def _judge(self, sizes: list[float], beyond: list[Floats | None]) -> None:
        """Judge the sensors in use by their innovations."""
        first = 0
        for k in self._used:
            track = self.tracks[k]
            last = first + len(track.uses)
            if beyond[k] is not None and track.in_use:
                track.judge(max(sizes[first:last]))
            first = last

    def _watch_refused(self, estimate: Estimate, beyond: list[Floats | None]) -> None:
        """Judge refused sensors by the motion expected without any sensor."""
        state = estimate.state.ravel()
        for k, row in enumerate(beyond):
            if row is None or self.tracks[k].in_use:
                continue
            if self._open is None:
                self._open = stationary_covariance(estimate.gains.law)
            felt, noise = self._felt(k, self.damped)
            expected = np.einsum('ij,jk,ik->i', felt, self._open, felt)
            missed = row[self.tracks[k].picked] - felt @ state
            squares = np.square(missed) / (expected + np.square(_NOISE * noise))
            self.tracks[k].judge(float(squares.reshape(-1, 3).mean(axis=1).max()))

    def _smooth(self, estimate: Estimate | None) -> None:
        """
        Estimate the displacements of the lag ago, and keep them for the window.

        Without a measurement (None) they are those that were estimated then.
        """
        if not self._is_smoothed:
            return
        n, newest = self.count, (self._steps - 1 - self.late) % _HISTORY
        present = self._estimate
        self._states[newest] = 0.0 if present is None else present.state[0]
        then = (newest - SMOOTHED_LAG) % _HISTORY
        added = self._states[then]
        if estimate is not None:
            added = added + estimate.past_change()
        self._smoothed[:-1] = self._smoothed[1:]
        self._smoothed[-1] = self._eta[then]
        self._smoothed[-1, :n] += self.trust * added

    @property
    def smoothed(self) -> Floats:
        """Displacements of `LATE_STEPS` ago by what has been measured since, (m,)."""
        return np.asarray(_WINDOW @ self._smoothed)

    def limit(self, share: float) -> None:
        """Scale the energy of the correction by a share, and count it for the sensors in use."""
        if self._estimate is not None:
            self._estimate.scale(math.sqrt(share))
        for k in self._used:
            self.tracks[k].sensor.counts.clamped += 1

    def reset(self) -> None:
        """Forget the correction; what is known about the sensors stays."""
        self._estimate = self._designing = None
        self._used = ()
        self.trust[:] = 0.0
        self._states[:] = 0.0
        self._eta[:] = 0.0

    def _fade(self, estimate: Estimate, n_periods: int) -> None:
        estimate.move(n_periods)
        estimate.scale(math.exp(-n_periods * self._dt / _FADE))
        self._moved[:] = estimate.calm
