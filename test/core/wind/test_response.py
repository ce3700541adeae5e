# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sensor that passes slow changes alone is found out, and none that follows the wind is."""

from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.wind.gate import SECOND, WindGate
from tree_sway.core.wind.response import ResponseWatch
from tree_sway.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway.files.wind.wind_file import read_wind

RECORDS = Path(__file__).parents[3] / '..' / 'shared' / 'data' / 'wind'
SEIZED = 5.0
"""Time constant of a bearing that hardly turns [s]."""


def behind(time, wind, constant):
    """Return what a sensor shows that follows the wind with a time constant [s]."""
    shown = np.array(wind, dtype=float)
    for i, weight in enumerate(np.exp(-np.diff(time) / constant), start=1):
        shown[i] = weight * shown[i - 1] + (1.0 - weight) * wind[i]
    return shown


def found(time, wind):
    """How often a gate calls the sensor sluggish, and whether it does at the end."""
    gate = WindGate()
    for at, sample in zip(time, wind, strict=True):
        gate.offer(round(at * SECOND) + SECOND, sample)
    return gate.counts.sluggish, gate.is_sluggish


@pytest.mark.parametrize('name', ['sonic_20hz_1245.toa5.dat', 'sailing_mwv.nmea.log'])
def test_a_record_raises_no_alarm_and_its_copy_behind_a_filter_does(name):
    if not (RECORDS / name).is_file():
        pytest.skip(f'no recorded wind at {RECORDS}')
    record = read_wind(str(RECORDS / name))
    time, wind = record.time, record.velocity
    assert found(time, wind) == (0, False)
    times, is_sluggish = found(time, behind(time, wind, SEIZED))
    assert times >= 1
    assert is_sluggish


@pytest.mark.parametrize('rate', [20.0, 4.0, 1.0])
@pytest.mark.parametrize('speed', [3.0, 8.0, 15.0])
def test_simulated_wind_raises_none_at_any_rate(speed, rate):
    rng = np.random.default_rng(5)
    wind = simulate_turbulence(speed, rate=rate, duration=600.0, rng=rng)
    time = np.arange(len(wind)) / rate
    assert found(time, wind) == (0, False)
    assert found(time, behind(time, wind, 0.5)) == (0, False)  # a cup in a light wind
    assert found(time, behind(time, wind, SEIZED))[0] >= 1


def test_noise_a_calm_and_dropouts_raise_none():
    rng = np.random.default_rng(2)
    time = np.arange(12000) / 20.0
    assert found(time, rng.normal(3.0, 0.5, (12000, 3))) == (0, False)
    assert found(time, np.full((12000, 3), 0.01)) == (0, False)
    wind = simulate_turbulence(6.0, rate=20.0, duration=600.0, rng=rng)
    is_there = (time % 7.0) > 2.5
    assert found(time[is_there], wind[is_there]) == (0, False)


def test_the_ratio_is_that_of_the_power_and_a_free_bearing_ends_the_alarm():
    watch = ResponseWatch()
    for k in range(400):  # in a straight line: four times as much in twice the time
        watch.add(k * SECOND, (0.1 * k, 0.0, 0.0))
    assert watch.ratio == pytest.approx(4.0)
    assert watch.is_sluggish
    for k in range(400, 800):  # to and fro: nothing in twice the time
        watch.add(k * SECOND, (float(k % 2), 0.0, 0.0))
    assert watch.ratio == pytest.approx(0.0)
    assert not watch.is_sluggish
