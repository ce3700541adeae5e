# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The two-axis branch: its formulas by Lagrange's, its step by a numpy twin, its guard."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from tree_sway_lab.methods import two_axis
from tree_sway_lab.methods.branch_bank import guards, step_bank

from tree_sway.core.oscillators.propagation import propagator

angle = st.floats(-1.6, 1.6)
rate = st.floats(-5, 5)
load = st.floats(-3, 3)


def direction(x, y):
    """Chord of the branch in its rest frame."""
    theta = np.hypot(x, y)
    return np.array([np.cos(theta), np.sinc(theta / np.pi) * x, np.sinc(theta / np.pi) * y])


def metric(x, y):
    """Kinetic metric: du . du as a form in dx, dy."""
    t = x * x + y * y
    q = (np.sinc(np.sqrt(t) / np.pi) ** 2 - 1) / t if t > 1e-12 else -1 / 3
    return np.eye(2) + q * np.array([[y * y, -x * y], [-x * y, x * x]])


def difference(f, at, along, h=1e-5):
    """Fourth-order central difference."""
    d = h * np.asarray(along)
    return (8 * (f(at + d) - f(at - d)) - (f(at + 2 * d) - f(at - 2 * d))) / (12 * h)


def twin(state, force, row, guard):
    """One step in plain numpy, with sines and cosines in place of the series."""

    def moment(x, y, vx, vy):
        t = x * x + y * y
        th = np.sqrt(t)
        sinc, cos = np.sinc(th / np.pi), np.cos(th)
        e, v, perp = np.array([x, y]), np.array([vx, vy]), force[1:]
        spin = x * vy - y * vx
        f = perp / sinc - force[0] * sinc * e
        if t > 0:
            f = f + e * (e @ perp) * (cos - 1 / sinc) / t
            f = f + guard[0] * (
                (sinc * cos - 1) * spin**2 / t**2 * e
                + 2 * (e @ v) * spin / t**2 * (1 - cos / sinc) * np.array([-y, x])
            )
        size = np.hypot(*f)
        return f * min(1.0, guard[2] / size) if size > 0 else f

    size = np.linalg.norm(force)
    force = force * min(1.0, guard[1] / size) if size > 0 else force
    e, v = state[:2], state[2:]
    m0 = moment(*state)
    e1 = row[0] * e + row[1] * v + (row[2] + row[3]) * m0
    v1 = row[4] * e + row[5] * v + (row[6] + row[7]) * m0
    m1 = moment(*e1, *v1)
    return np.concatenate(
        [
            row[0] * e + row[1] * v + row[2] * m0 + row[3] * m1,
            row[4] * e + row[5] * v + row[6] * m0 + row[7] * m1,
        ]
    )


@settings(max_examples=200, deadline=None)
@given(x=angle, y=angle, wb=load, w1=load, w2=load)
def test_true_force_is_lagranges(x, y, wb, w1, w2):
    """The moment is the metric's inverse times the gradient of W . u."""
    w, at = np.array([wb, w1, w2]), np.array([x, y])
    gradient = [difference(lambda e: w @ direction(*e), at, axis) for axis in np.eye(2)]
    expected = np.linalg.solve(metric(x, y), gradient)
    assert two_axis.true_force(x, y, wb, w1, w2) == pytest.approx(expected, abs=3e-7)


def test_true_force_at_rest_is_the_transverse_load():
    assert two_axis.true_force(0.0, 0.0, 5.0, 0.3, -0.4) == (0.3, -0.4)


@settings(max_examples=200, deadline=None)
@given(x=angle, y=angle, vx=rate, vy=rate)
def test_gyroscopic_term_keeps_to_geodesics(x, y, vx, vy):
    """Christoffel symbols of the metric, by differences."""
    at, v = np.array([x, y]), np.array([vx, vy])
    along_v = difference(lambda e: metric(*e) @ v, at, v) if v.any() else np.zeros(2)
    gradient = [difference(lambda e: 0.5 * v @ metric(*e) @ v, at, axis) for axis in np.eye(2)]
    expected = np.linalg.solve(metric(x, y), gradient - along_v)
    assert two_axis.gyroscopic(x, y, vx, vy) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ('theta', 'bound'), [(0.05, 1e-14), (0.5, 1e-11), (1.57, 1e-9), (2.35, 5e-9)]
)
def test_the_series_keeps_its_promise(theta, bound):
    w = (0.3, 0.8, -0.5)
    x, y = theta * 0.6, theta * 0.8
    sinc, cos, t = np.sin(theta) / theta, np.cos(theta), theta * theta
    along = (x * w[1] + y * w[2]) * (cos - 1 / sinc) / t - w[0] * sinc
    exact = w[1] / sinc + x * along, w[2] / sinc + y * along
    assert two_axis.true_force(x, y, *w) == pytest.approx(exact, abs=bound / sinc)


def bank(n, seed, dt=1 / 60):
    rng = np.random.default_rng(seed)
    w, inertia = 2 * np.pi * rng.uniform(0.3, 3, n), rng.uniform(0.01, 5, n)
    stiffness = inertia * w * w
    rows = propagator(inertia, 2 * 0.05 * w * inertia, stiffness, dt)
    state = np.vstack([rng.uniform(-0.8, 0.8, (2, n)), rng.uniform(-2, 2, (2, n))])
    return (
        state,
        rng.normal(0, 0.7, (3, n)) * stiffness,
        rows,
        guards(inertia, stiffness, dt),
    )


def test_bank_agrees_with_its_twin():
    state, force, rows, guard = bank(200, 1)
    expected = [twin(state[:, i], force[:, i], rows[i], guard[i]) for i in range(200)]
    clamped = step_bank(state, force, rows, guard)
    assert clamped == np.count_nonzero(np.linalg.norm(force, axis=0) > guard[:, 1]) == 0
    assert state.T == pytest.approx(np.array(expected), abs=1e-8)


def test_single_precision_keeps_its_own_kind_and_its_digits():
    state, force, rows, guard = bank(200, 2)
    single = [a.astype(np.float32) for a in (state, force, rows, guard)]
    step_bank(state, force, rows, guard)
    step_bank(*single)
    assert single[0].dtype == np.float32
    assert np.max(np.abs(single[0] - state)) < 2e-5


def test_mirrored_and_turned_loads_give_mirrored_and_turned_motion():
    state, force, rows, guard = bank(50, 3)
    mirrored, turned = state * [[-1], [1], [-1], [1]], state[[1, 0, 3, 2]] * [[-1], [1], [-1], [1]]
    step_bank(mirrored, force * [[1], [-1], [1]], rows, guard)
    step_bank(turned, force[[0, 2, 1]] * [[1], [-1], [1]], rows, guard)
    step_bank(state, force, rows, guard)
    assert mirrored == pytest.approx(state * [[-1], [1], [-1], [1]], abs=1e-13)
    assert turned == pytest.approx(state[[1, 0, 3, 2]] * [[-1], [1], [-1], [1]], abs=1e-12)


@pytest.mark.parametrize('scale', [1.0, 1e4, 1e200])
def test_loads_beyond_the_limit_are_held_and_counted(scale):
    wb, w1, w2, clamped = two_axis.limit_load(1.0 * scale, -4.0 * scale, 8.0 * scale, 3.0)
    assert clamped == 1
    if scale < 1e150:
        assert (wb, w1, w2) == pytest.approx((1 / 3, -4 / 3, 8 / 3))
    else:
        assert (wb, w1, w2) == (0.0, 0.0, 0.0)
    assert two_axis.limit_load(1.0, 2.0, 2.0, 3.0) == (1.0, 2.0, 2.0, 0)


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf])
def test_a_load_that_is_no_number_does_not_reach_the_state(bad):
    state, force, rows, guard = bank(3, 4)
    force[1, 1] = bad
    assert step_bank(state, force, rows, guard) == 1
    assert np.isfinite(state).all()


def test_no_load_keeps_rest():
    _, force, rows, guard = bank(5, 5)
    rest = np.zeros((4, 5))
    step_bank(rest, force * 0, rows, guard)
    assert not rest.any()


def test_guards_follow_the_step():
    """The gyroscopic term ends at w h = 0.5; the load followed is 3 / (w h)^2, from 0.8 to 10."""
    stiffness = np.array([0.04, 0.24, 0.26, 1.0, 100.0, 0.0])
    guard = guards(np.ones(6), stiffness, 1.0)
    assert guard[:, 0].tolist() == [1.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    assert guard[:5, 1] / stiffness[:5] == pytest.approx([10.0, 10.0, 10.0, 3.0, 0.8])
    assert guard[:5, 2] == pytest.approx(1.5 * guard[:5, 1])
    assert np.isinf(guard[5, 1:]).all()


def test_beyond_the_guard_the_force_is_the_circles():
    """At any angle a load across bends no more than itself."""
    edge = np.sqrt(two_axis.T_MAX)
    for theta in (2.5, 7.0, 1e6):
        assert two_axis.true_force(theta, 0.0, 0.3, 1.0, 0.0) == pytest.approx(
            two_axis.true_force(edge, 0.0, 0.3, 1.0, 0.0)
        )
