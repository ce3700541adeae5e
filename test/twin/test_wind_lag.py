# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The lag of a motion behind another is found however a sensor is turned, and not by chance."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.twin.late_wind import LateWind, LONGEST_WAY
from tree_sway.twin.wind_lag import find_lag

DT = 1.0 / 60.0
PERIOD = 60
GRAVITY = np.array([0.0, 0.0, 200.0])


def motion(seed: int, count: int = 2400) -> Floats:
    """Make smooth random motion, (n, 3), largest along x."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=(count + PERIOD - 1, 3)) * [1.0, 0.6, 0.1]
    kernel = np.hanning(PERIOD)
    return np.stack([np.convolve(each, kernel, mode='valid') for each in noise.T], axis=1)


@pytest.mark.parametrize('lag', [-200, 0, 37, 260])
def test_the_lag_of_a_turned_sensor_is_found(lag: int) -> None:
    whole = motion(1, 3000)
    model = whole[300:2700]
    turn = Rotation.random(rng=np.random.default_rng(lag + 1000))
    sensed = 3.0 * turn.apply(whole[300 - lag : 2700 - lag] + 0.5 * motion(2)[:2400] + GRAVITY)
    found = find_lag([(sensed, model), (sensed, model)], -300, 600, PERIOD)
    assert abs(found.steps - lag) <= 2
    assert found.is_sure
    assert found.likeness > 0.8


@pytest.mark.parametrize('seed', range(3, 23))
def test_no_lag_of_another_motion_is_believed(seed: int) -> None:
    assert not find_lag([(motion(seed), motion(seed + 100))], 0, 900, PERIOD).is_sure


def test_a_lag_is_not_believed_where_the_present_wind_explains_half_as_much() -> None:
    whole = motion(1, 3000)
    model, later = whole[300:2700], whole[200:2600]
    found = find_lag([(later + 0.65 * model, model)], -300, 600, PERIOD)
    assert found.steps == pytest.approx(100, abs=10)
    assert found.likeness > 1.4 * found.beside
    assert not found.is_sure


def blown(wind: LateWind, speeds: Floats) -> Floats:
    return np.array([wind.push(float(each), 0.0, 0.0, DT)[0] for each in speeds])


def test_wind_of_a_told_distance_comes_after_the_way_at_its_mean_speed() -> None:
    speeds = np.full(1200, 5.0)
    speeds[600:606] = 8.0
    late = blown(LateWind(20.0), speeds)
    peak = 600 + int(np.argmax(late[600:]))
    assert (peak - 603) * DT == pytest.approx(4.0, abs=0.1)
    np.testing.assert_array_equal(blown(LateWind(), speeds), speeds)


def test_a_found_time_stays_while_the_mean_wind_becomes_known() -> None:
    wind = LateWind()
    blown(wind, np.full(600, 8.0))
    wind.delay_more(3.0)
    late = blown(wind, np.full(2400, 4.0))
    assert wind.delay == pytest.approx(3.0)
    assert late[0] == pytest.approx(8.0)
    assert late[-1] == pytest.approx(4.0)
    assert wind.distance == pytest.approx(3.0 * 4.8)
    wind.delay_more(-5.0)
    assert wind.delay == 0.0
    wind.delay_more(99.0)
    assert wind.delay == LONGEST_WAY


def test_a_found_distance_stays_and_its_time_follows_the_mean_wind() -> None:
    wind = LateWind()
    for speed, seconds in ((6.0, 700), (12.0, 3000)):
        for _ in range(seconds * 4):
            wind.push(speed, 0.0, 0.0, 0.25)
        if speed == 6.0:
            wind.delay_more(2.0)
            wind.push(speed, 0.0, 0.0, 0.25)
    assert wind.distance == pytest.approx(12.0)
    assert wind.delay == pytest.approx(1.0, rel=0.02)


def test_a_distance_outlives_a_reset() -> None:
    wind = LateWind(30.0)
    blown(wind, np.full(60, 6.0))
    wind.reset()
    assert wind.delay == 0.0
    blown(wind, np.full(60, 6.0))
    assert wind.delay == pytest.approx(5.0)
