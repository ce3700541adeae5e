# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What sensors tell about the motion of a tree beyond that in the wind alone.

The observer holds the difference between the real and the computed motion on the first coordinates
of a model. At each step the difference moves by its own law, and what the sensors measure beyond
the model corrects it (`steady_filter`). Sensors that are late are read at an earlier step, and the
difference is moved on to the present. Without a usable sensor the difference fades.

Two sets of gains are kept. The causal one expects more noise than the sensors have, since noise
would otherwise shake branches that no sensor sees. The one of the smoother trusts them, and is
late by a fixed lag.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.observe.disturbance import Disturbance, disturbance, TIME_CONSTANT
from tree_sway.core.observe.sensor_place import place_motion, PlaceMotion
from tree_sway.core.observe.sensor_track import as_felt, ROWS, sensed_rows, SensorTrack
from tree_sway.core.observe.steady_filter import (
    stationary_covariance,
    steady_filter,
    SteadyFilter,
    sway_law,
    SwayLaw,
)
from tree_sway.core.observe.tree_fit import fits, Spectrum, TreeFit

if TYPE_CHECKING:
    from tree_sway.core.run.simulator import SwaySimulator

MOST_COORDINATES = 32
"""Largest number of coordinates that sensors correct."""

_CAUSAL, _SMOOTH = 8.0, 3.5
"""Noise for which gains are found, over the noise of the sensors."""

_FADE = 0.3
_CLIPPED = 6.0
_HISTORY = 64
_LATEST = 30
_RECENT = 30.0
_REDESIGN = 1.6
_SLOWEST_WIND = 2.0
_FIRST_FIT, _FIT_LATER = 40.0, 1.4

SMOOTHED_LAG, _WINDOW = 6, np.hanning(9)[1:-1] / np.hanning(9)[1:-1].sum()
"""Steps between the smoother's estimate and its newest measurement, and the window over it."""

LATE_STEPS = SMOOTHED_LAG + len(_WINDOW) // 2
"""Steps by which the smoothed state is late."""


@dataclass
class _Estimate:
    """A filter, its state (3, m), and the innovations of the last steps (l, p)."""

    gains: SteadyFilter
    state: Floats
    innovations: Floats

    def move(self, n_periods: int) -> None:
        """Move the state by a number of steps."""
        for _ in range(n_periods):
            self.state = (self.gains.law.step * self.state).sum(axis=1)

    def correct(self, beyond: Floats, known: NDArray[np.bool_]) -> Floats:
        """Correct the state by measurements (p,), where known; return the innovations."""
        gains = self.gains
        innovation = beyond - gains.sensed @ self.state.ravel()
        innovation[~known] = 0.0
        limit = _CLIPPED * gains.deviation
        used = np.clip(innovation, -limit, limit)
        self.state += (gains.gain @ used).reshape(self.state.shape)
        self.innovations[:-1] = self.innovations[1:]
        self.innovations[-1] = used
        return innovation


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
        self.late = 0
        """Steps by which sensors are read late."""
        self._computed = np.zeros((_HISTORY, len(self.tracks), ROWS))
        self._eta = np.zeros((_HISTORY, shapes.shape[1]))
        self._states = np.zeros((_HISTORY, self.count))
        self._smoothed = np.zeros((len(_WINDOW), shapes.shape[1]))
        self._steps = 0
        self._done = -1
        self._used: tuple[int, ...] = ()
        self._designed_for = 0.0
        self._mean_speed = self._gustiness = 0.0
        self.share = 0.0
        """Energy of the correction over that of the whole motion, a running mean [-]."""
        self._causal: _Estimate | None = None
        self._late_one: _Estimate | None = None
        self._unknown: Disturbance | None = None
        self._fitting: Iterator[TreeFit | None] | None = None
        self._fit_after = _FIRST_FIT
        self.fit: TreeFit | None = None
        """Stiffness and damping by the sensors, over those of the model as it was made."""
        self._made = (0.0 * shapes[0], 0.0 * shapes[0])
        self._open = np.zeros((3 * self.count, 3 * self.count))
        self._damped = np.zeros(self.count)
        self._ahead: list[Floats] = []
        self.refresh()
        self._made = (self._stiffness, self._damping)

    def refresh(self) -> None:
        """Read stiffness and damping of the model again, after a change."""
        tunable = self._simulator.banks[0].oscillators.tunable
        self._stiffness = np.array(tunable.stiffness) / tunable.inertia
        self._damping = np.array(tunable.damping) / tunable.inertia
        rows = [sensed_rows(each, self._stiffness, self._damping) for each in self._places]
        self._rows = np.concatenate([np.zeros((0, 3 * len(self._stiffness))), *rows])
        self._designed_for = 0.0

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
            Speed of the mean wind in [m/s].
        swing
            Displacement, rate and force of each coordinate in the wind alone, (m,).
        n_periods
            Number of time steps that were joined to this one.

        Returns
        -------
        Floats
            Correction of displacement and rate, (2, count).

        """
        slot = self._steps % _HISTORY
        self._steps += 1
        share = self._dt / _RECENT
        if self._steps * self._dt < _RECENT:
            share = 1.0 / self._steps
        self._mean_speed += share * (speed - self._mean_speed)
        self._gustiness += share * ((speed - self._mean_speed) ** 2 - self._gustiness)
        state = np.concatenate(swing)
        self._computed[slot] = (self._rows @ state).reshape(-1, ROWS)
        self._eta[slot] = swing[0]
        beyond = self._beyond(time)
        used = tuple(k for k, track in enumerate(self.tracks) if track.in_use)
        if used != self._used or (used and self._is_outdated):
            self._design(used)
        if self._causal is None:
            return np.zeros((2, self.count))
        if not self._used:
            return self._fade(n_periods)
        self._watch_refused(beyond)
        self._learn()
        return self._correct(self._causal, beyond, swing, n_periods)

    def _beyond(self, time: float) -> list[Floats | None]:
        """Motion of each sensor beyond the model's, at the step that is late."""
        at = self._steps - 1 - self.late
        if at <= self._done:  # more steps late than before: nothing new
            return [None] * len(self.tracks)
        computed = self._computed[at % _HISTORY]
        when = time - self.late * self._dt
        found = [track.read(when, rows) for track, rows in zip(self.tracks, computed, strict=True)]
        newest = [track.sensor.newest for track in self.tracks if track.in_use]
        if (
            newest
            and max(newest) < when - 0.01 * self._dt
            and time - max(newest) < _LATEST * self._dt
        ):
            self.late = min(self.late + 1, _LATEST)
        return found

    @property
    def _is_outdated(self) -> bool:
        speed = max(self._mean_speed, _SLOWEST_WIND)
        return not 1.0 / _REDESIGN < speed / max(self._designed_for, 1e-9) < _REDESIGN

    def _design(self, used: tuple[int, ...]) -> None:
        """Find the gains for the sensors in use and the present wind."""
        self._used = used
        if not used:
            return
        law = self._present_law()
        sensed, noise = self._measurements(self._damped)
        self._causal = self._renewed(self._causal, law, sensed, _CAUSAL * noise, 0)
        if self._is_smoothed:
            self._late_one = self._renewed(
                self._late_one, law, sensed, _SMOOTH * noise, SMOOTHED_LAG
            )
        self._ahead = [law.ahead(k) for k in range(_LATEST + 1)]

    def _present_law(self) -> SwayLaw:
        """Find the law of the unknown motion in the present wind, and its covariance."""
        speed = max(self._mean_speed, _SLOWEST_WIND)
        self._designed_for, n = speed, self.count
        unknown = self._unknown = disturbance(self._simulator, speed, n)
        self._damped = self._damping[:n] + unknown.air_damping
        law = sway_law(
            self._stiffness[:n], self._damped, unknown.covariance, TIME_CONSTANT, self._dt
        )
        self._open = stationary_covariance(law)
        return law

    def _measurements(self, damping: Floats) -> tuple[Floats, Floats]:
        """Measurements of the sensors in use by the state, (p, 3 n), and their noise."""
        found = [self._felt(k, damping) for k in self._used]
        return np.concatenate([rows for rows, _ in found]), np.concatenate([n for _, n in found])

    def _felt(self, which: int, damping: Floats) -> tuple[Floats, Floats]:
        """Return the measurements of a sensor by the state, (k, 3 n), and their noise, (k,)."""
        track, place, n = self.tracks[which], self._places[which], self.count
        assert track.alignment is not None
        first = PlaceMotion(place.displacement[:, :n], place.rotation[:, :n])
        rows = sensed_rows(first, self._stiffness[:n], damping)
        felt = as_felt(rows, has_gravity=track.alignment.has_gravity).reshape(3, 3, -1)
        uses = list(track.uses)
        return felt[uses].reshape(3 * len(uses), -1), np.repeat(track.noise[uses], 3)

    def _picked(self, which: int, row: Floats) -> Floats:
        """Pick the measured quantities of a row (9,) of a sensor."""
        return np.asarray(row.reshape(3, 3)[list(self.tracks[which].uses)].ravel())

    def _renewed(
        self, old: _Estimate | None, law: SwayLaw, sensed: Floats, noise: Floats, lag: int
    ) -> _Estimate:
        """Return an estimate with other gains that continues from an old one."""
        state = np.zeros((3, self.count)) if old is None else old.state
        gains = steady_filter(law, sensed, noise, lag)
        return _Estimate(gains, state, np.zeros((max(lag, 1), len(sensed))))

    def _learn(self) -> None:
        """Fit stiffness and damping, one candidate a step, each time with more motion."""
        if self._fitting is not None:
            found = next(self._fitting, None)
            if found is not None:
                self.fit, self._fitting = found, None
            return
        tracks = [(k, self.tracks[k]) for k in self._used if self.tracks[k].spectrum.count]
        seconds = max((track.spectrum.seconds for _, track in tracks), default=0.0)
        if seconds < self._fit_after or self._unknown is None:
            return
        self._fit_after = _FIT_LATER * seconds
        n = self.count
        stiffness, damping = (each[:n] for each in self._made)
        spectra = [
            Spectrum(
                self._fitted_rows(k, stiffness, damping), track.spectrum.power[:2],
                track.spectrum.circular, track.spectrum.count, track.spectrum.seconds,
            )
            for k, track in tracks
        ]  # fmt: skip
        unknown = self._unknown
        self._fitting = fits(spectra, stiffness, damping, unknown.air_damping, unknown.covariance)

    def _fitted_rows(self, which: int, stiffness: Floats, damping: Floats) -> Floats:
        """Rows (3, 3 n) of the quantity of a sensor whose spectrum is fitted."""
        place, track, n = self._places[which], self.tracks[which], self.count
        first = PlaceMotion(place.displacement[:, :n], place.rotation[:, :n])
        has_gravity = track.alignment is None or track.alignment.has_gravity
        rows = as_felt(sensed_rows(first, stiffness, damping), has_gravity=has_gravity)
        return rows[3 * track.fitted : 3 * track.fitted + 3]

    def _correct(
        self,
        causal: _Estimate,
        beyond: list[Floats | None],
        swing: tuple[Floats, ...],
        n_periods: int,
    ) -> Floats:
        at, late, n = self._steps - 1 - self.late, self._late_one, self.count
        if at > self._done:
            self._done = at
            values, known = self._joined(beyond)
            causal.move(n_periods)
            self._judge(causal.correct(values, known), known)
            if late is not None:
                late.move(n_periods)
                late.correct(values, known)
                self._smooth(late, at % _HISTORY)
        moved = causal.state
        if self.late:
            moved = (self._ahead[self.late] * moved).sum(axis=1)
        self._note_share(moved, swing)
        return np.asarray(moved[:2, :n])

    def _joined(self, beyond: list[Floats | None]) -> tuple[Floats, NDArray[np.bool_]]:
        """Return the measurements of the sensors in use, (p,), and which are known."""
        values, known = list[Floats](), list[bool]()
        for k in self._used:
            row, size = beyond[k], 3 * len(self.tracks[k].uses)
            values.append(np.zeros(size) if row is None else self._picked(k, row))
            known += [row is not None] * size
        return np.concatenate(values), np.array(known)

    def _judge(self, innovation: Floats, known: NDArray[np.bool_]) -> None:
        first = 0
        assert self._causal is not None
        deviation = self._causal.gains.deviation
        for k in self._used:
            track = self.tracks[k]
            rows = slice(first, first + 3 * len(track.uses))
            if known[rows].all():
                track.judge(innovation[rows], deviation[rows])
            first = rows.stop

    def _watch_refused(self, beyond: list[Floats | None]) -> None:
        """Judge refused sensors by the motion expected without any sensor."""
        assert self._causal is not None
        state = self._causal.state.ravel()
        for k, row in enumerate(beyond):
            if row is None or k in self._used:
                continue
            felt, noise = self._felt(k, self._damped)
            expected = np.einsum('ij,jk,ik->i', felt, self._open, felt)
            missed = self._picked(k, row) - felt @ state
            self.tracks[k].judge(missed, np.sqrt(expected + np.square(_CAUSAL * noise)))

    def _note_share(self, moved: Floats, swing: tuple[Floats, ...]) -> None:
        n = self.count
        whole = swing[0][:n] + moved[0]
        own = float(self._stiffness[:n] @ np.square(moved[0]))
        total = float(self._stiffness[:n] @ np.square(whole)) + own
        self.share += self._dt / _RECENT * (own / max(total, 1e-300) - self.share)

    def _smooth(self, late: _Estimate, newest: int) -> None:
        """Estimate the displacements of the lag ago, and keep them for the window."""
        n, lag = self.count, SMOOTHED_LAG
        innovations = late.innovations
        self._states[newest] = late.state[0]
        then = (newest - lag) % _HISTORY
        self._smoothed[:-1] = self._smoothed[1:]
        self._smoothed[-1] = self._eta[then]
        backward = late.gains.backward.reshape(n, -1)
        self._smoothed[-1, :n] += self._states[then] + backward @ innovations.ravel()

    @property
    def smoothed(self) -> Floats:
        """Displacements of `LATE_STEPS` ago by what has been measured since, (m,)."""
        return np.asarray(_WINDOW @ self._smoothed)

    def tip_deviation(self, tips: Floats) -> Floats:
        """
        Find the standard deviation of tips whose motion by each coordinate is known.

        Parameters
        ----------
        tips
            Displacement per unit of each coordinate in [m], (k, m).

        Returns
        -------
        Floats
            Standard deviations in [m], (k,).

        """
        n = self.count
        if self._used and self._causal is not None:
            known = self._causal.gains.covariance[:n, :n]
        else:
            if self._is_outdated:
                self._present_law()
            known = self._open[:n, :n]
        first = tips[:, :n]
        return np.sqrt(np.maximum(((first @ known) * first).sum(axis=1), 0.0))

    def energy(self, eta: Floats, rate: Floats) -> float:
        """Twice the energy of displacements and rates of the first coordinates, (count,)."""
        stiffness = self._stiffness[: self.count]
        return float(stiffness @ np.square(eta) + rate @ rate)

    def limit(self, share: float) -> None:
        """Scale the energy of the correction by a share, and count it for the sensors in use."""
        for each in (self._causal, self._late_one):
            if each is not None:
                each.state *= math.sqrt(share)
        for k in self._used:
            self.tracks[k].sensor.counts.clamped += 1

    def reset(self) -> None:
        """Forget the correction; what is known about the sensors stays."""
        self._causal = self._late_one = None
        self._used = ()
        self._states[:] = 0.0
        self._eta[:] = 0.0

    def _fade(self, n_periods: int) -> Floats:
        decay = math.exp(-n_periods * self._dt / _FADE)
        for each in (self._causal, self._late_one):
            if each is not None:
                each.move(n_periods)
                each.state *= decay
        assert self._causal is not None
        return np.asarray(self._causal.state[:2])
