# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Divided differences of the exponential at 0, 0 and a pair of eigenvalues, without cancellation.

The pair is mu = -alpha +- sqrt(delta), delta = alpha^2 - kappa, real or complex. Three ways, each
where it loses no digits: the Taylor series of small pairs, differences of phi functions for real
pairs far apart, closed forms for the rest. The phase of a lightly damped pair is kept in
double-double, so that a thousand turns in one step are as exact as one (Dekker 1971, A
floating-point technique for extending the available precision).
"""

from __future__ import annotations

import math

from tree_sway.core.kernel import kernel

Six = tuple[float, float, float, float, float, float]

_SMALL = 1.5  # largest |mu| left to the Taylor series: 27 terms reach 1e-17
_TERMS = 27


@kernel
def phi1(z: float) -> float:
    """(e^z - 1) / z, for z <= 0."""
    return math.expm1(z) / z if z != 0.0 else 1.0


@kernel
def phi2(z: float) -> float:
    """(e^z - 1 - z) / z^2, for z <= 0; a series where the difference would cancel."""
    if z < -1.0:
        return (phi1(z) - 1.0) / z
    term = total = 0.5
    for n in range(3, 20):
        term *= z / n
        total += term
    return total


@kernel
def two_product(a: float, b: float) -> tuple[float, float]:
    """Product of two floats and its rounding error (Dekker 1971)."""
    high = a * b
    t = 134217729.0 * a
    a1 = t - (t - a)
    t = 134217729.0 * b
    b1 = t - (t - b)
    a2, b2 = a - a1, b - b1
    low = a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2)
    return high, low if math.isfinite(low) else 0.0


@kernel
def scaled_discriminant(
    i: float, c: float, k: float, h: float, alpha: float, kappa: float
) -> tuple[float, float, float]:
    """
    Return delta = alpha^2 - kappa and, if negative, its root's phase as a sum of two floats.

    Both come from ``k2^2 - 4 I k1``, whose two products are taken without rounding.
    """
    ch, cl = two_product(c, c)
    kh, kl = two_product(4.0 * i, k)
    high = ch - kh
    v = high - ch  # Knuth's two-sum: the rounding error of the difference
    low = (ch - (high - v)) + (-kh - v) + (cl - kl)
    p = high + low
    scale = 0.5 * h / i
    if not (abs(p) > 1e-250 and abs(p) < 1e250 and scale < 1e100):
        delta = alpha * alpha - kappa if alpha < 1e150 else alpha * (alpha - kappa / alpha)
        return delta, math.sqrt(max(-delta, 0.0)), 0.0
    delta = p * scale * scale
    if p > 0.0:
        return delta, 0.0, 0.0
    root = math.sqrt(-p)
    rh, rl = two_product(root, root)
    root_low = (((-high - rh) - rl) - low) / (2.0 * root)
    mh, ml = two_product(h, root)
    ml += h * root_low
    phase = mh / (2.0 * i)
    qh, ql = two_product(phase, 2.0 * i)
    return delta, phase, ((mh - qh) - ql + ml) / (2.0 * i)


@kernel
def exponential_differences(
    alpha: float, kappa: float, delta: float, phase: float, phase_low: float
) -> Six:
    """
    Everything that one step of an oscillator needs, for unit step and unit inertia.

    Returns
    -------
    g, d, s, p, q, p_minus_q
        Diagonal of the exponential (x from x, v from v), then e[mu1, mu2], e[0, mu1, mu2],
        e[0, 0, mu1, mu2], and the difference of the last two.

    """
    sigma = math.sqrt(delta) if delta > 0.0 else 0.0
    if alpha + max(sigma, phase) <= _SMALL:
        return _by_series(alpha, kappa)
    if delta <= 0.0:
        return _by_phase(alpha, kappa, phase, phase_low)
    mu1 = -kappa / (alpha + sigma)
    mu2 = -(alpha + sigma)
    slow = math.exp(mu1)
    s = slow * (-math.expm1(-2.0 * sigma) / (2.0 * sigma))
    g = slow - mu1 * s
    if 3.0 * sigma < alpha:  # a close pair: kappa is large
        d = slow + mu2 * s
        p = (1.0 - g) / kappa
        q = (1.0 - s - 2.0 * alpha * p) / kappa
        return g, d, s, p, q, (s + 2.0 * alpha * p - g) / kappa
    d = (mu1 * slow - mu2 * math.exp(mu2)) / (2.0 * sigma)
    p = (phi1(mu1) - phi1(mu2)) / (2.0 * sigma)
    q = (phi2(mu1) - phi2(mu2)) / (2.0 * sigma)
    if mu1 < -1.0:
        return g, d, s, p, q, (s + 2.0 * alpha * p - g) / kappa
    return g, d, s, p, q, p - q


@kernel
def _by_phase(alpha: float, kappa: float, phase: float, low: float) -> Six:
    """Complex pair (or a double one): decaying turns."""
    decay = math.exp(-alpha)
    sine = math.sin(phase) + low * math.cos(phase)
    cosine = math.cos(phase) - low * math.sin(phase)
    half = math.sin(0.5 * phase) + 0.5 * low * math.cos(0.5 * phase)
    s = decay * (sine / phase if phase > 0.0 else 1.0)
    g = decay * cosine + alpha * s
    p = (2.0 * decay * half * half - math.expm1(-alpha) - alpha * s) / kappa
    q = (1.0 - s - 2.0 * alpha * p) / kappa
    return g, decay * cosine - alpha * s, s, p, q, (s + 2.0 * alpha * p - g) / kappa


@kernel
def _by_series(alpha: float, kappa: float) -> Six:
    """Small pair: sums of the complete homogeneous polynomials over factorials."""
    before, now = 0.0, 1.0
    s = p = q = difference = 0.0
    weight = 1.0  # 1 / (n + 1)!
    for n in range(_TERMS):
        s += weight * now
        p += weight * now / (n + 2)
        q += weight * now / ((n + 2) * (n + 3))
        difference += weight * now / (n + 3)
        before, now = now, -2.0 * alpha * now - kappa * before
        weight /= n + 2
    g = 1.0 - kappa * p
    return g, g - 2.0 * alpha * s, s, p, q, difference
