# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from tree_sway.core.wind.sensor_timing import SensorTiming


def test_without_an_interval_the_timeout_rules():
    timing = SensorTiming(2.0)
    assert timing.period is None
    assert timing.longest_hold == timing.longest_live == 2.0
    assert timing.is_dropout(2.1)
    assert not timing.is_dropout(1.9)


def test_the_first_interval_is_the_period():
    timing = SensorTiming(2.0)
    timing.note_interval(math.inf)
    assert timing.period is None
    timing.note_interval(0.05)
    assert timing.period == 0.05
    assert timing.is_dropout(0.16)
    assert not timing.is_dropout(0.14)


def test_a_slow_sensor_holds_for_three_periods():
    timing = SensorTiming(2.0)
    timing.note_interval(1.0)
    assert timing.longest_hold == 3.0
    assert timing.longest_live == 2.0


def test_jitter_averages_out():
    timing = SensorTiming(2.0)
    rng = np.random.default_rng(1)
    periods = []
    for gap in 0.05 + rng.uniform(-0.02, 0.02, 2000):
        timing.note_interval(gap)
        periods.append(timing.period)
    assert np.mean(periods[100:]) == pytest.approx(0.05, rel=0.02)
    assert np.std(periods[100:]) < 0.004


@pytest.mark.parametrize(('before', 'after'), [(0.05, 1.0), (10.0, 0.05), (0.01, 0.1)])
def test_a_new_rate_is_learned_within_some_tens_of_samples(before, after):
    timing = SensorTiming(2.0)
    timing.note_interval(before)
    for _ in range(60):
        timing.note_interval(after)
    assert timing.period == pytest.approx(after, rel=0.02)


def test_one_odd_interval_changes_little():
    for odd in (1e-4, 30.0):
        timing = SensorTiming(2.0)
        timing.note_interval(0.05)
        timing.note_interval(odd)
        assert 0.6 * 0.05 <= timing.period <= 1.2 * 0.05 + 1e-15


def test_lateness_goes_up_at_once_and_down_slowly():
    timing = SensorTiming(2.0)
    timing.note_lateness(0.3, math.inf)
    assert timing.lateness == 0.3
    timing.note_lateness(0.0, 0.05)
    assert timing.lateness == pytest.approx(0.294)
    for _ in range(400):
        timing.note_lateness(0.01, 0.05)
    assert timing.lateness == pytest.approx(0.01, rel=0.02)


def test_a_backlog_is_played_out_a_quarter_faster_at_most():
    timing = SensorTiming(2.0)
    timing.note_lateness(8.0, math.inf)
    for i in range(100):
        before = timing.lateness
        timing.note_lateness(8.0 - 0.05 * i, 0.05)
        assert before - timing.lateness <= 0.25 * 0.05 + 1e-15
