# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Dropouts, stalls and clocks: what a live stream does to the average of the wind."""

import math

import numpy as np
import pytest

from tree_sway_ros.core.wind.averaging import WindAverage

FRAME = 1.0 / 60.0
PERIOD = 0.05


def smooth(t):
    return np.array([5.0 + 2.0 * math.sin(1.3 * t), 1.5 * math.cos(2.1 * t), 0.0])


def run(
    average, duration, *, source=smooth, period=PERIOD, latency=0.0, hears=lambda t: True, since=0.0
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


class TestDropouts:
    def test_no_wind_ever(self):
        average = WindAverage()
        _, means = run(average, 1.0, hears=lambda t: False)
        assert not means.any()
        assert average.state(1.0) == "none"

    @pytest.mark.parametrize("length", [0.1, 0.5, 1.0, 2.0])
    @pytest.mark.parametrize("interpolation", ["linear", "hold"])
    def test_a_short_one_is_held_without_a_visible_step(self, length, interpolation):
        average = WindAverage(interpolation)
        ends, means = run(
            average, 8.0, hears=lambda t: not 4.0 < t < 4.0 + length - 1e-9, source=smooth
        )
        gap = (ends > 4.0 + 3 * PERIOD) & (ends < 4.0 + length)
        np.testing.assert_allclose(means[gap], np.tile(smooth(4.0), (gap.sum(), 1)), atol=1e-6)
        lost = np.abs(smooth(4.0) - smooth(4.0 + length)).max()
        usual = 4.1 * FRAME if interpolation == "linear" else 4.1 * PERIOD
        limit = usual + lost * FRAME / min(length, 0.5)
        assert np.abs(np.diff(means[30:], axis=0)).max() < 1.1 * limit

    def test_a_long_one_decays_with_its_time_constant(self):
        average = WindAverage()
        constant = np.array([6.0, 0.0, 0.0])
        ends, means = run(average, 30.0, source=lambda t: constant, hears=lambda t: t <= 1.0)
        held = ends <= 3.0
        np.testing.assert_allclose(means[held][:, 0], 6.0, rtol=1e-12)
        tail = ends > 3.1
        start = ends[tail] - FRAME
        exact = (
            6.0 * 3.0 / FRAME * (np.exp(-(start - 3.0) / 3.0) - np.exp(-(ends[tail] - 3.0) / 3.0))
        )
        np.testing.assert_allclose(means[tail][:, 0], exact, rtol=1e-6)

    def test_the_states_of_a_dropout_in_order(self):
        average = WindAverage()
        assert average.state(0.0) == "none"
        run(average, 1.0, hears=lambda t: t < 0.99)
        states = [average.state(t) for t in np.arange(1.0, 40.0, 0.01)]
        order = list(dict.fromkeys(states))
        assert order == ["live", "holding", "decaying", "stale"]
        seconds = {state: states.count(state) / 100 for state in order}
        assert seconds["holding"] == pytest.approx(2.0 - 2 * PERIOD, abs=0.03)
        assert seconds["decaying"] == pytest.approx(15.0, abs=0.03)

    def test_a_slow_sensor_is_stale_only_after_three_periods(self):
        average = WindAverage()
        run(average, 10.5, period=2.0, hears=lambda t: t <= 10.0)
        assert average.state(15.9) == "holding"
        assert average.state(16.1) == "decaying"

    @pytest.mark.parametrize("length", [2.5, 5.0, 60.0])
    @pytest.mark.parametrize("interpolation", ["linear", "hold"])
    def test_the_first_sample_after_a_long_one_is_blended(self, length, interpolation):
        average = WindAverage(interpolation)
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

    @pytest.mark.parametrize("stall", [0.3, 1.0, 1.8, 3.0, 8.0])
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
        assert average.state(20.0) == "live"

    def test_it_resumes_after_a_dropout_and_follows_again(self):
        ends, means = run(WindAverage(), 14.0, hears=lambda t: not 2.0 < t < 9.0)
        live = ends > 10.0
        expected = delayed_mean(smooth, ends, PERIOD)
        np.testing.assert_allclose(means[live], expected[live], atol=0.05)


class TestClocks:
    def test_set_back_it_begins_anew_from_the_wind_there_is(self):
        average = WindAverage()
        _, before = run(average, 5.0, since=900.0)
        _, after = run(average, 5.0, since=0.0)
        means = np.concatenate([before[60:], after])
        assert np.abs(np.diff(means, axis=0)).max() < 0.3  # the fade of 0.5 s, and the wind itself
        fresh = WindAverage()
        _, expected = run(fresh, 5.0)
        np.testing.assert_allclose(after[120:], expected[120:], atol=1e-6)

    def test_set_back_without_wind_it_stays_calm(self):
        average = WindAverage()
        average.mean(900.0, 900.1)
        assert not average.mean(0.0, 0.1).any()
        assert average.state(0.1) == "none"

    def test_set_forward_it_is_as_if_no_time_had_passed(self):
        average = WindAverage()
        _, before = run(average, 5.0)
        _, after = run(average, 5.0, since=4000.0)
        means = np.concatenate([before[60:], after])
        assert np.abs(np.diff(means, axis=0)).max() < 0.3  # the fade of 0.5 s, and the wind itself
        assert average.state(4005.0) == "live"

    def test_set_forward_in_a_dropout_it_does_not_drop_to_calm_at_once(self):
        average = WindAverage()
        run(average, 2.0, source=lambda t: np.array([8.0, 0.0, 0.0]))
        assert average.mean(5000.0, 5000.0 + FRAME)[0] == pytest.approx(8.0)

    def test_looking_at_the_recent_past_is_no_clock_set_back(self):
        average = WindAverage()
        ends, means = run(average, 3.0)
        index = len(ends) - 20
        again = average.mean(ends[index] - FRAME, ends[index])
        np.testing.assert_allclose(again, means[index], atol=1e-12)
