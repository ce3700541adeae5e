# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Divided differences of the exponential against many digits, where naive formulas lose theirs."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st
import pytest

from tree_sway.core.oscillators.propagation import propagator

mpmath = pytest.importorskip('mpmath', reason='needs mpmath, an oracle of many digits')
NAMES = ('g', 'd', 's', 'p', 'q', 'p - q')


def found(alpha, kappa):
    """All six for unit inertia and step: k2 = 2 alpha, k1 = kappa."""
    g, s, p_minus_q, q, _, d, _, p = propagator(1.0, 2.0 * alpha, kappa, 1.0)[0].tolist()
    return g, d, s, p, q, p_minus_q


def exact(alpha, kappa):
    """Evaluate textbook formulas in 80 digits; also return the size of the terms of g and d."""
    with mpmath.workdps(80):
        a, k = mpmath.mpf(alpha), mpmath.mpf(kappa)
        root = mpmath.sqrt(mpmath.mpc(a * a - k))
        root = root if root else mpmath.mpf(10) ** -30
        slow, fast = mpmath.exp(root - a), mpmath.exp(-root - a)
        s = ((slow - fast) / (2 * root)).real
        mean = ((slow + fast) / 2).real
        g, d = mean + a * s, mean - a * s
        p = (1 - g) / k
        q = (1 - s - 2 * a * p) / k
        return (g, d, s, p, q, p - q), abs(mean) + abs(a * s)


@pytest.mark.parametrize(
    'ratio', [0.0, 1e-6, 0.05, 0.9999999, 1.0, 1.0000001, 1.06, 1.5, 30.0, 1e3]
)
def test_six_numbers_to_twelve_digits(ratio):
    for kappa in (1e-12, 1e-4, 0.3, 2.0, 2.3, 50.0, 1e4, 1e8):
        alpha = ratio * math.sqrt(kappa)
        values, sizes = exact(alpha, kappa)
        for name, value, true in zip(NAMES, found(alpha, kappa), values, strict=True):
            unit = sizes if name in 'gd' else abs(true)
            if name == 's':  # a sine over its phase crosses zero
                unit = max(unit, math.exp(-alpha) / max(1.0, math.sqrt(kappa)))
            assert abs(value - true) <= 1e-12 * unit + 1e-300, (kappa, name, value, true)


def test_limits_at_nothing():
    assert found(0.0, 0.0) == pytest.approx((1.0, 1.0, 1.0, 1 / 2, 1 / 6, 1 / 3), rel=1e-15)


@settings(deadline=None)
@given(st.floats(1e-9, 30.0), st.floats(1e-9, 900.0))
def test_what_the_six_owe_each_other(alpha, kappa):
    """Determinant e^(-2 alpha), trace by s, and the two recurrences of the differences."""
    g, d, s, p, q, p_minus_q = found(alpha, kappa)
    assert g * d + kappa * s * s == pytest.approx(
        math.exp(-2.0 * alpha), abs=1e-11 * (g * g + kappa * s * s)
    )
    assert g - d == pytest.approx(2.0 * alpha * s, abs=1e-12 * (abs(g) + abs(d)))
    assert g == pytest.approx(1.0 - kappa * p, abs=1e-12 * (1.0 + kappa * p))
    assert s == pytest.approx(
        1.0 - 2.0 * alpha * p - kappa * q, abs=1e-12 * (1.0 + alpha * p + kappa * q)
    )
    assert p - q == pytest.approx(p_minus_q, rel=1e-9)


@pytest.mark.parametrize('turns', [1, 100, 10_000])
def test_many_turns_in_a_step_keep_their_digits(turns):
    """In plain floats the error of the phase grows with the turns; as a sum of two it does not."""
    inertia, damping, h = 0.37, 1e-3, 1 / 60
    stiffness = inertia * (2.0 * math.pi * turns / h * 1.000123) ** 2
    c = propagator(inertia, damping, stiffness, h)[0]
    with mpmath.workdps(60):
        i, k2, k1, step = (mpmath.mpf(v) for v in (inertia, damping, stiffness, h))
        w = mpmath.sqrt(4 * i * k1 - k2 * k2) / (2 * i)
        decay = mpmath.exp(-k2 / (2 * i) * step)
        assert c[1] == pytest.approx(float(decay * mpmath.sin(w * step) / w), rel=1e-14, abs=0.0)


def test_a_double_root_is_that_of_a_close_pair():
    double, close = found(1.6, 1.6**2), found(1.6, 1.6**2 * (1.0 + 1e-12))
    assert double == pytest.approx(close, rel=1e-11)
