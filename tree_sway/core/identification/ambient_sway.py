# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Frequency and damping of a tree that sways in natural wind.

The periodogram of a stationary motion scatters about its spectrum as an exponential variable does,
each bin on its own (Whittle, 1953). The likelihood of a resonance on a smooth load and a floor,

    S(f) = (f / f0)^p (a / ((1 - r^2)^2 + (2 zeta r)^2) + b),   r = f / f0,

is maximised over f0, zeta, a, b, p. Unlike the half-power width it is not widened by the
resolution of the spectrum, and p takes up the slope of the turbulence and whether displacement,
tilt or acceleration was measured. Standard errors are those of Fisher's information (Brillinger,
1981).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy import linalg, optimize, signal

from tree_sway.core.arrays import Floats
from tree_sway.core.identification.sway_estimate import SwayEstimate
from tree_sway.errors import FormatError

_BAND = (0.6, 1.6)
_MIN_CYCLES = 20.0
_MAX_POINTS = 600
_SLOPE = 5.0
_MIN_GAIN = 8.0
"""
Log-likelihood that a resonance must add to a smooth spectrum: 1 in 1,000 by chi-square of its
three parameters.

"""


@dataclass(frozen=True)
class AmbientSway(SwayEstimate):
    """One resonance; ``gain`` is the log-likelihood that it adds to a smooth spectrum."""

    kind: ClassVar[str] = 'ambient'
    gain: float


def ambient_sway(motion: Floats, dt: float, rough: float) -> AmbientSway:
    """
    Fit the resonance of an ambient record, along the axis that moves most, near a frequency [Hz].

    The motion is displacement, tilt or acceleration at even steps of dt [s], (n, c).
    Raises a `FormatError` where there are fewer than 20 cycles, or no resonance.
    """
    cycles = len(motion) * dt * rough
    if cycles < _MIN_CYCLES:
        raise FormatError(
            f'{cycles:.1f} cycles of {rough:.3g} Hz',
            cure='an ambient record takes at least 20 cycles, better 500',
        )
    frequency, power, bins = _periodogram(motion, dt, rough)
    floor = float(power.min() + 1e-3 * power.mean())
    start = np.append(np.log([rough, 0.05, 0.01 * float(np.median(power)), floor]), 0.0)
    # Several first guesses lead out of side valleys where damping and floor trade places.
    shifts = np.array([[0, -1, 0, -2, 0], [0, -1, 0, 1, 0], [0, 0.5, 0, -2, 0], [0, 0.5, 0, 1, 0]])
    fits = (_fit(frequency, power, bins, start + shift) for shift in shifts)
    best = min(fits, key=lambda result: float(result.fun))
    gain = _smooth_loss(frequency, power, bins) - float(best.fun)
    found, ratio = float(np.exp(best.x[0])), float(np.exp(best.x[1]))
    inside = frequency[0] < found < frequency[-1] and ratio < 0.4
    if not inside or gain < _MIN_GAIN:
        raise FormatError(
            f'the spectrum has no peak around {rough:.3g} Hz',
            cure='record longer, in more wind, nearer to the top, or name the band the sway is in',
        )
    frequency_error, damping_error = _standard_errors(frequency, bins, best.x)
    return AmbientSway(found, ratio, frequency_error, damping_error, cycles, gain)


def _periodogram(motion: Floats, dt: float, rough: float) -> tuple[Floats, Floats, int]:
    """Frequencies, power of mean 1 along the axis that moves most, and bins averaged in each."""
    taper = signal.windows.tukey(len(motion), 0.1)
    spectrum = np.fft.rfft(taper[:, None] * motion, axis=0)
    frequency = np.fft.rfftfreq(len(motion), dt)
    band = (frequency > _BAND[0] * rough) & (frequency < _BAND[1] * rough)
    narrow = (frequency > 0.85 * rough) & (frequency < 1.15 * rough)
    covariance = (spectrum[narrow].conj().T @ spectrum[narrow]).real
    axis = linalg.eigh(covariance)[1][:, -1]
    power = np.abs(spectrum[band] @ axis) ** 2
    bins = 1 + len(power) // _MAX_POINTS
    whole = bins * (len(power) // bins)
    means = [values[:whole].reshape(-1, bins).mean(axis=1) for values in (frequency[band], power)]
    return means[0], means[1] / means[1].mean(), bins


def log_spectrum(x: Floats, frequency: Floats) -> Floats:
    """Logarithm of the model's spectrum at frequencies [Hz], (m,), by log f0, zeta, a, b and p."""
    centre, ratio, resonance, floor = np.exp(np.clip(x[:4], -60.0, 60.0))
    r2 = (frequency / centre) ** 2
    shape: Floats = resonance / ((1.0 - r2) ** 2 + 4.0 * ratio**2 * r2) + floor
    return np.log(shape) + 0.5 * x[4] * np.log(r2)


def _fit(frequency: Floats, power: Floats, bins: int, start: Floats) -> optimize.OptimizeResult:
    def loss(x: Floats) -> float:
        logarithm = log_spectrum(x, frequency)
        # A weak pull keeps the slope, which a narrow band hardly shows, in the range of real ones.
        pull = 0.5 * (x[4] / _SLOPE) ** 2
        return bins * float((logarithm + power * np.exp(-logarithm)).sum()) + pull

    limits = [tuple(np.log(frequency[[0, -1]])), (np.log(1e-3), 0.0), *3 * [(-40.0, 10.0)]]
    return optimize.minimize(loss, start, method='L-BFGS-B', bounds=limits)


def _smooth_loss(frequency: Floats, power: Floats, bins: int) -> float:
    """Loss of the best power law without a resonance."""
    lever = np.log(frequency / frequency.mean())

    def loss(x: Floats) -> float:
        logarithm = x[0] + x[1] * lever
        return bins * float((logarithm + power * np.exp(-logarithm)).sum())

    return float(optimize.minimize(loss, np.zeros(2), method='BFGS').fun)


def _standard_errors(frequency: Floats, bins: int, x: Floats) -> tuple[float, float]:
    """Return standard errors of frequency [Hz] and damping ratio [-] by Fisher's information."""
    slopes = optimize.approx_fprime(x, log_spectrum, 1e-6, frequency)
    prior = np.diag([0.0, 0.0, 1e-6, 1e-6, 1.0 / _SLOPE**2])
    covariance = linalg.pinvh(bins * slopes.T @ slopes + prior)
    errors = np.exp(x[:2]) * np.sqrt(np.diag(covariance)[:2])
    return float(errors[0]), float(errors[1])
