# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Fits of stiffness and damping while the sensors measure, a candidate at each step."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.observe.sensor_place import PlaceMotion
from tree_sway.core.observe.sensor_spectrum import SensorSpectrum
from tree_sway.core.observe.sensor_track import as_felt, sensed_rows, SensorTrack
from tree_sway.core.observe.tree_fit import fits, Spectrum, TreeFit
from tree_sway.core.observe.unknown_motion import UnknownMotion

_FIRST, _LATER = 40.0, 1.4
"""Motion in [s] from which the tree is first fitted, and how much more there is each time."""


_SOON = 5.0
"""Time in [s] that a fit waits for the first stretch of further sensors."""


class RunningFit:
    """
    The last fit of a tree, and the next one.

    Parameters
    ----------
    unknown
        Law of the unknown motion; its model is the one that fits are relative to.
    tracks, places
        Sensors, and how each is moved by the coordinates of the model.
    frequency
        First frequency of the model in [Hz].
    dt
        Time step in [s].

    """

    def __init__(
        self,
        unknown: UnknownMotion,
        tracks: Sequence[SensorTrack],
        places: Sequence[PlaceMotion],
        frequency: float,
        dt: float,
    ) -> None:
        self._unknown, self._tracks = unknown, tracks
        n = unknown.count
        self._places = [each.first(n) for each in places]
        self._spectra = [SensorSpectrum(frequency, dt, n) for _ in tracks]
        self._stiffness, self._damping = unknown.all_stiffness[:n], unknown.all_damping[:n]
        self._parts: Iterator[TreeFit | None] | None = None
        self._fit_after = _FIRST
        self.found: TreeFit | None = None
        """Stiffness and damping by the sensors, over those of the model as it was made."""

    def add(self, is_known: NDArray[np.bool_], forces: Floats) -> None:
        """Add the motion that sensors have just read, and the forces of the wind then, (n,)."""
        for known, track, spectrum in zip(
            is_known.tolist(), self._tracks, self._spectra, strict=True
        ):
            if known:
                spectrum.add(track.fitted_motion, forces)
            elif track.is_silent:
                spectrum.skip()

    def advance(self, used: Sequence[int]) -> None:
        """Fit a part, or begin a fit by the sensors in use once there is enough motion."""
        if self._parts is not None:
            found = next(self._parts, None)
            if found is not None:
                self.found, self._parts = found, None
            return
        measured = [k for k in used if self._spectra[k].count]
        seconds = max((self._spectra[k].seconds for k in measured), default=0.0)
        forces = self._unknown.forces
        if seconds < self._fit_after or forces is None:
            return
        spectra = [self._spectra[k] for k in used]
        if any(not each.count and each.until_first < _SOON for each in spectra):
            return
        self._fit_after = _LATER * seconds
        self._parts = fits(
            [self._spectrum(k) for k in measured],
            self._stiffness,
            self._damping,
            forces.air_damping,
            forces.covariance,
        )

    def _spectrum(self, which: int) -> Spectrum:
        """Spectrum of a sensor, and its rows by the model as it was made."""
        track, measured = self._tracks[which], self._spectra[which]
        has_gravity = track.alignment is None or track.alignment.has_gravity
        rows = sensed_rows(self._places[which], self._stiffness, self._damping)
        felt = as_felt(rows, has_gravity=has_gravity)
        return Spectrum(
            felt[3 * track.fitted : 3 * track.fitted + 3],
            measured.products,
            measured.circular,
            measured.count,
            measured.seconds,
        )
