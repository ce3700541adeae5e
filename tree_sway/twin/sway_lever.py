# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How far below a sensor is the point about which its place turns, by its motion and by the model's.

A place that sways by x and leans by s has the lever l = x / s, which the shape of the tree tells,
whatever the gusts, the wood and the damping. At a circular frequency w a sensor with gravity g
feels the acceleration ``a = -(w^2 l + g) s`` and turns at the rate ``r = i w s``, so that the
imaginary part of their cross spectrum is ``(w l + g / w) |r|^2``. A sensor on another tree, or at
another height, has another lever.

On a limb whose levers differ from band to band, wood that is softer there than elsewhere is as
another lever too.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from tree_sway.core.arrays import Complexes, Floats

_BANDS = np.array([0.4, 0.6, 0.8, 1.0, 1.25, 1.55, 1.95, 2.5])
"""Edges of bands over the first frequency, each of which has a lever of its own."""

_PERIODS, _LEAST_LENGTH = 20.0, 3.0
"""Length of a stretch in periods of the first frequency; least one of the motion in stretches."""

_ALIKE, _LEAST, _MOST_OF = 0.8, 0.2, 0.4
"""
Coherence of acceleration and rate from which a band has a lever, the least one [m], and the share
of the power of the sway in such bands from which they tell.
"""

_OTHER, _PER_SPREAD = 0.35, 2.0
"""
Difference of the logarithms of two levers from which a sensor is not where it is said to be, and
what is added to it over the deviation of those of the bands of the model: of eight right ones,
whose branches were softer or stiffer than the stem by 15 %, it was up to 0.3, and on limbs of a
forked tree with deviations of 0.17 and 0.22 it was 0.46 and 0.62.
"""


def other_lever(moved: Floats, model: Floats, frequency: float, dt: float, pull: float) -> str:
    """
    Say that a sensor turns about another point than its place on the model; else nothing.

    Parameters
    ----------
    moved, model
        Motion of the sensor and of the model there at equal steps of dt [s], (n, 9).
    frequency
        First frequency of the model in [Hz].
    dt
        Time step in [s].
    pull
        Gravity in their accelerations [m/s^2].

    """
    length = round(_PERIODS / (frequency * dt))
    if len(moved) < _LEAST_LENGTH * length:
        return ''
    own, power, own_coherence = _levers(moved, frequency, dt, length, pull)
    of_model, _, coherence = _levers(model, frequency, dt, length, pull)
    is_alike = np.minimum(own_coherence, coherence) > _ALIKE
    is_told = is_alike & (np.minimum(own, of_model) > _LEAST)
    told = np.where(is_told, power, 0.0)
    if not told.sum() > _MOST_OF * power.sum():  # nor where one is not measured
        return ''
    levers = np.log(np.maximum([own, of_model], _LEAST))
    share = told / told.sum()
    means = levers @ share
    spread = math.sqrt(share @ np.square(levers[1] - means[1]))
    here, there = np.exp(means).tolist()
    if abs(math.log(here / there)) < _OTHER + _PER_SPREAD * spread:
        return ''
    return (
        f'it turns about a point {here:.1f} m below it, and its place on the tree about one '
        f'{there:.1f} m below: check that it is on this tree, at this place'
    )


def _levers(
    motion: Floats, frequency: float, dt: float, length: int, pull: float
) -> tuple[Floats, Floats, Floats]:
    """Lever [m], power of the rate, and coherence with the acceleration in each band, (b,)."""
    felt = motion[:, :2].T
    turned = np.stack([motion[:, 4], -motion[:, 3]])  # the rate that leans along x, along y

    step, window = length - length // 2, np.hanning(length + 1)[:-1]

    def waves(series: Floats) -> Complexes:
        stretches = sliding_window_view(series, length, axis=1)[:, ::step]
        return np.fft.rfft((stretches - stretches.mean(axis=2, keepdims=True)) * window)

    def spectrum(one: Complexes, other: Complexes) -> Complexes:
        return (one.conj() * other).sum(axis=(0, 1))

    of_turn, of_felt = waves(turned), waves(felt)
    hertz = np.fft.rfftfreq(length, dt)
    circular = 2.0 * math.pi * np.maximum(hertz, hertz[1])
    of_rate = spectrum(of_turn, of_turn).real
    shared = spectrum(of_turn, of_felt).imag  # (w l + g / w) |r|^2
    moment = (shared - pull / circular * of_rate) / circular  # l |r|^2
    edges = np.minimum(np.searchsorted(hertz, _BANDS * frequency), len(hertz) - 1)

    def in_bands(series: Floats) -> Floats:
        return np.add.reduceat(series, edges)[:-1]

    power = np.maximum(in_bands(of_rate), 1e-300)
    coherence = in_bands(shared) / np.sqrt(in_bands(spectrum(of_felt, of_felt).real) * power)
    return in_bands(moment) / power, power, coherence
