# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from tree_sway.core.wind.limits import FASTEST_WIND
from tree_sway.live.gusts_about_mean import GustsAboutMean, PASSING, RATE

WESTERLY = np.array([8.0, 0.0, 0.0])
LATE = 1000.0


def blown(gusts, seconds, since=LATE):
    times = since + np.arange(round(seconds * RATE)) / RATE
    return np.array([gusts.sample(time) for time in times])


def gusts_of(mean, interval=600.0, gust=None, seed=0):
    made = GustsAboutMean(seed)
    made.set(0.0, np.array(mean), interval, gust)
    return made


@pytest.mark.parametrize('speed', [0.5, 25.0])
def test_the_mean_over_hours_is_that_of_the_station(speed):
    wind = blown(gusts_of([speed, 0.0, 0.0]), 3000.0)
    assert wind.mean(axis=0) == pytest.approx([speed, 0.0, 0.0], abs=0.05 * speed)


def test_the_deviation_without_a_gust_is_that_of_iec():
    """IEC 61400-1, class B: 0.14 (0.75 U + 5.6 m/s); means over ten minutes lack a part."""
    wind = blown(gusts_of(WESTERLY), 3000.0)
    iec = 0.14 * (0.75 * 8.0 + 5.6)
    assert wind.std(axis=0)[0] == pytest.approx(iec, rel=0.15)


@pytest.mark.parametrize('gust', [10.0, 20.0])
def test_the_largest_three_seconds_are_those_of_the_gust_on_average(gust):
    wind = blown(gusts_of(WESTERLY, 600.0, gust), 3000.0)[:, 0]
    smooth = np.convolve(wind, np.full(30, 1.0 / 30.0), 'same')
    largest = smooth[: 5 * 6000].reshape(5, 6000).max(axis=1)
    assert largest.mean() == pytest.approx(gust, rel=0.1)


def test_a_gust_no_faster_than_the_mean_is_an_even_wind():
    assert np.ptp(blown(gusts_of(WESTERLY, 600.0, 8.0), 60.0), axis=0) == pytest.approx(0.0)


def test_calm_air_stays_calm():
    assert np.abs(blown(gusts_of([0.0, 0.0, 0.0]), 60.0)).max() == 0.0


def test_a_new_mean_is_reached_without_a_jump():
    gusts = gusts_of(WESTERLY, 600.0, 8.0)
    gusts.set(LATE, np.array([0.0, 12.0, 0.0]), 600.0, 12.0)
    wind = blown(gusts, 2.0 * PASSING)
    assert wind[0] == pytest.approx(WESTERLY)
    assert wind[-1] == pytest.approx([0.0, 12.0, 0.0])
    assert np.abs(np.diff(wind, axis=0)).max() < 0.1


def test_gusts_turn_with_the_wind_and_follow_the_seed():
    west, south = gusts_of(WESTERLY), gusts_of([0.0, 8.0, 0.0])
    one, turned = blown(west, 60.0), blown(south, 60.0)
    assert turned[:, 1] == pytest.approx(one[:, 0])
    assert turned[:, 0] == pytest.approx(-one[:, 1])
    assert not np.allclose(one, blown(gusts_of(WESTERLY, seed=1), 60.0))


def test_no_gust_is_faster_than_any_wind():
    wind = blown(gusts_of([120.0, 0.0, 0.0], 60.0, 200.0), 600.0)
    assert np.linalg.norm(wind, axis=1).max() <= FASTEST_WIND * (1.0 + 1e-12)
