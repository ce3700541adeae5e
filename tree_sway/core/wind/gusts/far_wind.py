# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind of a crown that stands apart from its anemometer: the expected one, or a sample.

Two places share gusts of wavenumber k [1/m] by the root coherence of Davenport (1961, Quarterly
Journal of the Royal Meteorological Society 87, 194-211), and the one downwind has them later by
the way x along the wind (Taylor 1938)::

    G(k) = exp(-k |(3 x, 10 y, 10 z)|) exp(-2 pi i k x)

Everything is a law of the wavenumber, so that the run of the wind [m] takes the place of time and
nothing depends on the wind speed. The expected wind of a limb, given that of the anemometer up to
now, is its mean and a sum of low-passed deviations from it, of the lengths `LENGTHS`,
``E(k) = sum_j w_j / (1 + 2 pi i k L_j)``. Their weights have the least error of the sway in
turbulence of Kaimal's spectrum S::

    integral S(k) |H(k)|^2 |G(k) - E(k)|^2 dk

the projection of Wiener's causal filter (1949, Extrapolation, Interpolation, and Smoothing of
Stationary Time Series) on these stages. |H|^2 is the response of the first mode to the wind, mean
over the winds of `_WINDS`: gusts near its frequency move the tree most, and those that are faster
hardly. What it does not know still loads the tree: where the wind is the expected one, its missing
variance is added to the square of the speed, as E[U^2] = E[U]^2 + var U.

A sample adds what may be: a drawn field. Limbs share gusts by the same law, C, and of those what
is expected, which all limbs share, is no more to be drawn: its cross spectra are
``S (C_ij - |E_i| |E_j|)``. With it the wind of each limb has the spectrum of turbulence, that of
the crown no more than it, and both follow the measured one as far as that tells. An anemometer
tells more in a wind along the way to it than across it: a field is drawn for either, by the same
numbers, and mixed by the direction of the mean wind.

Of gusts that are smaller than what they move ``1 / (1 + C k l)`` of the power acts. Up to the
first frequency of the tree that is a whole part, and above it less: the frequency of a branch
falls with the square root of its length, so modes at a frequency f move pieces of a length that
falls as ``f^-2``, ``l = size min(1, 2 / (1 + (f / f_1)^2))``.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np

from tree_sway.core.arrays import Complexes, Floats, Ints, Singles
from tree_sway.core.native import Address, contiguous, LIBRARY, NativeFarWind
from tree_sway.core.wind.turbulence import Turbulence

_DECAYS = np.array([3.0, 10.0, 10.0])
"""Davenport's C along the wind, across it and up [-]."""

LENGTHS = np.array([1.0, 4.0, 16.0, 64.0, 256.0])
"""Lengths of the low-passes [m]."""

_WITHIN = 9.0
"""
Davenport's C among the parts of a crown, all directions alike [-]: 10, and 7 along the wind, where
travel (2 pi) tells gusts apart too.
"""

_WAVENUMBERS = np.geomspace(1e-4, 2.0, 300)
_ANGLES = (2.0 * np.pi * np.arange(36) / 36).tolist()
SAMPLES = 1 << 14
"""Number of samples of a drawn field, after which it repeats: 4 km of wind."""

_SPACING = 0.25
_WINDS = 3.5, 5.0, 7.0, 10.0, 14.0
"""Winds in which the weights have the least error [m/s]."""

_DAMPED = 0.12
"""Damping ratio of a first mode whose frequency is known to a tenth [-]."""

_LONGEST = 60.0
"""Integral length of gusts [m], that of IEC 61400-1 at 10 m."""

_USUAL = 7.0
"""Wind [m/s] in which a wavenumber is the frequency at which it shakes the tree."""

_HEIGHT = 10.0
"""Height in [m] whose turbulence has the lengths of the spectrum: a usual anemometer's."""


class FarWind:
    """
    The wind of the parts of a crown.

    Parameters
    ----------
    places
        Places of the parts from the highest point of the tree [m], east, north, up, (g, 3).
    size
        Size of each part [m], (g,).
    share
        Share of each in the load [-], (g,).
    frequency
        First frequency of the tree [Hz].
    distance
        Distance of the anemometer in [m], as high as the highest point.
    bearing
        Where it stands from the tree, clockwise from north in [rad]; None if that is not known.
    seed
        Seed of what is drawn; None without.
    is_sample
        Whether the wind is a sample and not the expected one.

    """

    def __init__(
        self,
        places: Floats,
        size: Floats,
        share: Floats,
        frequency: float,
        distance: float,
        bearing: float | None = None,
        seed: int | None = None,
        *,
        is_sample: bool = False,
    ) -> None:
        self._share = share
        self._places = places
        self._mast = distance, bearing
        self._weights = _weights(places, distance, bearing, frequency)
        self._memory = np.zeros((len(LENGTHS) + 4, 3))
        self._mean, self._variance, _, self._run = self._memory[len(LENGTHS) :]
        self._whole = np.zeros(3)
        self._rest: Singles | None = None
        if seed is not None:
            by_direction = self._told_by_direction()
            least, most = int(by_direction.argmin()), int(by_direction.argmax())
            ends = self._weights[[least, most]]
            self._least, more = _drawn_rest(places, size, ends, frequency / _USUAL, seed)
            self._more = more - self._least
            above = by_direction - by_direction[least]
            self._mixes = above / max(float(above[most]), 1e-12)
            self._mixed_for = 0
            self._rest = self._least + np.float32(self._mixes[0]) * self._more
        self._native = NativeFarWind(
            parts=len(share),
            stages=len(LENGTHS),
            directions=len(self._weights),
            samples=SAMPLES,
            is_sample=is_sample and self._rest is not None,
            length=LENGTHS,
            weights=self._weights,
            share=share,
            rest=np.zeros(0) if self._rest is None else self._rest,
            memory=self._memory,
            whole=self._whole,
        )
        self._apart: Floats | None = None
        self._apart_at = Address(0)

    @property
    def told(self) -> float:
        """Share of the variance of the crown's gusts that the anemometer tells [-]."""
        return float(self._told_by_direction().mean())

    def _told_by_direction(self) -> Floats:
        """Share of the variance of gusts that the anemometer tells, by the wind's way, (d,)."""
        power = _power_along()
        expected = _low_passes(_WAVENUMBERS) @ self._weights.swapaxes(1, 2)
        known = np.square(np.abs(expected)) @ self._share
        return np.asarray(known @ power / power.sum())

    def push(self, x: float, y: float, z: float, dt: float, apart: Floats) -> Floats:
        """
        Add the wind [m/s] of a step of dt [s] at the anemometer; return that of the crown, (3,).

        The array is reused. What the wind of each part is beside it is written to `apart`, (g, 3).
        """
        if self._rest is not None and len(self._weights) > 1:
            self._mix(self._rest)
        if apart is not self._apart:
            self._apart_at = contiguous(apart, (len(self._share), 3))
            self._apart = apart
        LIBRARY.sway_push_farwind(self._native.at, x, y, z, dt, self._apart_at)
        return self._whole

    def _mix(self, rest: Singles) -> None:
        """Mix the drawn fields for the direction of the mean wind, where that has changed."""
        nearest = self._nearest(self.mean)
        if nearest != self._mixed_for:
            self._mixed_for = nearest
            np.multiply(self._more, np.float32(self._mixes[nearest]), out=rest)
            rest += self._least

    def _nearest(self, mean: tuple[float, float]) -> int:
        """Return the number of the direction nearest to that of a mean wind."""
        east, north = mean
        towards = math.atan2(north, east) * len(self._weights) / (2.0 * np.pi)
        return round(towards) % len(self._weights)

    def others(self, offsets: Ints, along: float, across: float) -> Floats:
        """
        Winds that may be beside the expected one: other stretches of the drawn field, (e, g, 3).

        Offsets are numbers of its samples, (e,); the winds are times the factors along the mean
        wind, and across it and up.
        """
        assert self._rest is not None
        east, north, _ = self._mean.tolist()
        factors = np.array([along, across, across])
        turned = factors[:, None] * self._turned(east, north)
        first = int(self._run[0] / _SPACING)
        rows = (first + offsets) % SAMPLES
        return np.asarray(self._rest[rows] @ turned)

    def later(self, hertz: Floats, mean: tuple[float, float]) -> Complexes:
        """
        Gusts that a crown shares with its anemometer, over the phases of those that are expected.

        Parameters
        ----------
        hertz
            Frequencies in [Hz], (f,).
        mean
            Mean wind to east and north in [m/s], as `mean`.

        Returns
        -------
        Complexes
            Numbers of the size of the root coherence, (f,): travel has one delay for all gusts,
            the low-passes have less the faster these are. Without a bearing the size is that of
            an anemometer across the wind, the least.

        """
        wavenumbers = hertz / max(math.hypot(*mean), 1.0)
        distance, bearing = self._mast
        east, north = mean
        angle = math.atan2(north, east)
        (true,) = _coherences(self._places, distance, bearing, wavenumbers, [angle])
        stages = _low_passes(wavenumbers)
        expected = stages @ self._weights[self._nearest(mean)].T @ self._share
        of_crown = true @ self._share
        turn = of_crown * expected.conj()
        if bearing is None:
            away = _DECAYS.max() * np.hypot(distance, self._places[:, 2])
            true = np.exp(-wavenumbers[:, None] * away)
        shared = np.abs(true @ self._share)
        size = np.maximum(np.abs(turn), 1e-300)
        return np.asarray(shared * turn / size)

    @property
    def mean(self) -> tuple[float, float]:
        """Mean wind at the anemometer to east and north [m/s]."""
        return float(self._mean[0]), float(self._mean[1])

    def _turned(self, east: float, north: float) -> Floats:
        """Wind per drawn one along the mean wind, across it and up, (3, 3)."""
        level = math.hypot(east, north)
        c = east / level if level > 0.0 else 1.0
        s = north / level if level > 0.0 else 0.0
        # About the mean of a short record, gusts that are longer than it have no variance.
        missed = 2.0 * _LONGEST / max(float(self._run[0]), 1e-9)
        xx, yy, zz = (self._variance / max(1.0 - missed, 0.5)).tolist()
        along = math.sqrt(c * c * xx + s * s * yy)
        across = math.sqrt(s * s * xx + c * c * yy)
        return np.array(
            [
                [along * c, along * s, 0.0],
                [-across * s, across * c, 0.0],
                [0.0, 0.0, math.sqrt(zz)],
            ]
        )

    def recall(self, before: Floats, share: float) -> None:
        """Let the wind come nearer by a share to the means of a memory before, without gusts."""
        stages, known = len(LENGTHS), len(LENGTHS) + 3
        wanted = before[:known].copy()
        wanted[:stages] = before[stages]
        self._memory[:known] += share * (wanted - self._memory[:known])

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return (self._memory,)

    def reset(self) -> None:
        """Forget the wind."""
        self._memory[:] = 0.0


def _power_along() -> Floats:
    """Power of gusts along the wind in the bands of `_WAVENUMBERS`, without a scale."""
    spectrum = Turbulence(1.0, _HEIGHT, 1.0).spectrum(_WAVENUMBERS)
    return np.asarray(spectrum[:, 0] * _WAVENUMBERS)


def _low_passes(wavenumbers: Floats) -> Complexes:
    """Return what the low-passes of `LENGTHS` let through, (n, k)."""
    phases = 2.0 * np.pi * wavenumbers[:, None] * LENGTHS
    return np.asarray(1.0 / (1.0 + 1j * phases))


def _sway_per_gust(frequency: float) -> Floats:
    """Response of the first mode [Hz] to gusts of `_WAVENUMBERS`, squared, mean over winds."""
    ratio = _WAVENUMBERS * np.array(_WINDS)[:, None] / frequency
    impedance = 1.0 - np.square(ratio) + 2j * _DAMPED * ratio
    return np.asarray(np.square(1.0 / np.abs(impedance)).mean(axis=0))


def _weights(places: Floats, distance: float, bearing: float | None, frequency: float) -> Floats:
    """
    Weights of the low-passes in winds from every direction, or in all alike, (d, g, k).

    The first frequency of the tree is in [Hz].
    """
    stages = _low_passes(_WAVENUMBERS)
    weighed = stages.conj().T * (_power_along() * _sway_per_gust(frequency))
    square = (weighed @ stages).real
    return np.array(
        [
            np.linalg.solve(square, (weighed @ coherence).real).T
            for coherence in _coherences(places, distance, bearing, _WAVENUMBERS, _ANGLES)
        ]
    )


def _coherences(
    places: Floats,
    distance: float,
    bearing: float | None,
    wavenumbers: Floats,
    angles: Sequence[float],
) -> list[Complexes]:
    """
    Complex coherence G of places and anemometer, (k, g), in winds to angles from east to north.

    Without a bearing it is the mean over all ways to the anemometer.
    """
    if bearing is None:
        all_ways = [_coherence(places, distance, seen, 0.0, wavenumbers) for seen in _ANGLES]
        return [np.mean(all_ways, axis=0)]
    seen = 0.5 * np.pi - bearing
    return [_coherence(places, distance, seen, angle, wavenumbers) for angle in angles]


def _coherence(
    places: Floats, distance: float, seen: float, angle: float, wavenumbers: Floats
) -> Complexes:
    """Find the coherence in a wind to an angle of an anemometer that is seen at another."""
    towards = np.array([math.cos(seen), math.sin(seen), 0.0])
    mast = distance * towards
    c = math.cos(angle)
    s = math.sin(angle)
    away = places - mast
    x = away[:, 0] * c + away[:, 1] * s
    y = away[:, 1] * c - away[:, 0] * s
    along_across_up = np.stack([x, y, away[:, 2]], axis=1)
    apart = np.linalg.norm(along_across_up * _DECAYS, axis=1)
    per_wavenumber = apart + 2j * np.pi * x
    return np.asarray(np.exp(-wavenumbers[:, None] * per_wavenumber))


def _drawn_rest(
    places: Floats, size: Floats, weights: Floats, first: float, seed: int
) -> tuple[Singles, ...]:
    """
    Draw what is not expected at each place, over its deviation, (samples, g, 3).

    It is drawn for each of the weights of the low-passes, (w, g, k), by the same numbers. The
    first mode of the tree is at the wavenumber `first` [1/m].
    """
    count = len(places)
    run = SAMPLES * _SPACING
    wavenumbers = np.arange(1, SAMPLES // 2) / run
    column = wavenumbers[:, None]
    beyond = np.square(column / first)
    extent = size * np.minimum(1.0, 2.0 / (1.0 + beyond))
    acting = 1.0 / np.sqrt(1.0 + _WITHIN * column * extent)
    apart = np.linalg.norm(places[:, None] - places, axis=2)
    shared = np.exp(-_WITHIN * column[..., None] * apart)
    root = acting[..., None] * np.linalg.cholesky(shared + 1e-9 * np.eye(count))
    spectra = Turbulence(1.0, _HEIGHT, 1.0).spectrum(wavenumbers)
    power = spectra / spectra.sum(axis=0)
    amplitudes = SAMPLES * np.sqrt(0.5 * power)
    turns = np.random.default_rng(seed).random((3, len(wavenumbers), count))
    phases = np.exp(2j * np.pi * turns)
    fields = []
    for each in weights:
        # The root of ``root root^T - e e^T`` is ``root (1 - less v v^T)`` with ``root v = e``.
        expected = np.abs(_low_passes(wavenumbers) @ each.T)
        within = np.linalg.solve(root, expected[..., None])[..., 0]
        told = np.square(within).sum(axis=1)
        less = (1.0 - np.sqrt(np.maximum(1.0 - told, 0.0))) / np.maximum(told, 1e-12)
        rest = np.empty((SAMPLES, count, 3), dtype=np.float32)
        for axis, phase in enumerate(phases):
            by_told = less * np.einsum('kj,kj->k', within, phase)
            lines = np.zeros((SAMPLES // 2 + 1, count), dtype=np.complex128)
            drawn = np.einsum('kij,kj->ki', root, phase - by_told[:, None] * within)
            lines[1:-1] = drawn * amplitudes[:, axis, None]
            rest[..., axis] = np.fft.irfft(lines, SAMPLES, axis=0)
        fields.append(rest)
    return tuple(fields)
