# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind of the last while in a few numbers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.fidelity.climate import ClimateTracker, WindClimate


def test_the_power_of_a_record_is_its_mean_square_about_the_mean():
    wind = np.random.default_rng(3).normal(5.0, 1.0, (600, 3))
    climate = WindClimate.of_samples(wind, 60.0)
    power = climate.power(np.concatenate([[0.0], np.geomspace(0.01, 30.0, 160)]))
    np.testing.assert_allclose(power.sum(axis=0), climate.covariance, rtol=1e-9)


def test_what_an_oscillator_does_from_rest_is_no_more_than_its_answer_to_the_power():
    rate, first, damping = 60.0, 0.8, 0.05
    t = np.arange(0.0, 10.0, 1.0 / rate)
    w = 2.0 * np.pi * first
    frequencies = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 400)])
    gain = 1.0 / np.abs(1.0 - (frequencies / first) ** 2 + 2j * damping * frequencies / first) ** 2
    for speed in (5.0 + np.sin(w * t), np.where(t > 3.0, 6.0, 0.0), 6.0 + np.sin(9.0 * t)):
        wind = np.stack([speed, 0.0 * t, 0.0 * t], axis=1)
        climate = WindClimate.of_samples(wind, rate)
        power = climate.power(frequencies)[:, 0, 0]
        described = gain @ power + climate.mean[0] ** 2
        system = signal.lti([w * w], [1.0, 2.0 * damping * w, w * w])
        x = signal.lsim(system, speed * speed, t)[1]
        assert 0.5 <= np.mean(x * x) / described <= 1.0


def test_the_tracker_forgets():
    tracker = ClimateTracker(memory=10.0)
    for _ in range(600):
        tracker.add(np.array([3.0, 0.0, 0.0]), 0.1)
    for _ in range(1000):
        tracker.add(np.array([0.0, 4.0, 0.0]), 0.1)
    climate = tracker.climate
    np.testing.assert_allclose(climate.mean, [0.0, 16.0, 0.0], atol=0.01)
    assert climate.speed == pytest.approx(4.0, abs=0.01)
    assert abs(climate.covariance).max() < 0.1


def test_the_first_sample_counts_whole():
    tracker = ClimateTracker()
    tracker.add(np.array([2.0, 0.0, 0.0]), 1.0 / 60.0)
    np.testing.assert_allclose(tracker.climate.mean, [4.0, 0.0, 0.0])


def test_a_wind_that_beats_is_described_from_turbulence():
    t = np.arange(0.0, 20.0, 1.0 / 60.0)
    frequencies = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 160)])
    tracker = ClimateTracker()
    for speed in 5.0 + np.sin(2.0 * np.pi * 0.8 * t):
        tracker.add(np.array([speed, 0.0, 0.0]), 1.0 / 60.0)
    power = tracker.climate.power(frequencies)[:, 0, 0]
    near = np.abs(frequencies - 0.8) < 0.1
    assert power[near].sum() > 0.6 * power.sum()
    rng = np.random.default_rng(0)
    turbulent = simulate_turbulence(5.0, rate=20.0, duration=60.0, rng=rng, intensity=0.14)
    smooth = WindClimate.of_samples(turbulent, 20.0).power(frequencies)
    assert smooth[near, 0, 0].sum() < 0.1 * power.sum()


def test_the_tracker_knows_the_largest_load_of_its_memory():
    tracker = ClimateTracker(memory=10.0)
    for speed, seconds in ((7.0, 1), (3.0, 5)):
        for _ in range(60 * seconds):
            tracker.add(np.array([0.0, speed, 0.0]), 1.0 / 60.0)
    assert tracker.largest_load == pytest.approx(49.0)
    tracker.add(np.array([0.0, 3.0, 0.0]), 1e6)
    assert tracker.largest_load == pytest.approx(9.0)
    assert ClimateTracker().climate.speed == 0.0


def test_wind_straight_up_is_a_load():
    tracker = ClimateTracker()
    for _ in range(60):
        tracker.add(np.array([0.0, 0.0, 6.0]), 1.0 / 60.0)
    np.testing.assert_allclose(tracker.climate.mean, [0.0, 0.0, 36.0], rtol=0.01)
    assert tracker.largest_load == pytest.approx(36.0)
