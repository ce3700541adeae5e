# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
import scipy.signal

from tree_sway.core.wind.simulated.turbulence import Turbulence
from tree_sway.core.wind.simulated.turbulence_stream import TurbulenceStream
from tree_sway.errors import ParameterError

TURBULENCE = Turbulence(7.0)
RATE = 4.0
N_HOP = 2048  # half of the power of two above 600 s at 4 Hz


def wind_of(stream, ticks):
    return np.array([stream.at(int(tick)) for tick in ticks])


def test_a_tick_has_one_value_whatever_was_asked_before():
    forward = TurbulenceStream(TURBULENCE, RATE, 7)
    ticks = [0, 1, N_HOP - 1, N_HOP, N_HOP + 1, 3 * N_HOP, 3 * N_HOP + 5, 10**9]
    expected = wind_of(forward, ticks)
    backward = TurbulenceStream(TURBULENCE, RATE, 7)
    np.testing.assert_array_equal(wind_of(backward, ticks[::-1])[::-1], expected)
    for tick, wind in zip(ticks, expected, strict=True):
        np.testing.assert_array_equal(TurbulenceStream(TURBULENCE, RATE, 7).at(tick), wind)


def test_seeds_differ_and_so_do_periods():
    a, b = TurbulenceStream(TURBULENCE, RATE, 1), TurbulenceStream(TURBULENCE, RATE, 2)
    ticks = np.arange(N_HOP)
    first, other = wind_of(a, ticks), wind_of(b, ticks)
    later = wind_of(a, ticks + 2 * N_HOP)
    for wind in (other, later):
        correlation = [np.corrcoef(first[:, c], wind[:, c])[0, 1] for c in range(3)]
        assert np.abs(correlation).max() < 0.35


def test_no_seam_shows_where_blocks_meet():
    stream = TurbulenceStream(TURBULENCE, RATE, 3)
    wind = wind_of(stream, np.arange(12 * N_HOP))
    steps = np.abs(np.diff(wind, axis=0))
    seams = np.arange(1, 12) * N_HOP - 1
    assert (steps[seams].max(axis=0) < np.quantile(steps, 0.9995, axis=0)).all()
    assert (steps[seams].mean(axis=0) < 2.0 * steps.mean(axis=0)).all()


def test_the_variance_is_the_same_at_every_place_between_seams():
    squares = np.zeros((8, 3))
    for seed in range(60):
        wind = wind_of(TurbulenceStream(TURBULENCE, 1.0, seed), np.arange(512))
        squares += (wind**2).reshape(8, 64, 3).mean(axis=1)
    ratio = np.sqrt(squares / 60) / TURBULENCE.deviations
    np.testing.assert_allclose(ratio, 1.0, atol=0.25)
    np.testing.assert_allclose(ratio.mean(axis=0), 1.0, atol=0.04)


def test_hours_of_it_keep_variance_and_spectrum():
    wind = wind_of(TurbulenceStream(TURBULENCE, 10.0, 5), np.arange(72000))
    np.testing.assert_allclose(wind.std(axis=0), TURBULENCE.deviations, rtol=0.05)
    frequency, power = scipy.signal.welch(wind, 10.0, nperseg=2048, axis=0)
    edges = np.geomspace(0.02, 4.5, 20)
    band = np.digitize(frequency, edges)
    closed = TURBULENCE.spectrum(frequency)
    for index in range(1, len(edges)):
        ratio = power[band == index].mean(axis=0) / closed[band == index].mean(axis=0)
        assert np.abs(10.0 * np.log10(ratio)).max() < 2.0


def test_a_change_of_intensity_keeps_the_pattern():
    calm = TurbulenceStream(Turbulence(7.0, intensity=0.1), RATE, 1)
    wild = TurbulenceStream(Turbulence(7.0, intensity=0.3), RATE, 1)
    ticks = np.arange(100)
    np.testing.assert_allclose(wind_of(wild, ticks), 3.0 * wind_of(calm, ticks), rtol=1e-9)


def test_what_it_returns_is_the_callers_own():
    stream = TurbulenceStream(TURBULENCE, RATE, 1)
    wind = stream.at(5)
    wind[:] = 1e9
    assert np.abs(stream.at(5)).max() < 40.0


@pytest.mark.parametrize(('rate', 'seed'), [(0.0, 1), (-1.0, 1), (2e3, 1), (4.0, -1)])
def test_out_of_range(rate, seed):
    with pytest.raises(ParameterError, match='out of range'):
        TurbulenceStream(TURBULENCE, rate, seed)


def test_a_negative_tick_is_refused():
    with pytest.raises(ParameterError, match='tick: -1 is out of range'):
        TurbulenceStream(TURBULENCE, RATE, 1).at(-1)
