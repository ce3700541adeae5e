# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from hypothesis import assume, given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.wind.curve import WindCurve

KNOTS = st.lists(
    st.tuples(st.floats(0.01, 1.0), *[st.floats(-40.0, 40.0)] * 3), min_size=1, max_size=12
)
TIMES = st.floats(-1.0, 14.0)


def curve_of(knots, capacity=64):
    curve = WindCurve(capacity)
    time = 0.0
    times, values = [], []
    for gap, *value in knots:
        time += gap
        curve.append(time, np.array(value))
        times.append(time)
        values.append(value)
    return curve, np.array(times), np.array(values)


def exact_mean(times, values, start, end):
    """Mean by the trapezoidal rule on a grid with every knot: exact, another way."""
    grid = np.unique(np.concatenate([[start, end], times[(times > start) & (times < end)]]))
    width = np.diff(grid)[:, np.newaxis]
    at = np.stack([np.interp(grid, times, column) for column in values.T], axis=1)
    return (0.5 * width * (at[1:] + at[:-1])).sum(axis=0) / (end - start)


@given(KNOTS, TIMES, st.floats(1e-3, 8.0))
def test_the_mean_is_exact(knots, start, width):
    curve, times, values = curve_of(knots)
    expected = exact_mean(times, values, start, start + width)
    np.testing.assert_allclose(curve.mean(start, start + width), expected, atol=1e-9)


@given(KNOTS, TIMES)
def test_values_between_knots(knots, time):
    curve, times, values = curve_of(knots)
    expected = [np.interp(time, times, column) for column in values.T]
    np.testing.assert_allclose(curve.value(time), expected, atol=1e-11)


@given(KNOTS, TIMES, st.floats(1e-2, 4.0), st.floats(1e-2, 4.0))
def test_means_are_additive(knots, a, first, second):
    curve, *_ = curve_of(knots)
    b, c = a + first, a + first + second
    parts = first * np.array(curve.mean(a, b)) + second * np.array(curve.mean(b, c))
    np.testing.assert_allclose(np.array(curve.mean(a, c)) * (c - a), parts, atol=1e-9)


@given(KNOTS, st.floats(0.0, 12.0), TIMES)
def test_a_cut_keeps_the_past_and_levels_the_future(knots, at, time):
    before, times, _ = curve_of(knots)
    assume(at > times[0])
    after, *_ = curve_of(knots)
    after.cut(at)
    np.testing.assert_allclose(after.value(time), before.value(min(time, at)), atol=1e-9)


def test_memory_is_bounded_and_the_newest_stay():
    curve = WindCurve(8)
    for i in range(1000):
        curve.append(float(i), np.array([float(i), 0.0, 0.0]))
    assert len(curve.knots) == 8
    np.testing.assert_array_equal(curve.value(995.5), (995.5, 0.0, 0.0))
    np.testing.assert_array_equal(curve.value(3.0), (992.0, 0.0, 0.0))  # level before what is left


def test_a_knot_at_the_same_time_replaces_and_an_earlier_one_is_dropped():
    curve = WindCurve(8)
    for time, along in ((1.0, 1.0), (1.0, 2.0), (0.5, 9.0)):
        curve.append(time, np.array([along, 0.0, 0.0]))
    assert len(curve.knots) == 1
    assert (curve.end, curve.last[0]) == (1.0, 2.0)


def test_shift_moves_it_in_time():
    curve, *_ = curve_of([(1.0, 0.0, 0.0, 0.0), (1.0, 4.0, 0.0, 0.0)])
    curve.shift(10.0)
    assert curve.value(11.5) == pytest.approx((2.0, 0.0, 0.0))
    assert curve.mean(11.0, 12.0) == pytest.approx((2.0, 0.0, 0.0))
