# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from tree_sway.core.wind.gate import SECOND, WindGate
from tree_sway.core.wind.turbulence import Turbulence
from tree_sway.errors import ParameterError
from tree_sway.simulation.wind.anemometer import AnemometerModel


def read(model, n, first=0):
    return np.array([model.sample(tick) for tick in range(first, first + n)])


def test_an_hour_of_it_has_the_statistics_it_was_asked_for():
    """V9 as a subscriber would measure it."""
    wind = read(AnemometerModel(7.0, rate=20.0, seed=2), 72000)
    expected = Turbulence(7.0).deviations
    np.testing.assert_allclose(wind.var(axis=0), expected**2, rtol=0.1)
    np.testing.assert_allclose(wind.std(axis=0) / wind[:, 0].std(), (1.0, 0.8, 0.5), rtol=0.1)
    np.testing.assert_allclose(wind.mean(axis=0), (7.0, 0.0, 0.0), atol=0.1)


def test_deterministic_from_the_seed():
    a, b, c = (AnemometerModel(seed=s) for s in (3, 3, 4))
    np.testing.assert_array_equal(read(a, 50), read(b, 50))
    assert np.abs(read(a, 50) - read(c, 50)).max() > 0.1
    np.testing.assert_array_equal(a.sample(10**8), b.sample(10**8))


def test_no_seam_shows_where_the_turbulence_begins_again():
    model, n = AnemometerModel(seed=3, rate=1.0), 2**15
    np.testing.assert_array_equal(model.sample(5), model.sample(n + 5))
    steps = np.abs(np.diff(read(model, 400, first=n - 200), axis=0))
    assert (steps[199] <= np.quantile(steps, 0.999, axis=0)).all()


def test_steady_wind_without_turbulence():
    wind = read(AnemometerModel(6.0, intensity=0.0, bearing_to=0.0), 5)
    np.testing.assert_allclose(wind, np.tile([0.0, 6.0, 0.0], (5, 1)), atol=1e-15)


def test_no_mean_is_calm():
    assert not read(AnemometerModel(0.0), 5).any()


def test_a_small_live_change_makes_a_small_change():
    before, after = AnemometerModel(5.0, seed=1), AnemometerModel(5.1, seed=1)
    assert np.abs(before.sample(777) - after.sample(777)).max() < 0.3


def test_the_gate_takes_all_of_it():
    gate = WindGate()
    wind = read(AnemometerModel(10.0, rate=50.0), 2000)
    assert all(gate.offer(i * SECOND // 50, w).accepted for i, w in enumerate(wind))


@pytest.mark.parametrize(
    ('options', 'match'),
    [
        ({'mean_speed': -1.0}, 'mean_speed'),
        ({'mean_speed': 41.0}, 'mean_speed'),
        ({'rate': 0.5}, 'rate: 0.5 is out of range; use 1 to 100 Hz'),
        ({'rate': 101.0}, 'rate'),
        ({'bearing_to': math.nan}, 'bearing_to'),
        ({'height': -1.0}, 'height'),
        ({'intensity': math.inf}, 'intensity'),
        ({'seed': -1}, 'seed'),
    ],
)
def test_parameters_out_of_range_are_refused(options, match):
    with pytest.raises(ParameterError, match=match):
        AnemometerModel(**options)


def test_a_negative_tick_is_refused():
    for model in (AnemometerModel(), AnemometerModel(intensity=0.0)):
        with pytest.raises(ParameterError, match='tick'):
            model.sample(-1)
