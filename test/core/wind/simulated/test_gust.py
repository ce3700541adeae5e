# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from functools import partial
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.optimize import brentq

from tree_sway.core.wind.simulated.gust_event import GustEvent
from tree_sway.errors import ParameterError

TIME = np.linspace(-5.0, 30.0, 7001)

amplitudes = st.floats(-30.0, 30.0)
durations = st.floats(0.1, 60.0)
starts = st.floats(-10.0, 20.0)


def gust(kind, time, amplitude, duration, start=0.0):
    return GustEvent(kind, amplitude, duration, start).at(time)


PASSING = [partial(gust, kind) for kind in ('one_minus_cos', 'extreme_operating_gust')]
LASTING = [partial(gust, kind) for kind in ('step', 'direction_change', 'turn')]


@pytest.mark.parametrize('shape', PASSING)
@given(amplitudes, durations, starts)
def test_a_gust_is_nothing_before_and_after(shape, amplitude, duration, start):
    before, after = shape(
        np.array([start - 1.0, start + duration + 1.0]), amplitude, duration, start
    )
    assert before == 0.0
    assert abs(after) < 1e-12


@pytest.mark.parametrize('shape', LASTING)
@given(amplitudes, durations, starts)
def test_what_lasts_is_nothing_before_and_all_of_it_after(shape, amplitude, duration, start):
    before, after = shape(
        np.array([start - 1.0, start + duration + 1.0]), amplitude, duration, start
    )
    assert before == 0.0
    assert after == pytest.approx(amplitude)


@pytest.mark.parametrize('shape', PASSING + LASTING)
@given(amplitudes, durations, starts, st.floats(-3.0, 3.0))
def test_linear_in_the_amplitude_and_carried_by_the_start(shape, amplitude, duration, start, k):
    value = shape(TIME, amplitude, duration, start)
    np.testing.assert_allclose(shape(TIME, k * amplitude, duration, start), k * value, atol=1e-10)
    np.testing.assert_allclose(
        shape(TIME + 2.0, amplitude, duration, start + 2.0), value, atol=1e-8
    )


@pytest.mark.parametrize('shape', PASSING + LASTING)
def test_continuous_and_finite(shape):
    value = shape(TIME, 10.0, 5.0, 1.0)
    assert value.shape == TIME.shape
    assert np.isfinite(value).all()
    assert np.abs(np.diff(value)).max() < 10.0 * 7.0 / 5.0 * (TIME[1] - TIME[0])


@pytest.mark.parametrize('shape', PASSING + LASTING)
def test_a_scalar_time_gives_a_scalar(shape):
    assert np.shape(shape(2.0, 1.0, 5.0)) == ()


def test_one_minus_cos_peaks_halfway_and_has_half_its_peak_for_a_mean():
    value = gust('one_minus_cos', np.array([0.0, 1.0, 2.0, 3.0, 4.0]), 8.0, 4.0)
    np.testing.assert_allclose(value, (0.0, 4.0, 8.0, 4.0, 0.0), atol=1e-14)
    inside = (TIME >= 0.0) & (TIME <= 4.0)
    assert gust('one_minus_cos', TIME[inside], 8.0, 4.0).mean() == pytest.approx(4.0, rel=2e-3)


def test_extreme_operating_gust_dips_peaks_and_dips():
    time = np.linspace(0.0, 10.5, 10501)
    value = gust('extreme_operating_gust', time, 10.0, 10.5)
    assert value.max() == pytest.approx(7.4)
    assert time[value.argmax()] == pytest.approx(5.25)
    np.testing.assert_allclose(value, value[::-1], atol=1e-12)
    # sin 3a (1 - cos 2a) = sin 3a - (sin 5a + sin a)/2; the dip is where its slope vanishes.
    a = brentq(lambda a: 3 * math.cos(3 * a) - 2.5 * math.cos(5 * a) - 0.5 * math.cos(a), 0.5, 0.9)
    dip = -3.7 * (math.sin(3 * a) - 0.5 * math.sin(5 * a) - 0.5 * math.sin(a))
    assert value.min() == pytest.approx(dip, abs=1e-5)
    assert np.sum(np.diff(np.sign(np.diff(value))) != 0) == 3


def test_step_is_sharp_or_a_ramp():
    np.testing.assert_array_equal(gust('step', [-0.1, 0.0, 0.1], 5.0, 0.0), (0.0, 5.0, 5.0))
    np.testing.assert_allclose(gust('step', [0.0, 0.5, 1.0, 2.0], 5.0, 1.0), (0.0, 2.5, 5.0, 5.0))


def test_direction_change_starts_and_ends_level_and_a_turn_is_steady():
    time = np.linspace(0.0, 6.0, 601)
    rate = np.diff(gust('direction_change', time, 1.0, 6.0)) / 0.01
    assert rate[0] < 0.01
    assert rate[-1] < 0.01
    assert rate.max() == pytest.approx(0.5 * math.pi / 6.0, rel=1e-3)
    np.testing.assert_allclose(np.diff(gust('turn', time, 1.0, 6.0)), 0.01 / 6.0)


@pytest.mark.parametrize('shape', PASSING + LASTING)
@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf, 1e9, 'much'])
def test_bad_parameters_are_refused(shape, bad):
    with pytest.raises(ParameterError, match='out of range'):
        shape(TIME, bad, 5.0, 0.0)
    with pytest.raises(ParameterError, match='duration'):
        shape(TIME, 1.0, bad, 0.0)
    with pytest.raises(ParameterError, match='start'):
        shape(TIME, 1.0, 5.0, bad)


@pytest.mark.parametrize('shape', [*PASSING, *LASTING[1:]])
@pytest.mark.parametrize('duration', [0.0, -1.0])
def test_only_a_step_may_take_no_time(shape, duration):
    with pytest.raises(ParameterError, match='duration'):
        shape(TIME, 1.0, duration)
