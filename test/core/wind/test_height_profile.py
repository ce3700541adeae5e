# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind over height: the two laws by their own definitions."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.errors import ParameterError

HEIGHTS = np.array([0.5, 1.0, 5.0, 10.0, 30.0])


@pytest.mark.parametrize('kind', ['none', 'power', 'log'])
def test_at_the_anemometer_it_is_the_wind_measured(kind):
    profile = WindProfile(kind, anemometer_height=4.0, ground=-1.0)
    assert profile.over_anemometer(np.array([3.0])) == pytest.approx(1.0)


def test_no_profile_is_the_same_everywhere():
    assert WindProfile().over_anemometer(np.array([-5.0, 0.0, 50.0])).tolist() == [1.0, 1.0, 1.0]


def test_doubling_the_height_multiplies_the_power_law():
    profile = WindProfile('power', exponent=0.25)
    one, twice = profile.over_anemometer(HEIGHTS), profile.over_anemometer(2 * HEIGHTS)
    assert twice / one == pytest.approx(2.0**0.25)


def test_doubling_the_height_adds_to_the_log_law():
    profile = WindProfile('log', roughness=0.1)
    one, twice = profile.over_anemometer(HEIGHTS), profile.over_anemometer(2 * HEIGHTS)
    assert twice - one == pytest.approx(np.log(2.0) / np.log(100.0))
    assert profile.over_anemometer(np.array([0.1, 0.01])) == pytest.approx(0.0)


@pytest.mark.parametrize('kind', ['power', 'log'])
def test_below_ground_there_is_no_wind(kind):
    profile = WindProfile(kind, ground=2.0)
    assert profile.over_anemometer(np.array([-1.0, 1.9, 2.0])).tolist() == [0.0, 0.0, 0.0]
    assert (np.diff(profile.over_anemometer(HEIGHTS + 2.0)) > 0).all()


@pytest.mark.parametrize(
    ('given', 'message'),
    [
        ({'kind': 'cubic'}, "unknown wind profile 'cubic'; use one of: none, power, log"),
        ({'anemometer_height': 0.0}, 'anemometer_height: 0.0 is out of range'),
        ({'anemometer_height': float('nan')}, 'anemometer_height: nan'),
        ({'kind': 'log', 'roughness': 0.0}, 'roughness: 0.0'),
        ({'kind': 'log', 'roughness': 12.0}, 'roughness: 12.0 is out of range; .* up to 9.99 m'),
    ],
)
def test_what_has_no_wind_is_refused(given, message):
    with pytest.raises(ParameterError, match=message):
        WindProfile(**given)
