# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Divided differences of the exponential at 0, 0 and a pair of eigenvalues, without cancellation.

The pair is mu = -alpha +- sqrt(delta), delta = alpha^2 - kappa, real or complex. There are three
methods, each used where it loses no digits: the Taylor series of small pairs, differences of phi
functions for real pairs far apart, closed forms for the rest. The phase of a lightly damped pair
is computed in double-double, so that a thousand periods in one step are as exact as one (Dekker
1971, A floating-point technique for extending the available precision).
"""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

Sums = tuple[Floats, Floats]
"""Values as sums of two floats, of which the second is the rounding error of the first."""

_SPLITTER = 134217729.0  # 2^27 + 1
_SMALL = 1.5  # largest |mu| left to the Taylor series: 27 terms reach 1e-17
_TERMS = 27
_PHI2 = [1.0 / factorial(n + 2) for n in range(17, -1, -1)]


def phi1(z: Floats) -> Floats:
    """(e^z - 1) / z, for z <= 0."""
    divisor = np.where(z == 0.0, 1.0, z)
    return np.where(z == 0.0, 1.0, np.expm1(z) / divisor)


def phi2(z: Floats) -> Floats:
    """(e^z - 1 - z) / z^2, for z <= 0; a series where the difference would cancel."""
    far = np.minimum(z, -1.0)
    near = np.maximum(z, -1.0)
    by_difference = (phi1(far) - 1.0) / far
    by_series = np.polyval(_PHI2, near)
    return np.where(z < -1.0, by_difference, by_series)


def two_product(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Products of floats and their rounding errors (Dekker 1971)."""
    a_high, a_low = _halves(a)
    b_high, b_low = _halves(b)
    product = a * b
    error = product - a_high * b_high
    error = error - a_low * b_high
    error = error - a_high * b_low
    low = a_low * b_low - error
    return product, np.where(np.isfinite(low), low, 0.0)


def _halves(a: Floats) -> tuple[Floats, Floats]:
    """Split floats into two of 26 bits each, whose products are exact (Veltkamp; Dekker 1971)."""
    spread = _SPLITTER * a
    high = spread - (spread - a)
    return high, a - high


class Discriminant(NamedTuple):
    """delta = alpha^2 - kappa and, if negative, its root's phase as a sum of two floats, (n,)."""

    delta: Floats
    phase: Floats
    phase_low: Floats


def scaled_discriminant(
    i: Floats, c: Floats, k: Floats, h: float, alpha: Floats, kappa: Floats
) -> Discriminant:
    """
    Find delta and phase from ``D = k2^2 - 4 I k1``, whose two products are taken without rounding.

    ``delta = D (h / 2 I)^2``; the phase is ``h sqrt(-D) / 2 I``. Where D or its scale is beyond
    the range of such products, both come from alpha and kappa.
    """
    high, low = _difference(two_product(c, c), two_product(4.0 * i, k))
    discriminant = high + low
    scale = 0.5 * h / i
    phase, phase_low = _phase_of(high, low, h, i)

    size = np.abs(discriminant)
    is_exact = (size > 1e-250) & (size < 1e250) & (scale < 1e100)
    oscillates = is_exact & (discriminant <= 0.0)
    by_square = alpha * alpha - kappa
    without_overflow = alpha * (alpha - kappa / alpha)
    rough = np.where(alpha < 1e150, by_square, without_overflow)
    rough_phase = np.where(is_exact, 0.0, np.sqrt(np.maximum(-rough, 0.0)))
    return Discriminant(
        delta=np.where(is_exact, discriminant * scale * scale, rough),
        phase=np.where(oscillates, phase, rough_phase),
        phase_low=np.where(oscillates, phase_low, 0.0),
    )


def _difference(a: Sums, b: Sums) -> Sums:
    """Difference of two sums of two floats, with the rounding error of it (Knuth's two-sum)."""
    a_high, a_low = a
    b_high, b_low = b
    high = a_high - b_high
    taken = high - a_high
    error = (a_high - (high - taken)) + (-b_high - taken)
    return high, error + (a_low - b_low)


def _phase_of(high: Floats, low: Floats, h: float, i: Floats) -> Sums:
    """Phase ``h sqrt(-D) / 2 I`` of a negative D = high + low, as a sum of two floats."""
    root = np.sqrt(np.maximum(-(high + low), 0.0))
    square_high, square_low = two_product(root, root)
    remainder = ((-high - square_high) - square_low) - low
    root_low = remainder / (2.0 * root)

    moved_high, moved_low = two_product(np.full_like(root, h), root)
    moved_low = moved_low + h * root_low
    twice_inertia = 2.0 * i
    phase = moved_high / twice_inertia
    back_high, back_low = two_product(phase, twice_inertia)
    phase_low = ((moved_high - back_high) - back_low + moved_low) / twice_inertia
    return phase, phase_low


def exponential_differences(
    alpha: Floats, kappa: Floats, delta: Floats, phase: Floats, phase_low: Floats
) -> Floats:
    """
    Find the functions for a step of oscillators, of unit step and unit inertia, (6, n).

    Returns
    -------
    g, d, s, p, q, p_minus_q
        Diagonal of the exponential (x from x, v from v), then e[mu1, mu2], e[0, mu1, mu2],
        e[0, 0, mu1, mu2], and the difference of the last two.

    """
    sigma = np.sqrt(np.maximum(delta, 0.0))
    is_small = alpha + np.maximum(sigma, phase) <= _SMALL
    oscillates = ~is_small & (delta <= 0.0)
    decays = ~is_small & ~oscillates

    def of(chosen: NDArray[np.bool_], *values: Floats) -> list[Floats]:
        return [each[chosen] for each in values]

    out = np.empty((6, len(alpha)))
    out[:, is_small] = _by_series(*of(is_small, alpha, kappa))
    out[:, oscillates] = _by_phase(*of(oscillates, alpha, kappa, phase, phase_low))
    out[:, decays] = _by_decay(*of(decays, alpha, kappa, sigma))
    return out


def _by_decay(alpha: Floats, kappa: Floats, sigma: Floats) -> Floats:
    """Real pair: differences of phi functions, or closed forms where it is close."""
    mu1 = -kappa / (alpha + sigma)
    mu2 = -(alpha + sigma)
    apart = 2.0 * sigma  # mu1 - mu2
    is_close = 3.0 * sigma < alpha  # then kappa is large
    slow = np.exp(mu1)
    fast = np.exp(mu2)

    s = slow * (-np.expm1(-apart) / apart)
    g = slow - mu1 * s
    d_apart = (mu1 * slow - mu2 * fast) / apart
    d = np.where(is_close, slow + mu2 * s, d_apart)
    p_apart = (phi1(mu1) - phi1(mu2)) / apart
    p = np.where(is_close, (1.0 - g) / kappa, p_apart)
    q_apart = (phi2(mu1) - phi2(mu2)) / apart
    q = np.where(is_close, _q_closed(alpha, kappa, s, p), q_apart)

    is_exact = is_close | (mu1 < -1.0)
    p_minus_q = np.where(is_exact, _p_minus_q(alpha, kappa, g, s, p), p - q)
    return np.stack([g, d, s, p, q, p_minus_q])


def _q_closed(alpha: Floats, kappa: Floats, s: Floats, p: Floats) -> Floats:
    """e[0, 0, mu1, mu2] from s and p; exact where kappa is not small."""
    return (1.0 - s - 2.0 * alpha * p) / kappa


def _p_minus_q(alpha: Floats, kappa: Floats, g: Floats, s: Floats, p: Floats) -> Floats:
    """Difference of p and q without taking it; exact where kappa is not small."""
    return (s + 2.0 * alpha * p - g) / kappa


def _by_phase(alpha: Floats, kappa: Floats, phase: Floats, low: Floats) -> Floats:
    """Complex pair (or a double one): decaying oscillation."""
    decay = np.exp(-alpha)
    sine = np.sin(phase) + low * np.cos(phase)
    cosine = np.cos(phase) - low * np.sin(phase)
    half_phase = 0.5 * phase
    half_sine = np.sin(half_phase) + 0.5 * low * np.cos(half_phase)
    is_double = phase <= 0.0
    sinc = np.where(is_double, 1.0, sine / np.where(is_double, 1.0, phase))

    s = decay * sinc
    g = decay * cosine + alpha * s
    d = decay * cosine - alpha * s
    lost = 2.0 * decay * half_sine * half_sine - np.expm1(-alpha)  # 1 - decay cosine
    p = (lost - alpha * s) / kappa
    q = _q_closed(alpha, kappa, s, p)
    return np.stack([g, d, s, p, q, _p_minus_q(alpha, kappa, g, s, p)])


def _by_series(alpha: Floats, kappa: Floats) -> Floats:
    """Small pair: sums of the complete homogeneous polynomials over factorials."""
    before = np.zeros_like(alpha)
    now = np.ones_like(alpha)
    weight = 1.0  # 1 / (n + 1)!
    s = np.zeros_like(alpha)
    p = np.zeros_like(alpha)
    q = np.zeros_like(alpha)
    p_minus_q = np.zeros_like(alpha)
    for n in range(_TERMS):
        term = weight * now
        s += term
        p += 1.0 / (n + 2) * term
        q += 1.0 / ((n + 2) * (n + 3)) * term
        p_minus_q += 1.0 / (n + 3) * term
        before, now = now, -2.0 * alpha * now - kappa * before
        weight /= n + 2
    g = 1.0 - kappa * p
    d = g - 2.0 * alpha * s
    return np.stack([g, d, s, p, q, p_minus_q])
