# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind between means: straight lines, whatever their spacing, and a sensor's samples untouched."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.simulation.interpolated import interpolated_means


@pytest.mark.parametrize('spacing', [20.0, 60.0, 601.0, 3600.0, 6480.0])
def test_between_means_the_wind_is_on_straight_lines(spacing: float) -> None:
    time = spacing * np.arange(5)
    velocity = np.random.default_rng(0).normal(size=(5, 3))
    fine, wind = interpolated_means(time, velocity)
    assert np.diff(fine).max() <= 10.0 + 1e-9
    assert fine[-1] == pytest.approx(time[-1])
    at = np.searchsorted(fine, time - 1e-6)
    np.testing.assert_allclose(wind[at], velocity, atol=1e-9)
    middle = np.interp(spacing / 2, fine, wind[:, 0])
    assert middle == pytest.approx(velocity[:2, 0].mean())


def test_samples_of_a_sensor_stay_with_their_gaps() -> None:
    time = np.array([0.0, 0.05, 0.1, 30.0, 30.05])
    velocity = np.zeros((5, 3))
    for count in (1, 5):
        given = time[:count], velocity[:count]
        for same, one in zip(interpolated_means(*given), given, strict=True):
            assert same is one


def test_decades_of_means_are_a_bounded_number_of_samples() -> None:
    hours = 3600.0 * np.arange(20 * 365 * 24)
    apart = np.concatenate([20.0 * np.arange(100), 1e9 + 20.0 * np.arange(100)])
    for time in (hours, apart):
        fine, _ = interpolated_means(time, np.zeros((len(time), 3)))
        assert len(fine) <= 1_000_001
