# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The exact propagator: against mpmath over every scale, its limits, and what it refuses."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.linalg import expm

from tree_sway.core.oscillators.propagation import fill_propagator, propagator
from tree_sway.errors import ParameterError

mpmath = pytest.importorskip('mpmath', reason='needs mpmath, an oracle of many digits')
RATIOS = (0, 1e-8, 1e-3, 0.02, 0.05, 0.5, 0.999, 1, 1.0000001, 1.001, 1.05, 1.2, 2, 5, 50, 1000)
positive = st.floats(1e-3, 1e3)


def textbook(inertia, damping, stiffness, dt):
    """Return the eight coefficients by the textbook formulas, in 80 digits."""
    with mpmath.workdps(80):
        i, c, k, h = (mpmath.mpf(float(v)) for v in (inertia, damping, stiffness, dt))
        a, kap = c / (2 * i), k / i
        root = mpmath.sqrt(mpmath.mpc(a * a - kap))
        fast, slow = mpmath.exp((-root - a) * h), mpmath.exp((root - a) * h)
        s = ((slow - fast) / (2 * root)).real if root else h * mpmath.exp(-a * h)
        mean = ((slow + fast) / 2).real
        g = mean + a * s
        p1 = (1 - g) / kap
        p2 = (h - s - 2 * a * p1) / (kap * h)
        exact = [g, s, (p1 - p2) / i, p2 / i, -kap * s, mean - a * s, (s - p1 / h) / i, p1 / h / i]
        return exact, abs(mean) + abs(a * s)


@pytest.mark.parametrize('exponent', range(-8, 5))
def test_coefficients_agree_with_mpmath(exponent):
    for ratio in RATIOS:
        inertia, dt = 0.37, 1 / 60
        w = 10.0**exponent / dt
        damping, stiffness = 2 * ratio * w * inertia, inertia * w * w
        exact, scale = textbook(inertia, damping, stiffness, dt)
        for name, value, true in zip(
            range(8), propagator(inertia, damping, stiffness, dt)[0], exact, strict=True
        ):
            if abs(true) < 1e-290:
                assert abs(value) < 1e-290
                continue
            unit = scale if name == 5 else abs(true)  # c5 crosses zero where a h = 1
            assert abs(value - true) <= 1e-12 * unit, (exponent, ratio, name)


def augmented(inertia, damping, stiffness, dt):
    """Return the same row from the exponential of the augmented matrix (Van Loan 1978)."""
    a = np.zeros((4, 4))
    a[0, 1] = dt
    a[1] = [-stiffness / inertia * dt, -damping / inertia * dt, dt / inertia, 0]
    a[2, 3] = 1
    e = expm(a)
    row = np.empty(8)
    for at, line in ((0, 0), (4, 1)):
        row[at : at + 4] = e[line, 0], e[line, 1], e[line, 2] - e[line, 3], e[line, 3]
    return row


@settings(max_examples=200, deadline=None)
@given(inertia=positive, damping=st.floats(0, 1e2), stiffness=st.floats(0, 1e3))
def test_any_oscillator_agrees_with_the_matrix_exponential(inertia, damping, stiffness):
    dt = 0.02
    row = propagator(inertia, damping, stiffness, dt)[0]
    scale = np.repeat([[1, dt, dt * dt / inertia, dt * dt / inertia]], 2, 0)
    scale[1] *= max(1.0, damping / inertia * dt, stiffness / inertia * dt * dt) / dt
    assert np.all(
        np.abs(row - augmented(inertia, damping, stiffness, dt)) <= 1e-11 * scale.ravel()
    )


def test_free_body_and_free_damped_body():
    h, i = 0.1, 2.0
    assert propagator(i, 0, 0, h)[0] == pytest.approx(
        [1, h, h * h / i / 3, h * h / i / 6, 0, 1, h / i / 2, h / i / 2], rel=1e-15
    )
    assert propagator(i, 3.0, 0, h)[0] == pytest.approx(augmented(i, 3.0, 0, h), rel=1e-13)


@pytest.mark.parametrize('stiffness', [0.0, 0.3, 40.0, 4e4])
def test_no_inertia_is_the_limit_of_a_small_one(stiffness):
    limit = propagator(0, 0.5, stiffness, 0.05)[0]
    small = propagator(1e-11, 0.5, stiffness, 0.05)[0]
    assert limit == pytest.approx(small, rel=1e-5, abs=1e-9)


def test_no_inertia_no_damping_is_static():
    x1, v1 = propagator(0, 0, 4.0, 0.5)[0].reshape(2, 4) @ [9.0, 9.0, 2.0, 8.0]
    assert x1 == 8.0 / 4.0
    assert v1 == pytest.approx((8.0 - 2.0) / 4.0 / 0.5)


@pytest.mark.parametrize('stiffness', [0.0, 7.0, 1e300])
def test_extreme_values_stay_finite(stiffness):
    for inertia in (1e-290, 1e-200, 1e-30, 1e200):
        for damping in (0.0, 1e-290, 1e-3, 1e200):
            assert np.isfinite(propagator(inertia, damping, stiffness, 1 / 60)).all()


def test_refuses_by_name():
    with pytest.raises(ParameterError, match=r'oscillator 1: .*all zero'):
        propagator([1.0, 0.0], [0.0, 0.0], [1.0, 0.0], 0.1)
    with pytest.raises(ParameterError, match=r'stiffness: -1\.0 of oscillator 2'):
        propagator(1.0, 0.1, [1.0, 2.0, -1.0], 0.1)
    with pytest.raises(ParameterError, match='inertia: nan of oscillator 0'):
        propagator(np.nan, 0.1, 1.0, 0.1)
    for dt in (0.0, -0.1, np.inf, np.nan):
        with pytest.raises(ParameterError, match='time step'):
            propagator(1.0, 0.1, 1.0, dt)


def test_it_reports_the_first_refused_row_and_leaves_it_still():
    zero, one = np.zeros(3), np.array([1.0, 0.0, 1.0])
    out = np.full((3, 8), np.nan)
    assert fill_propagator(one, zero, one, 0.1, out) == 1
    assert out[1] @ [5.0, 1, 1, 1, 0, 0, 0, 0] == 5.0
    assert fill_propagator(one + 1, zero, one, 0.1, out) == -1


@settings(max_examples=100, deadline=None)
@given(
    inertia=positive, damping=st.floats(0, 1e3), stiffness=positive, split=st.floats(0.05, 0.95)
)
def test_two_steps_are_one(inertia, damping, stiffness, split):
    """The group law: a line cut in two pieces moves the state as the whole."""
    h, state, m0, m1 = 0.04, np.array([0.3, -1.0]), 2.0, -0.7
    middle = m0 + split * (m1 - m0)

    def step(state, dt, a, b):
        return propagator(inertia, damping, stiffness, dt)[0].reshape(2, 4) @ [*state, a, b]

    whole = step(state, h, m0, m1)
    pieces = step(step(state, split * h, m0, middle), (1 - split) * h, middle, m1)
    unit = 1 + np.sqrt(stiffness / inertia) + 1 / inertia
    assert pieces == pytest.approx(whole, abs=1e-12 * unit * (1 + damping / inertia))
