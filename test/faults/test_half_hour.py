# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Half an hour of a real sonic at 20 Hz: spikes put into it are refused, its own gusts are not."""

from pathlib import Path

import numpy as np
import pytest

from tree_sway.core.wind.convention import WindConvention
from tree_sway.core.wind.gate import WindGate
from tree_sway.core.wind.intake import WindIntake
from tree_sway.files.wind.wind_file import read_wind

SONIC = Path(__file__).parents[2] / '..' / 'shared' / 'data' / 'wind' / 'sonic_20hz_1245.toa5.dat'
N_SPIKES, N_GUSTS = 180, 40
PERIOD = 50_000_000


@pytest.fixture(scope='module')
def half_hour():
    """Play the record of a quarter of an hour to its end and back again, with gusts of 6 m/s."""
    if not SONIC.is_file():
        pytest.skip(f'no recorded wind at {SONIC}')
    wind = read_wind(SONIC).velocity
    wind = np.concatenate([wind, wind[::-1]])
    time = np.arange(len(wind)) / 20.0
    for start in np.linspace(20.0, time[-1] - 20.0, N_GUSTS):  # up within half a second, for 3 s
        inside = np.clip(np.minimum(time - start, start + 3.0 - time) / 0.5, 0.0, 1.0)
        wind = wind + np.outer(inside, [6.0, 0.0, 0.0])
    assert time[-1] > 1790.0
    return wind


def refused(wind):
    """Rows that the wind node's gate refuses."""
    intake = WindIntake(WindConvention(), WindGate())
    return {
        row
        for row, components in enumerate(wind.tolist())
        if intake.offer(10**18 + row * PERIOD, tuple(components), 10**18 + row * PERIOD) is None
    }


def test_its_own_gusts_are_never_refused(half_hour):
    assert len(refused(half_hour)) <= 1e-3 * len(half_hour)
    fast = np.linalg.norm(half_hour, axis=1) > 6.0
    assert not refused(half_hour) & set(np.flatnonzero(fast).tolist())


def test_every_spike_is_refused_and_hardly_a_true_sample(half_hour):
    rng = np.random.default_rng(7)
    rows = rng.choice(np.arange(100, len(half_hour), 5), N_SPIKES, replace=False)
    angle = rng.uniform(-np.pi, np.pi, N_SPIKES)
    size = rng.uniform(10.0, 60.0, N_SPIKES)
    spiked = half_hour.copy()
    spiked[rows] += size[:, None] * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    found = refused(spiked)
    assert set(rows.tolist()) <= found
    true = len(half_hour) - N_SPIKES
    assert len(found) - N_SPIKES <= 1e-3 * true, f'{len(found) - N_SPIKES} of {true} refused'
