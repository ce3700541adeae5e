# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Filter of the motion of a tree beyond that of the model, from all of its sensors.

The observer holds the difference between the real and the computed motion on the first coordinates
of a model. At each step the difference moves by its own law, and what the sensors measure beyond
the model corrects it (`estimate`). Sensors that are late are read at an earlier step, and the
difference is moved on to the present. Without a usable sensor the difference fades.

The motion of the present is the calm one of `Estimate`.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import Any, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.native import address, LIBRARY, NativeCorrection
from tree_sway.core.setup import one_thread
from tree_sway.twin.disturbance import crown_slope
from tree_sway.twin.estimate import Estimate
from tree_sway.twin.gain_design import GainDesign, Gains
from tree_sway.twin.late_wind import LateWind
from tree_sway.twin.running_fit import RunningFit
from tree_sway.twin.sensor_place import place_motion
from tree_sway.twin.sensor_readings import LATEST, SensorReadings
from tree_sway.twin.sensor_track import lean_per_load, SensorTrack
from tree_sway.twin.steady_filter import SteadyFilter
from tree_sway.twin.sway_watch import SwayChange
from tree_sway.twin.tree_fit import TreeFit
from tree_sway.twin.unknown_motion import UnknownMotion

if TYPE_CHECKING:
    from tree_sway.core.run import SwaySimulator

MOST_COORDINATES = 32
"""Largest number of coordinates that sensors correct."""

_USUAL_WIND = 7.0
"""Wind in [m/s] whose loads tell by how much more a place leans to one side than to another."""

_FADE = 0.3
"""Time constant in [s] with which the correction fades without a sensor."""

_TRUSTED_WITHIN = 2.0
"""Time constant in [s] with which the applied shares follow those of new gains."""


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
    before
        The observer before, whose fit goes on; None for a model that is as it was made.
    wind
        Wind of the tree, which is made as late as the sensors tell.

    """

    def __init__(
        self,
        simulator: SwaySimulator,
        tracks: Sequence[SensorTrack],
        dt: float,
        *,
        before: Observer | None = None,
        wind: LateWind | None = None,
    ) -> None:
        self.tracks, self._dt = list(tracks), dt
        oscillators: Any = simulator.banks[0].oscillators
        swing = oscillators.swing
        self._wind = wind = wind or LateWind()
        n = self.count = min(MOST_COORDINATES, oscillators.shapes.shape[1])
        """Number of coordinates that are corrected."""
        for track in self.tracks:
            track.motion = place_motion(simulator, track.sensor.place)
        with one_thread():
            self.unknown = UnknownMotion(simulator, n, dt)
            """Stiffness and damping of the model, and what the wind does not tell."""
            self._readings = SensorReadings(self.unknown, self.tracks, swing, wind)
            load = crown_slope(simulator, _USUAL_WIND, oscillators.shapes.shape[1])[:2]
            for track in self.tracks:
                track.bend = lean_per_load(track.motion, self.unknown.all_stiffness, load)
        self._fit = RunningFit(self.unknown, self.tracks, wind)
        if before is not None:
            self._fit.follow(before._fit)
        self._design = GainDesign(self.unknown, self.tracks)
        self._step, self._done = -1, -1
        self._estimate: Estimate | None = None
        self.trust = np.zeros(n)
        """Share of the correction of each coordinate that is applied [-], (count,)."""
        self._wanted_trust = np.zeros(n)
        self.leaning = np.zeros(n)
        """Share of the lean of each that is applied where a sensor tells enough [-], (count,)."""
        self.noise = np.zeros(0)
        """Standard deviation of the noise of the measurements in use, (p,)."""
        self._ahead: dict[int, tuple[Floats, int]] = {}
        self._swing_at = [address(each) for each in swing[:2]]
        self.push = np.zeros((n, oscillators.shapes.shape[1]))
        """Force on each coordinate of the model by that of each corrected one (`push_of`)."""
        self._moved = np.zeros((3, n))
        self.energies = np.zeros(2)
        """
        Energies of the corrected and of the uncorrected motion, (2,).

        Both are twice those per unit mass, and 0 before a sensor was in use.
        """
        self._find_native()

    def refresh(self) -> None:
        """Read stiffness and damping of the model again, after a change."""
        self.unknown.read_model()
        self.unknown.forget_changed_model()
        self._readings.read_model()
        self._find_native()

    def _find_native(self) -> None:
        """Let the native core correct the present model."""
        self._native = NativeCorrection(
            coordinates=self.count, stiffness=self.stiffness,
            wanted=self._wanted_trust, trust=self.trust, leaning=self.leaning,
            moved=self._moved, energies=self.energies,
        )  # fmt: skip

    @property
    def late(self) -> int:
        """Steps by which sensors are read late."""
        return int(self._readings.native.late)

    @property
    def stiffness(self) -> Floats:
        """Stiffness of the coordinates that are corrected [1/s^2], (count,)."""
        return self.unknown.stiffness

    @property
    def gains(self) -> SteadyFilter | None:
        """Gains of the correction; None before any."""
        return None if self._estimate is None else self._estimate.gains

    @property
    def fit(self) -> TreeFit | None:
        """Stiffness and damping by the sensors, over those of the model as it was made."""
        return self._fit.found

    @property
    def mean_wind(self) -> float:
        """Mean speed of the wind in the last half minute in [m/s]."""
        return self.unknown.mean_speed

    def sway_change(self, sensor: int) -> SwayChange | None:
        """Return how the sway has changed by a sensor; None before there is a past."""
        return self._fit.watches[sensor].change

    @property
    def is_active(self) -> bool:
        """Whether a sensor is in use."""
        return bool(self._design.used)

    def step(
        self,
        time: float,
        wind: tuple[float, float, float],
        n_periods: int = 1,
    ) -> Floats:
        """
        Observe a step.

        Parameters
        ----------
        time
            Time of the end of the step in [s].
        wind
            Mean wind that moves the tree in [m/s], finite.
        n_periods
            Number of time steps that were joined to this one.

        Returns
        -------
        Floats
            Correction of displacement, rate and force, (3, count). The array is reused.

        """
        self._step += 1
        if self._wind.moves_model:
            self.unknown.note_wind(*wind)
        at = self._readings.read(time, self._step, self._done)
        if not self._wind.moves_model:
            self._fit.skip()
        elif at >= 0:
            self._fit.note(wind[0], wind[1])
        gains = self._design.advance()
        if gains is not None:
            self._take(gains)
        if self._estimate is not None:
            self._judge_refused(self._estimate)
            if self.is_active:
                self._fit.advance(self._design.used)
                self._correct(self._estimate, at, n_periods)
            else:
                self._fade(self._estimate, n_periods)
        return self._moved

    def _take(self, gains: Gains) -> None:
        """Go on with other gains."""
        picked = [self.tracks[k].picked for k in gains.used]
        # Where each measurement is among the readings, (k, 9).
        rows = [9 * k + np.arange(9)[each] for k, each in zip(gains.used, picked, strict=True)]
        self._estimate = Estimate(gains.filter, np.concatenate(rows), self._estimate)
        self.noise, self._wanted_trust[:] = gains.noise, gains.trust
        self.leaning[:], self.push[:] = gains.leaning, gains.push
        for k in gains.used:
            self.tracks[k].tells_little = not gains.trust.any()
        self._ahead = {}

    def _correct(self, estimate: Estimate, at: int, n_periods: int) -> None:
        """Correct the estimate by the measurements of a step, unless it was done before."""
        share = 0.0
        if at >= 0:
            # More than one step where sensors have become less late.
            n_periods *= min(at - self._done, LATEST)
            estimate.advance(self._readings.native, n_periods)
            share = min(n_periods * self._dt / _TRUSTED_WITHIN, 1.0)
            self._done = at
        self._carry(estimate, self._readings.native.late, share)

    def _carry(self, estimate: Estimate, late: int, share: float) -> None:
        """Bring the calm motion to the present, where trust goes a share of its way."""
        if late not in self._ahead:
            ahead = estimate.gains.law.ahead(late)
            self._ahead[late] = ahead, address(ahead)
        _, ahead_at = self._ahead[late]
        LIBRARY.sway_carry(self._native.at, ahead_at, estimate.calm_at, share, *self._swing_at)

    def _judge_refused(self, estimate: Estimate) -> None:
        """Judge refused sensors by the motion expected without any sensor."""
        for k, track in enumerate(self.tracks):
            if track.in_use or not self._readings.is_known[k]:
                continue
            felt, noise = self._design.felt(k)
            expected = np.einsum('ij,jk,ik->i', felt, self.unknown.variance, felt)
            missed = self._readings.beyond[k, track.picked] - felt @ estimate.state.ravel()
            squares = np.square(missed) / (expected + np.square(noise))
            track.judge(float(squares.reshape(-1, 3).mean(axis=1).max()))

    def limit(self, share: float) -> None:
        """Scale the energy of the correction by a share, and count it for the sensors in use."""
        if self._estimate is not None:
            self._estimate.scale(math.sqrt(share))
        for k in self._design.used:
            self.tracks[k].sensor.counts.clamped += 1

    def reset(self) -> None:
        """Forget the correction; what is known about the sensors stays."""
        self._estimate = None
        self._design.stop()
        for each in (self.trust, self._moved, self.energies):
            each[:] = 0.0

    def _fade(self, estimate: Estimate, n_periods: int) -> None:
        estimate.move(n_periods)
        estimate.scale(math.exp(-n_periods * self._dt / _FADE))
        self._carry(estimate, 0, 0.0)
