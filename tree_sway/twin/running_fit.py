# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Fits of stiffness and damping while the sensors measure, beside the steps.

From `_KEPT_FROM` of motion on, what a fit tells is kept, and the next one is of later motion
alone, in the air and the leaves of that.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from tree_sway.twin.late_wind import LateWind
from tree_sway.twin.later_work import LaterWork
from tree_sway.twin.sensor_spectrum import SensorSpectrum
from tree_sway.twin.sensor_track import as_felt, sensed_rows, SensorTrack
from tree_sway.twin.sway_watch import SwayWatch
from tree_sway.twin.tree_fit import fit_of, Known, N_CANDIDATES, Spectrum, TreeFit
from tree_sway.twin.unknown_motion import UnknownMotion

_FIRST, _LATER, _LATEST = 40.0, 1.4, 600.0
"""
Motion in [s] from which the tree is first fitted, how much more there is each time, and most that
is awaited.
"""

_KEPT_FROM = 600.0
"""Motion in [s] from which on what it tells is kept for the fits of later motion."""

_SOON = 5.0
"""Time in [s] that a fit waits for the first stretch of further sensors."""


class RunningFit:
    """
    The last fit of a tree, and the next one.

    Parameters
    ----------
    unknown
        Law of the unknown motion; its model is the one that fits are relative to.
    tracks
        Sensors.
    wind
        Wind of the tree, which may be known late; None for one that is not.

    """

    def __init__(
        self,
        unknown: UnknownMotion,
        tracks: Sequence[SensorTrack],
        wind: LateWind | None = None,
    ) -> None:
        self._unknown, self._tracks, self._wind = unknown, tracks, wind or LateWind()
        n = unknown.count
        frequency, dt = unknown.frequency, unknown.dt
        self._spectra = [SensorSpectrum(frequency, dt, n) for _ in tracks]
        self.watches = [SwayWatch(each, frequency) for each in self._spectra]
        """Whether the tree still sways as it did, by each sensor."""
        self._uses: list[tuple[int, ...]] = [()] * len(tracks)
        self._stiffness, self._damping = unknown.all_stiffness[:n], unknown.all_damping[:n]
        self._noted, self._powers = [0] * len(tracks), [0.0] * len(tracks)
        self._weight, self._air, self._forces = 0.0, np.zeros(n), np.zeros((n, n))
        self._east = self._north = 0.0
        self._n_winds = 0
        self._work: LaterWork[tuple[TreeFit, Known]] | None = None
        self._known: Known | None = None
        self._is_kept = False
        self._fit_after = _FIRST
        self.found: TreeFit | None = None
        """Stiffness and damping by the sensors, over those of the model as it was made."""

    def follow(self, before: RunningFit) -> None:
        """Go on from a fit before, whose model is as it was made."""
        self._stiffness, self._damping = before._stiffness, before._damping
        self.found, self._known = before.found, before._known

    def note(self, east: float, north: float) -> None:
        """Note the wind of a step in [m/s], and go on with the spectra of what was read."""
        self._east += east
        self._north += north
        self._n_winds += 1
        for k, track in enumerate(self._tracks):
            if track.uses != self._uses[k]:
                self._begin(k)
            if self._spectra[k].advance():
                if self._spectra[k].count != self._noted[k]:
                    self._spectra[k].note_noise(track.fitted_noise, track.watched_noise)
                    self._note_air(k)
                self.watches[k].advance((self._east, self._north, self._n_winds))
            elif track.is_silent:
                self._spectra[k].skip()

    def skip(self) -> None:
        """Leave out a step of which the wind is not known."""
        for each in self._spectra:
            each.skip()

    def _note_air(self, which: int) -> None:
        """
        Note by which air a stretch was damped, and which forces moved it.

        A spectrum is that of hours: with the air of a calm that came last, the wood would seem to
        damp as the wind before did.
        """
        spectrum, forces = self._spectra[which], self._unknown.forces
        added = spectrum.power - self._powers[which]
        self._noted[which], self._powers[which] = spectrum.count, spectrum.power
        if forces is None:
            return
        self._weight += added
        self._air += added * self._unknown.mean_speed / forces.speed * forces.air_damping
        self._forces += added / max(np.trace(forces.covariance), 1e-300) * forces.covariance

    def _begin(self, which: int) -> None:
        """Begin the spectrum of a sensor whose quantities have changed anew."""
        track = self._tracks[which]
        self._uses[which] = track.uses
        self._noted[which], self._powers[which] = 0, 0.0
        first, second = 3 * track.fitted, 3 * track.uses[0]
        n = len(self._stiffness)
        frequency = self._unknown.frequency
        spectrum = SensorSpectrum(frequency, self._unknown.dt, n, first, second)
        self._spectra[which] = spectrum
        track.native.series = spectrum.native.at
        self.watches[which] = SwayWatch(spectrum, frequency)

    def advance(self, used: Sequence[int]) -> None:
        """Go on with a fit, or begin one by the sensors in use once there is enough motion."""
        if self._work is not None:
            found = self._work.advance()
            if found is not None:
                self._work = None
                self.found, known = found
                if self._is_kept:
                    self._known = known.later()
            return
        measured = [k for k in used if self._spectra[k].new_stretches]
        seconds = max((self._spectra[k].seconds for k in measured), default=0.0)
        if seconds < self._fit_after or not self._weight:
            return
        spectra = [self._spectra[k] for k in used]
        if any(not each.count and each.until_first < _SOON for each in spectra):
            return
        self._fit_after = min(_LATER * seconds, seconds + _LATEST)
        find = partial(
            fit_of,
            [self._spectrum(k) for k in measured],
            self._stiffness,
            self._damping,
            self._air / self._weight,
            self._forces / self._weight,
            1.0 if self.found is None else self.found.drag,
            self._known,
        )
        self._work = LaterWork(find, N_CANDIDATES * len(measured) + 1)
        self._is_kept = any(self._spectra[k].new_seconds >= _KEPT_FROM for k in measured)
        if self._is_kept:
            for each in self._spectra:
                each.take_products()
            self._weight = 0.0
            self._air[:], self._forces[:] = 0.0, 0.0

    def _spectrum(self, which: int) -> Spectrum:
        """Spectrum of a sensor, and its rows by the model as it was made."""
        track, measured = self._tracks[which], self._spectra[which]
        has_gravity = track.alignment is None or track.alignment.has_gravity
        motion = track.motion.first(len(self._stiffness))
        rows = sensed_rows(motion, self._stiffness, self._damping)
        felt = as_felt(rows, has_gravity=has_gravity)
        products = measured.products.copy()
        # Of forces with motion: they would have come sooner, had their wind been known.
        sooner = np.exp(1j * self._wind.known_late * measured.circular)
        products[:, 2:, :2] *= sooner[:, None, None]
        return Spectrum(
            felt[3 * track.fitted : 3 * track.fitted + 3],
            products,
            measured.circular,
            measured.new_stretches,
            measured.new_seconds,
            measured.noise,
        )
