# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Divided differences of the exponential against many digits, where naive formulas lose theirs."""

from __future__ import annotations

from fractions import Fraction
import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.oscillators.exponential import (
    exponential_differences,
    phi1,
    phi2,
    scaled_discriminant,
    two_product,
)

mpmath = pytest.importorskip('mpmath', reason='needs mpmath, an oracle of many digits')
NAMES = ('g', 'd', 's', 'p', 'q', 'p - q')


def found(alpha, kappa):
    """All six for unit inertia and step: k2 = 2 alpha, k1 = kappa."""
    alpha, kappa, one = np.array([alpha]), np.array([kappa]), np.ones(1)
    with np.errstate(all='ignore'):
        phases = scaled_discriminant(one, 2.0 * alpha, kappa, 1.0, alpha, kappa)
        return exponential_differences(alpha, kappa, *phases)[:, 0].tolist()


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


@pytest.mark.parametrize('kappa', [1e-12, 1e-4, 0.3, 2.0, 2.3, 50.0, 1e4, 1e8])
@pytest.mark.parametrize(
    'ratio', [0.0, 1e-6, 0.05, 0.9999999, 1.0, 1.0000001, 1.06, 1.5, 30.0, 1e3]
)
def test_six_numbers_to_twelve_digits(kappa, ratio):
    alpha = ratio * math.sqrt(kappa)
    values, sizes = exact(alpha, kappa)
    for name, value, true in zip(NAMES, found(alpha, kappa), values, strict=True):
        unit = sizes if name in 'gd' else abs(true)
        if name == 's':  # a sine over its phase crosses zero
            unit = max(unit, math.exp(-alpha) / max(1.0, math.sqrt(kappa)))
        assert abs(value - true) <= 1e-12 * unit + 1e-300, (name, value, true)


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


@given(*[st.floats(-1e100, 1e100).filter(lambda x: x == 0.0 or abs(x) > 1e-100)] * 2)
def test_a_product_and_its_error_are_the_product(a, b):
    high, low = (float(each[0]) for each in two_product(np.array([a]), np.array([b])))
    assert high == a * b
    assert Fraction(high) + Fraction(low) == Fraction(a) * Fraction(b)


def test_a_product_out_of_range_keeps_a_finite_error():
    with np.errstate(all='ignore'):
        assert two_product(np.array([1e300]), np.array([1e300])) == (math.inf, 0.0)


@pytest.mark.parametrize('z', [-1e-300, -1e-9, -1e-3, -0.999, -1.001, -5.0, -700.0])
def test_phi_functions(z):
    with mpmath.workdps(60):
        x = mpmath.mpf(z)
        first = (mpmath.expm1(x)) / x
        second = (first - 1) / x if abs(z) > 1e-30 else mpmath.mpf(0.5)
    at = np.array([z, 0.0])
    assert phi1(at) == pytest.approx([float(first), 1.0], rel=1e-15)
    assert phi2(at) == pytest.approx([float(second), 0.5], rel=1e-14)


@pytest.mark.parametrize('turns', [1, 100, 10_000])
def test_the_phase_of_many_turns_keeps_its_digits(turns):
    """In plain floats the error of the phase grows with the turns; as a sum of two it does not."""
    inertia, damping, h = 0.37, 1e-3, 1 / 60
    stiffness = inertia * (2.0 * math.pi * turns / h * 1.000123) ** 2
    alpha, kappa = 0.5 * damping / inertia * h, stiffness / inertia * h * h
    given = (np.array([v]) for v in (inertia, damping, stiffness, h, alpha, kappa))
    _, phase, low = (float(each[0]) for each in scaled_discriminant(*given))
    with mpmath.workdps(60):
        i, c, k, step = (mpmath.mpf(v) for v in (inertia, damping, stiffness, h))
        true = mpmath.sqrt(4 * i * k - c * c) * step / (2 * i)
        assert abs(true - phase - low) < mpmath.mpf(1e-28) * true
    assert abs(low) <= 1.02 * math.ulp(phase)


def test_a_double_root_has_no_phase():
    one = np.ones(2)
    with np.errstate(all='ignore'):
        delta, phase, low = scaled_discriminant(
            one, np.array([2.0, 10.0]), one, 1.0, np.array([1.0, 5.0]), one
        )
    assert delta == pytest.approx([0.0, 24.0])
    assert phase.tolist() == [0.0, 0.0]
    assert low[0] == 0.0
