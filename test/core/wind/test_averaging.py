# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Means of the wind over steps; dropouts, stalls and clocks: what a live stream does to them."""

from itertools import pairwise
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.wind.averaging import CAPACITY, WindAverage
from tree_sway.errors import ParameterError

FRAME = 1.0 / 60.0
PERIOD = 0.05
WIND = st.tuples(*[st.floats(-40.0, 40.0)] * 3)


def smooth(t):
    return np.array([5.0 + 2.0 * math.sin(1.3 * t), 1.5 * math.cos(2.1 * t), 0.0])


def run(
    average,
    duration,
    *,
    source=smooth,
    period=PERIOD,
    latency=0.0,
    hears=lambda t: True,
    since=0.0,
):
    """Feed samples as they arrive to a 60 Hz solver; return ends of the steps and means."""
    means, ends, k = [], [], 0
    for frame in range(round(duration / FRAME)):
        start, end = since + frame * FRAME, since + (frame + 1) * FRAME
        while since + k * period + latency <= end:
            time = since + k * period
            if hears(time):
                assert average.add(time, source(time))
            k += 1
        ends.append(end)
        means.append(average.mean(start, end))
    return np.array(ends), np.array(means)


def delayed_mean(source, ends, delay, period=PERIOD):
    """Mean over each frame of the samples joined by lines and delayed, by brute force."""
    grid = np.arange(-1, int(ends[-1] / period) + 3) * period
    values = np.array([source(t) for t in grid])
    inner = (np.arange(40) + 0.5) / 40 * FRAME
    times = ends[:, np.newaxis] - FRAME + inner - delay
    return np.stack([np.interp(times, grid, c).mean(axis=1) for c in values.T], axis=1)


def test_linear_is_the_mean_of_straight_lines_one_period_late():
    ends, means = run(WindAverage(), 5.0)
    live = ends > 0.3
    expected = delayed_mean(smooth, ends, PERIOD)
    np.testing.assert_allclose(means[live], expected[live], atol=1e-4)


def test_a_sensor_slower_than_the_timeout_is_known_from_its_second_sample():
    _, means = run(WindAverage(), 60.0, source=lambda t: np.array([4.0, 0.0, 0.0]), period=10.0)
    assert means[round(9.9 / FRAME), 0] < 0.4  # with one sample no period is known: it decays
    np.testing.assert_allclose(means[round(11.0 / FRAME) :, 0], 4.0, rtol=1e-12)


@pytest.mark.parametrize('latency', [0.003, 0.03, 0.2, 1.5])
def test_samples_that_arrive_late_only_delay_the_curve(latency):
    average = WindAverage()
    ends, means = run(average, 6.0, latency=latency)
    live = ends > 4.0
    errors = [
        np.abs(means - delayed_mean(smooth, ends, PERIOD + delay))[live].max()
        for delay in np.linspace(latency - FRAME, latency + FRAME, 21)
    ]
    assert min(errors) < 0.02
    assert (
        np.abs(np.diff(means[120:], axis=0)).max() < 1.2 * 4.1 * FRAME
    )  # no faster than the wind
    assert average.state(6.0) == 'live'


def test_jitter_of_stamps_makes_no_jumps():
    rng = np.random.default_rng(3)
    average = WindAverage()
    means, newest, k = [], -1.0, 0
    for frame in range(1200):
        end = (frame + 1) * FRAME
        while k * PERIOD + 0.04 <= end:
            newest = max(newest + 1e-3, k * PERIOD + rng.uniform(0.0, 0.04))
            assert average.add(newest, smooth(newest))
            k += 1
        means.append(average.mean(frame * FRAME, end))
    assert np.abs(np.diff(means[120:], axis=0)).max() < 0.2


@pytest.mark.parametrize('period', [0.01, 0.05, 1.0, 1.9])
def test_the_mean_of_a_constant_is_the_constant(period):
    constant = np.array([3.0, -2.0, 0.5])
    average = WindAverage()
    _, means = run(average, 8.0, source=lambda t: constant, period=period)
    np.testing.assert_allclose(means, np.tile(constant, (len(means), 1)), rtol=1e-13)


@given(
    st.lists(st.tuples(st.floats(0.02, 0.08), WIND), min_size=1, max_size=10),
    st.floats(-0.2, 1.0),
    st.floats(1e-3, 0.5),
    st.floats(1e-3, 6.0),
)
def test_means_are_additive(samples, start, first, second):
    average = WindAverage()
    time = 0.0
    for gap, wind in samples:
        time += gap
        average.add(time, wind)
    middle, end = start + first, start + first + second
    parts = first * average.mean(start, middle) + second * average.mean(middle, end)
    np.testing.assert_allclose((end - start) * average.mean(start, end), parts, atol=1e-8)


@given(
    st.lists(st.tuples(st.floats(0.01, 4.0), WIND), min_size=1, max_size=15),
    st.floats(0.1, 5.0),
)
def test_mirrored_and_scaled_wind_gives_mirrored_and_scaled_means(samples, k):
    plain, mirrored = WindAverage(), WindAverage()
    time = 0.0
    for gap, wind in samples:
        start, time = time, time + gap
        wind = np.array(wind)
        plain.add(time, wind)
        mirrored.add(time, -k * wind)
        expected = -k * plain.mean(start, time)
        np.testing.assert_allclose(mirrored.mean(start, time), expected, atol=1e-9)


@given(
    st.lists(st.tuples(st.floats(0.0, 3.0), WIND, st.booleans()), max_size=30),
)
def test_the_mean_stays_within_the_largest_sample(samples):
    average = WindAverage()
    time, largest = 0.0, 0.0
    for wait, wind, is_heard in samples:
        if is_heard and average.add(time + 0.5 * wait, wind):
            largest = max(largest, *map(abs, wind))
        mean = average.mean(time, time + wait)
        time += wait
        assert np.abs(mean).max() <= largest * (1.0 + 1e-9)


STREAMS = st.lists(
    st.tuples(
        st.sampled_from([0.01, 0.05, 0.3, 2.5, 9.0]) | st.floats(0.0, 12.0), WIND, st.booleans()
    ),
    max_size=40,
)


@given(
    STREAMS,
    st.floats(-40.0, 40.0),
    st.floats(-3.0, 1.0),
)
def test_the_mean_stays_in_the_convex_hull_of_samples_and_calm(samples, low, late):
    """In any direction no mean lies beyond the farthest sample, whatever was lost or late."""
    average = WindAverage()
    direction = np.array([math.cos(low), math.sin(low), 0.3])
    time, farthest = 0.0, 0.0
    for wait, wind, is_heard in samples:
        if is_heard and average.add(time + late * wait, wind):
            farthest = max(farthest, float(direction @ wind))
        mean = average.mean(time, time + wait)
        time += wait
        assert direction @ mean <= farthest + 1e-9


def test_a_wind_that_turns_while_it_fades_in_is_no_faster_than_its_samples():
    """After a drop-out comes the other way, and turns back at once."""
    average, largest = WindAverage(), 0.0
    for frame in range(600):
        end = frame * FRAME
        if not 2.0 < end < 6.0:
            average.add(end - 0.5 * FRAME, (20.0 if end < 2.0 or end > 6.1 else -20.0, 0.0, 0.0))
        largest = max(largest, float(np.abs(average.mean(end - FRAME, end)).max()))
    assert largest == pytest.approx(20.0, abs=1e-9)


def test_a_fade_is_exactly_the_mean_of_the_mix():
    average = WindAverage()
    run(average, 2.0)
    for frame in range(120, 420):
        average.mean(frame * FRAME, (frame + 1) * FRAME)
    average.add(7.0, (3.0, -9.0, 1.0))
    average.add(7.05, (-5.0, 2.0, 0.0))
    average.add(7.1, (4.0, 2.0, 0.0))
    edges = 7.0 + np.linspace(0.0, 0.7, 15)
    fine = np.array([average.mean(t, t) for t in 7.0 + 1e-4 * (np.arange(7000) + 0.5)])
    for k, (start, end) in enumerate(pairwise(edges)):
        expected = fine[k * 500 : (k + 1) * 500].mean(axis=0)
        np.testing.assert_allclose(average.mean(start, end), expected, atol=1e-3)


def test_its_state_may_be_asked_while_another_thread_feeds_it():
    """The newest sample may be forgotten between two looks at it."""

    class Forgetting(WindAverage):
        looks = 0

        @property
        def _newest(self):
            self.looks += 1
            return 1.0 if self.looks == 1 else None

        @_newest.setter
        def _newest(self, value):
            self.looks = 0

    assert Forgetting().state(5.0) == 'decaying'


class TestRefusals:
    """Samples, steps and options that are refused."""

    @pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
    def test_not_finite_leaves_no_trace(self, bad):
        average, untouched = WindAverage(), WindAverage()
        for a in (average, untouched):
            run(a, 1.0)
        assert not average.add(1.01, (bad, 0.0, 0.0))
        assert not average.add(bad, (1.0, 0.0, 0.0))
        assert average.refused == 2
        np.testing.assert_array_equal(average.mean(1.0, 1.1), untouched.mean(1.0, 1.1))

    def test_out_of_order_is_refused_and_counted(self):
        average = WindAverage()
        average.add(1.0, (1.0, 0.0, 0.0))
        assert not average.add(1.0, (2.0, 0.0, 0.0))
        assert not average.add(0.9, (2.0, 0.0, 0.0))
        assert average.refused == 2

    @pytest.mark.parametrize('step', [(1.0, 0.9), (math.nan, 1.0), (0.0, math.inf)])
    def test_a_step_that_cannot_be(self, step):
        with pytest.raises(ParameterError, match='no step from'):
            WindAverage().mean(*step)

    def test_a_step_of_no_length_gives_the_value(self):
        average = WindAverage()
        run(average, 1.0)
        np.testing.assert_allclose(
            average.mean(0.97, 0.97), average.mean(0.97 - 1e-7, 0.97 + 1e-7)
        )

    @pytest.mark.parametrize(
        'options',
        [{'timeout': 0.0}, {'decay': -1.0}, {'decay': math.nan}],
    )
    def test_parameters_out_of_range(self, options):
        with pytest.raises(ParameterError, match=f'{next(iter(options))}: .* out of range'):
            WindAverage(**options)


def test_memory_is_bounded():
    average = WindAverage()
    for i in range(5000):
        average.add(i * 0.01, (1.0, 0.0, 0.0))
    assert len(average._curve.knots) == CAPACITY


class TestDropouts:
    """Samples that stop coming, for a while or for good."""

    def test_no_wind_ever(self):
        average = WindAverage()
        _, means = run(average, 1.0, hears=lambda t: False)
        assert not means.any()
        assert average.state(1.0) == 'none'

    @pytest.mark.parametrize('length', [0.1, 0.5, 1.0, 2.0])
    def test_a_short_one_is_held_without_a_visible_step(self, length):
        average = WindAverage()
        ends, means = run(
            average, 8.0, hears=lambda t: not 4.0 < t < 4.0 + length - 1e-9, source=smooth
        )
        gap = (ends > 4.0 + 3 * PERIOD) & (ends < 4.0 + length)
        np.testing.assert_allclose(means[gap], np.tile(smooth(4.0), (gap.sum(), 1)), atol=1e-6)
        lost = np.abs(smooth(4.0) - smooth(4.0 + length)).max()
        usual = 4.1 * FRAME
        limit = usual + lost * FRAME / min(length, 0.5)
        assert np.abs(np.diff(means[30:], axis=0)).max() < 1.1 * limit

    def test_a_long_one_decays_with_its_time_constant(self):
        average = WindAverage()
        constant = np.array([6.0, 0.0, 0.0])
        ends, means = run(average, 30.0, source=lambda t: constant, hears=lambda t: t <= 1.0)
        early = ends <= 3.0
        np.testing.assert_allclose(means[early][:, 0], 6.0, rtol=1e-12)
        tail = ends > 3.1
        start = ends[tail] - FRAME
        exact = (
            6.0 * 3.0 / FRAME * (np.exp(-(start - 3.0) / 3.0) - np.exp(-(ends[tail] - 3.0) / 3.0))
        )
        np.testing.assert_allclose(means[tail][:, 0], exact, rtol=1e-6)

    def test_the_states_of_a_dropout_in_order(self):
        average = WindAverage()
        assert average.state(0.0) == 'none'
        run(average, 1.0, hears=lambda t: t < 0.99)
        states = [average.state(t) for t in np.arange(1.0, 40.0, 0.01)]
        order = list(dict.fromkeys(states))
        assert order == ['live', 'holding', 'decaying', 'stale']
        seconds = {state: states.count(state) / 100 for state in order}
        assert seconds['holding'] == pytest.approx(2.0 - 2 * PERIOD, abs=0.03)
        assert seconds['decaying'] == pytest.approx(15.0, abs=0.03)

    def test_a_slow_sensor_is_stale_only_after_three_periods(self):
        average = WindAverage()
        run(average, 10.5, period=2.0, hears=lambda t: t <= 10.0)
        assert average.state(15.9) == 'holding'
        assert average.state(16.1) == 'decaying'

    @pytest.mark.parametrize('length', [2.5, 5.0, 60.0])
    def test_the_first_sample_after_a_long_one_is_blended(self, length):
        average = WindAverage()
        _, means = run(
            average,
            length + 4.0,
            source=lambda t: np.array([10.0, 0.0, 0.0]),
            hears=lambda t: t < 2.0 or t > 2.0 + length,
        )
        assert np.abs(np.diff(means[:, 0])).max() <= 10.0 * FRAME / 0.5 + 1e-9
        assert means[-1, 0] == pytest.approx(10.0)

    def test_the_very_first_sample_is_blended_too_if_calm_was_shown(self):
        average = WindAverage()
        _, means = run(
            average, 3.0, source=lambda t: np.array([9.0, 0, 0]), hears=lambda t: t > 1.0
        )
        assert not means[:59].any()
        assert np.abs(np.diff(means[:, 0])).max() <= 9.0 * FRAME / 0.5 + 1e-9
        assert means[-1, 0] == pytest.approx(9.0)

    @pytest.mark.parametrize('stall', [0.3, 1.0, 1.8, 3.0, 8.0])
    def test_a_stalled_network_that_delivers_all_at_once_makes_no_jump(self, stall):
        average = WindAverage()
        means, k = [], 0
        for frame in range(round(20.0 / FRAME)):
            end = (frame + 1) * FRAME
            while k * PERIOD <= end and not 4.0 < end < 4.0 + stall:
                assert average.add(k * PERIOD, smooth(k * PERIOD))
                k += 1
            means.append(average.mean(end - FRAME, end))
        # At most the fade of what was lost while it lasted.
        lost = max(
            np.abs(smooth(4.0)).max(), np.ptp([smooth(t / 10) for t in range(100)], axis=0).max()
        )
        limit = 4.1 * FRAME / 0.75 + lost * FRAME / min(stall, 0.5)
        assert np.abs(np.diff(means[30:], axis=0)).max() < limit
        assert average.state(20.0) == 'live'

    def test_it_resumes_after_a_dropout_and_follows_again(self):
        ends, means = run(WindAverage(), 14.0, hears=lambda t: not 2.0 < t < 9.0)
        live = ends > 10.0
        expected = delayed_mean(smooth, ends, PERIOD)
        np.testing.assert_allclose(means[live], expected[live], atol=0.05)


class TestClocks:
    """Clocks that jump ahead."""

    def test_set_forward_it_is_as_if_no_time_had_passed(self):
        average = WindAverage()
        _, before = run(average, 5.0)
        _, after = run(average, 5.0, since=4000.0)
        means = np.concatenate([before[60:], after])
        assert np.abs(np.diff(means, axis=0)).max() < 0.3  # the fade of 0.5 s, and the wind itself
        assert average.state(4005.0) == 'live'

    def test_set_forward_in_a_dropout_it_does_not_drop_to_calm_at_once(self):
        average = WindAverage()
        run(average, 2.0, source=lambda t: np.array([8.0, 0.0, 0.0]))
        assert average.mean(5000.0, 5000.0 + FRAME)[0] == pytest.approx(8.0)

    def test_the_recent_past_may_be_looked_at_again(self):
        average = WindAverage()
        ends, means = run(average, 3.0)
        index = len(ends) - 20
        again = average.mean(ends[index] - FRAME, ends[index])
        np.testing.assert_allclose(again, means[index], atol=1e-12)
