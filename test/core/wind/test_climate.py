# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The wind of the last while in a few numbers."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.wind.climate import ClimateTracker, WindClimate
from tree_sway_ros.study.record_climate import climate_of_samples


def test_a_described_wind_has_the_moments_of_its_samples():
    rng = np.random.default_rng(1)
    n, mean, sigma = 400_000, 8.0, 0.8
    wind = np.zeros((n, 3))
    wind[:, 0] = mean + sigma * rng.standard_normal(n)
    wind[:, 1] = 0.8 * sigma * rng.standard_normal(n)
    taken = climate_of_samples(wind, 10.0)
    told = WindClimate.steady(mean, sigma / mean)
    assert taken.mean[0] == pytest.approx(told.mean[0], rel=0.01)
    assert taken.covariance[0, 0] == pytest.approx(told.covariance[0, 0], rel=0.03)
    assert taken.covariance[1, 1] == pytest.approx(told.covariance[1, 1], rel=0.03)


def test_the_spectrum_holds_the_whole_variance():
    climate = WindClimate.steady(5.0, 0.2, integral_time=3.0)
    f = np.geomspace(1e-6, 1e4, 20_000)
    density = climate.spectrum(f)
    assert np.sum(0.5 * (density[1:] + density[:-1]) * np.diff(f)) == pytest.approx(1.0, abs=0.01)


def test_the_integral_time_of_a_filtered_noise_is_its_time_constant():
    rng = np.random.default_rng(2)
    rate, tau, n = 20.0, 2.0, 200_000
    keep = np.exp(-1.0 / (rate * tau))
    noise = rng.standard_normal(n) * np.sqrt(1.0 - keep**2)
    speed = np.empty(n)
    speed[0] = 0.0
    for i in range(1, n):
        speed[i] = keep * speed[i - 1] + noise[i]
    wind = np.stack([10.0 + 0.1 * speed, np.zeros(n), np.zeros(n)], axis=1)
    assert climate_of_samples(wind, rate).integral_time == pytest.approx(tau, rel=0.2)


def test_a_turned_wind_turns_its_covariance():
    east, north = WindClimate.steady(5.0, 0.3), WindClimate.steady(5.0, 0.3, bearing=np.pi / 2)
    np.testing.assert_allclose(north.mean, east.mean[::-1], atol=1e-12)
    np.testing.assert_allclose(north.covariance, east.covariance[::-1, ::-1], atol=1e-12)


def test_the_tracker_forgets():
    tracker = ClimateTracker(memory=10.0)
    for _ in range(600):
        tracker.add(np.array([3.0, 0.0, 0.0]), 0.1)
    for _ in range(1000):
        tracker.add(np.array([0.0, 4.0, 0.0]), 0.1)
    climate = tracker.climate
    np.testing.assert_allclose(climate.mean, [0.0, 16.0], atol=0.01)
    assert climate.speed == pytest.approx(4.0, abs=0.01)
    assert abs(climate.covariance).max() < 0.1


def test_the_first_sample_counts_whole():
    tracker = ClimateTracker()
    tracker.add(np.array([2.0, 0.0, 0.0]), 1.0 / 60.0)
    np.testing.assert_allclose(tracker.climate.mean, [4.0, 0.0])


def test_a_wind_that_beats_is_told_from_turbulence():
    t = np.arange(0.0, 20.0, 1.0 / 60.0)
    still = np.zeros_like(t)
    wind = np.stack([5.0 + np.sin(2.0 * np.pi * 0.8 * t), still, still], axis=1)
    climate = climate_of_samples(wind, 60.0)
    assert climate.beat == pytest.approx(0.8, abs=0.03)
    assert climate.beat_share > 0.8
    f = np.geomspace(0.01, 30.0, 4000)
    assert f[np.argmax(climate.spectrum(f))] == pytest.approx(0.8, abs=0.03)
    gust = np.stack([5.0 + np.exp(-((t - 10.0) ** 2)), still, still], axis=1)
    assert climate_of_samples(gust, 60.0).beat_share == 0.0
