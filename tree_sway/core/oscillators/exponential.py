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

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_SMALL = 1.5  # largest |mu| left to the Taylor series: 27 terms reach 1e-17
_TERMS = 27
_PHI2 = [1.0 / factorial(n + 2) for n in range(17, -1, -1)]


def phi1(z: Floats) -> Floats:
    """(e^z - 1) / z, for z <= 0."""
    return np.where(z == 0.0, 1.0, np.expm1(z) / np.where(z == 0.0, 1.0, z))


def phi2(z: Floats) -> Floats:
    """(e^z - 1 - z) / z^2, for z <= 0; a series where the difference would cancel."""
    far = np.minimum(z, -1.0)
    return np.where(z < -1.0, (phi1(far) - 1.0) / far, np.polyval(_PHI2, np.maximum(z, -1.0)))


def two_product(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Products of floats and their rounding errors (Dekker 1971)."""
    (a1, a2), (b1, b2) = _halves(a), _halves(b)
    high = a * b
    low = a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2)
    return high, np.where(np.isfinite(low), low, 0.0)


def _halves(a: Floats) -> tuple[Floats, Floats]:
    t = 134217729.0 * a
    high = t - (t - a)
    return high, a - high


def scaled_discriminant(
    i: Floats, c: Floats, k: Floats, h: float, alpha: Floats, kappa: Floats
) -> tuple[Floats, Floats, Floats]:
    """
    Return delta = alpha^2 - kappa and, if negative, its root's phase as a sum of two floats.

    Both come from ``k2^2 - 4 I k1``, whose two products are taken without rounding.
    """
    ch, cl = two_product(c, c)
    kh, kl = two_product(4.0 * i, k)
    high = ch - kh
    v = high - ch  # Knuth's two-sum: the rounding error of the difference
    low = (ch - (high - v)) + (-kh - v) + (cl - kl)
    p, scale = high + low, 0.5 * h / i
    root = np.sqrt(np.maximum(-p, 0.0))
    rh, rl = two_product(root, root)
    root_low = (((-high - rh) - rl) - low) / (2.0 * root)
    mh, ml = two_product(np.full_like(root, h), root)
    ml = ml + h * root_low
    phase = mh / (2.0 * i)
    qh, ql = two_product(phase, 2.0 * i)
    phase_low = ((mh - qh) - ql + ml) / (2.0 * i)
    exact = (np.abs(p) > 1e-250) & (np.abs(p) < 1e250) & (scale < 1e100)
    rough = np.where(alpha < 1e150, alpha * alpha - kappa, alpha * (alpha - kappa / alpha))
    turns = exact & (p <= 0.0)
    return (
        np.where(exact, p * scale * scale, rough),
        np.where(turns, phase, np.where(exact, 0.0, np.sqrt(np.maximum(-rough, 0.0)))),
        np.where(turns, phase_low, 0.0),
    )


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
    sigma, out = np.sqrt(np.maximum(delta, 0.0)), np.empty((6, len(alpha)))
    small = alpha + np.maximum(sigma, phase) <= _SMALL
    turns = ~small & (delta <= 0.0)
    decays = ~small & ~turns
    out[:, small] = _by_series(alpha[small], kappa[small])
    out[:, turns] = _by_phase(alpha[turns], kappa[turns], phase[turns], phase_low[turns])
    out[:, decays] = _by_decay(alpha[decays], kappa[decays], sigma[decays])
    return out


def _by_decay(alpha: Floats, kappa: Floats, sigma: Floats) -> Floats:
    """Real pair: differences of phi functions, or closed forms where it is close."""
    mu1, mu2 = -kappa / (alpha + sigma), -(alpha + sigma)
    slow, close = np.exp(mu1), 3.0 * sigma < alpha  # then kappa is large
    s = slow * (-np.expm1(-2.0 * sigma) / (2.0 * sigma))
    g = slow - mu1 * s
    d = np.where(close, slow + mu2 * s, (mu1 * slow - mu2 * np.exp(mu2)) / (2.0 * sigma))
    p = np.where(close, (1.0 - g) / kappa, (phi1(mu1) - phi1(mu2)) / (2.0 * sigma))
    closed = (1.0 - s - 2.0 * alpha * p) / kappa
    q = np.where(close, closed, (phi2(mu1) - phi2(mu2)) / (2.0 * sigma))
    by_sums = (s + 2.0 * alpha * p - g) / kappa
    return np.stack([g, d, s, p, q, np.where(close | (mu1 < -1.0), by_sums, p - q)])


def _by_phase(alpha: Floats, kappa: Floats, phase: Floats, low: Floats) -> Floats:
    """Complex pair (or a double one): decaying oscillation."""
    decay = np.exp(-alpha)
    sine = np.sin(phase) + low * np.cos(phase)
    cosine = np.cos(phase) - low * np.sin(phase)
    half = np.sin(0.5 * phase) + 0.5 * low * np.cos(0.5 * phase)
    s = decay * np.where(phase > 0.0, sine / np.where(phase > 0.0, phase, 1.0), 1.0)
    g = decay * cosine + alpha * s
    p = (2.0 * decay * half * half - np.expm1(-alpha) - alpha * s) / kappa
    q = (1.0 - s - 2.0 * alpha * p) / kappa
    by_sums = (s + 2.0 * alpha * p - g) / kappa
    return np.stack([g, decay * cosine - alpha * s, s, p, q, by_sums])


def _by_series(alpha: Floats, kappa: Floats) -> Floats:
    """Small pair: sums of the complete homogeneous polynomials over factorials."""
    before, now, weight = np.zeros_like(alpha), np.ones_like(alpha), 1.0  # 1 / (n + 1)!
    sums = np.zeros((4, len(alpha)))
    for n in range(_TERMS):
        shares = 1.0, 1.0 / (n + 2), 1.0 / ((n + 2) * (n + 3)), 1.0 / (n + 3)
        sums += np.multiply.outer(shares, weight * now)
        before, now = now, -2.0 * alpha * now - kappa * before
        weight /= n + 2
    s, p, q, difference = sums
    g = 1.0 - kappa * p
    return np.stack([g, g - 2.0 * alpha * s, s, p, q, difference])
