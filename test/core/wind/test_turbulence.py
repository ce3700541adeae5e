# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import csv
from itertools import pairwise
import math
from pathlib import Path

import numpy as np
import pytest
import scipy.integrate
import scipy.signal
import scipy.stats

from tree_sway.core.wind.turbulence import (
    along_bearing,
    simulate_turbulence,
    Turbulence,
    turbulence_scale,
)
from tree_sway.errors import ParameterError

RATE, HOUR = 20.0, 3600.0
GOLDEN = Path(__file__).parents[2] / 'golden' / 'pyconturb' / 'spectra.csv'


def along_the_wind(record):
    """Undo the default bearing, a westerly: u east, v north, w up."""
    return record - np.array([7.0, 0.0, 0.0])


@pytest.fixture(scope='module')
def hour():
    turbulence = Turbulence(7.0)
    record = simulate_turbulence(7.0, rate=RATE, duration=HOUR, rng=np.random.default_rng(1))
    return turbulence, along_the_wind(record)


def third_octaves(frequency, *spectra, low=0.02, high=9.0):
    edges = np.geomspace(low, high, 28)
    bands = [(frequency >= a) & (frequency < b) for a, b in pairwise(edges)]
    return [np.array([s[band].mean(axis=0) for band in bands if band.any()]) for s in spectra]


class TestSimulatedHour:
    """V9: the simulated anemometer against its closed forms, over one hour."""

    def test_variances_and_their_ratios(self, hour):
        turbulence, wind = hour
        np.testing.assert_allclose(wind.mean(axis=0), 0.0, atol=1e-12)
        deviations = wind.std(axis=0)
        np.testing.assert_allclose(deviations**2, turbulence.deviations**2, rtol=0.1)
        np.testing.assert_allclose(deviations / deviations[0], (1.0, 0.8, 0.5), rtol=0.1)

    def test_spectrum_is_within_two_decibels_of_the_closed_form(self, hour):
        turbulence, wind = hour
        frequency, power = scipy.signal.welch(wind, RATE, nperseg=4096, axis=0)
        closed = turbulence.spectrum(frequency)
        measured, expected = third_octaves(frequency, power, closed)
        assert len(measured) > 20
        assert np.abs(10.0 * np.log10(measured / expected)).max() < 2.0

    def test_inertial_subrange_has_a_slope_of_five_thirds(self, hour):
        turbulence, wind = hour
        frequency, power = scipy.signal.welch(wind, RATE, nperseg=4096, axis=0)
        band = (frequency >= 0.5) & (frequency <= 4.0)
        log_f = np.log(frequency[band])
        slopes = [np.polyfit(log_f, np.log(power[band, c]), 1)[0] for c in range(3)]
        closed = np.log(turbulence.spectrum(frequency[band]))
        expected = [np.polyfit(log_f, closed[:, c], 1)[0] for c in range(3)]
        np.testing.assert_allclose(slopes, expected, atol=0.06)
        assert abs(slopes[0] + 5 / 3) < 0.15
        assert abs(slopes[1] + 5 / 3) < 0.15
        # At 10 m and 7 m/s the small eddies of w leave the subrange below 3 Hz by the closed form.

    def test_it_is_close_to_gaussian(self, hour):
        _, wind = hour
        assert np.abs(scipy.stats.skew(wind)).max() < 0.2
        assert np.abs(scipy.stats.kurtosis(wind)).max() < 0.4

    def test_gusts_come_from_above_and_lulls_from_below(self, hour):
        """Stress over level ground: -0.3 to -0.4 of the deviations (Kaimal & Finnigan 1994)."""
        _, wind = hour
        correlation = np.corrcoef(wind.T)
        assert -0.4 < correlation[0, 2] < -0.3
        assert abs(correlation[0, 1]) < 0.1
        assert abs(correlation[1, 2]) < 0.1

    def test_slow_gusts_carry_the_stress(self, hour):
        """Coherency of u and w falls with frequency, and both keep their spectra (V9)."""
        _, wind = hour
        frequency, coherency = scipy.signal.coherence(
            wind[:, 0], wind[:, 2], RATE, nperseg=round(50.0 * RATE)
        )
        slow = coherency[(frequency > 0.02) & (frequency < 0.2)].mean()
        fast = coherency[(frequency > 2.0) & (frequency < 8.0)].mean()
        assert math.sqrt(slow) > 0.4
        assert math.sqrt(fast) < 0.2


def test_vertical_slope_too_where_the_subrange_reaches_the_band():
    """High up in a light wind the eddies of w are large enough for the band of V9."""
    rng = np.random.default_rng(1)
    wind = simulate_turbulence(3.0, height=60.0, rate=RATE, duration=HOUR, rng=rng)
    frequency, power = scipy.signal.welch(wind, RATE, nperseg=4096, axis=0)
    band = (frequency >= 0.5) & (frequency <= 4.0)
    slope = np.polyfit(np.log(frequency[band]), np.log(power[band, 2]), 1)[0]
    assert abs(slope + 5 / 3) < 0.15


class TestAgainstPyConTurb:
    """The case of an independent generator; table and program are in test/golden."""

    @pytest.fixture(scope='class')
    def table(self):
        with GOLDEN.open(encoding='ascii', newline='') as lines:
            rows = np.array([[float(cell) for cell in row] for row in list(csv.reader(lines))[1:]])
        return rows[:, 0], rows[:, 1:4], rows[:, 4:7]

    def test_closed_form(self, table):
        frequency, closed, _ = table
        ours = Turbulence(7.0, 10.0).spectrum(frequency)
        # Theirs is the mean over a band, ours the value at its middle.
        np.testing.assert_allclose(ours, closed, rtol=0.03)

    def test_record(self, table):
        frequency, _, theirs = table
        wind = simulate_turbulence(7.0, rate=RATE, duration=HOUR, rng=np.random.default_rng(4))
        ours_at, power = scipy.signal.welch(along_the_wind(wind), RATE, nperseg=4096, axis=0)
        edges = np.sqrt(frequency[1:] * frequency[:-1])
        band = np.searchsorted(edges, ours_at)
        inside = (ours_at >= 0.02) & (ours_at < 9.5)
        ours = np.array([power[inside & (band == i)].mean(axis=0) for i in range(len(frequency))])
        decibels = 10.0 * np.log10(ours / theirs)
        assert np.abs(decibels).max() < 2.0
        assert np.abs(decibels[8:]).max() < 0.5  # many lines to a band: little scatter is left


class TestClosedForms:
    """Spectra, scales and deviations as the standard has them."""

    def test_a_spectrum_holds_its_variance_and_begins_with_its_integral_scale(self):
        turbulence = Turbulence(7.0)
        for k, deviation in enumerate(turbulence.deviations):
            variance, _ = scipy.integrate.quad(
                lambda n, k=k: turbulence.spectrum(n)[k], 0.0, np.inf, limit=400
            )
            assert variance == pytest.approx(deviation**2, rel=3e-4)
        at_zero = 4.0 * turbulence.scales * turbulence.deviations**2 / 7.0
        np.testing.assert_allclose(turbulence.spectrum(0.0), at_zero)

    def test_the_inertial_subrange_is_locally_isotropic(self):
        kaimal = Turbulence(7.0).spectrum(np.array([1e4, 1e5]))
        np.testing.assert_allclose(kaimal[:, 1:] / kaimal[:, :1], 4 / 3, rtol=0.02)
        np.testing.assert_allclose(kaimal[1] / kaimal[0], 10 ** (-5 / 3), rtol=1e-3)

    def test_the_scale_stops_growing_at_sixty_metres(self):
        assert turbulence_scale(10.0) == pytest.approx(7.0)
        assert turbulence_scale(60.0) == turbulence_scale(200.0) == pytest.approx(42.0)

    def test_deviations(self):
        np.testing.assert_allclose(
            Turbulence(10.0).deviations,
            0.14 * 13.1 * np.array([1, 0.8, 0.5]),
        )
        np.testing.assert_allclose(Turbulence(10.0, intensity=0.2).deviations, (2.0, 1.6, 1.0))


class TestRecords:
    """Records of any rate, length and seed."""

    @pytest.mark.parametrize('rate', [1.0, 4.0, 100.0])
    def test_the_variance_is_kept_at_every_rate(self, rate):
        turbulence = Turbulence(5.0)
        record = turbulence.record(round(600 * rate), rate, np.random.default_rng(1))
        np.testing.assert_allclose(record.std(axis=0), turbulence.deviations, rtol=1e-12)

    @pytest.mark.parametrize('n_samples', [4, 5, 997, 1000])
    def test_any_length(self, n_samples):
        turbulence = Turbulence(5.0)
        record = turbulence.record(n_samples, 10.0, np.random.default_rng(1))
        assert record.shape == (n_samples, 3)
        np.testing.assert_allclose(record.mean(axis=0), 0.0, atol=1e-13)
        np.testing.assert_allclose(record.std(axis=0), turbulence.deviations, rtol=1e-12)

    def test_end_joins_start(self):
        record = Turbulence(5.0).record(12000, 20.0, np.random.default_rng(1))
        steps = np.abs(np.diff(record, axis=0)).max(axis=0)
        assert (np.abs(record[0] - record[-1]) <= steps).all()

    def test_no_intensity_is_no_turbulence(self):
        record = Turbulence(5.0, intensity=0.0).record(100, 10.0, np.random.default_rng(1))
        assert not record.any()

    def test_a_short_record_is_a_piece_of_a_long_one(self):
        """A minute holds less than the full variance about its mean, and not always the same."""
        minutes = [
            simulate_turbulence(5.0, rate=10.0, duration=60.0, rng=np.random.default_rng(seed))
            for seed in range(30)
        ]
        assert minutes[0].shape == (600, 3)
        deviation = np.array([m[:, 0].std() for m in minutes])
        full = Turbulence(5.0).deviations[0]
        assert 0.6 * full < deviation.mean() < 0.98 * full
        assert np.std([m[:, 0].mean() for m in minutes]) > 0.1 * full

    def test_the_same_generator_gives_the_same_wind(self):
        a, b, c = (
            simulate_turbulence(5.0, rate=5.0, duration=50.0, rng=np.random.default_rng(s))
            for s in (1, 1, 2)
        )
        np.testing.assert_array_equal(a, b)
        assert np.abs(a - c).max() > 0.1


class TestBearing:
    @pytest.mark.parametrize(
        ('degrees_to', 'east', 'north'), [(0, 0, 1), (90, 1, 0), (180, 0, -1), (270, -1, 0)]
    )
    def test_mean_blows_to_the_bearing(self, degrees_to, east, north):
        wind = simulate_turbulence(
            8.0,
            rate=5.0,
            duration=600.0,
            rng=np.random.default_rng(1),
            bearing_to=math.radians(degrees_to),
        )
        np.testing.assert_allclose(wind.mean(axis=0), (8.0 * east, 8.0 * north, 0.0), atol=1e-12)

    def test_axes_are_along_left_and_up(self):
        to_the_east = along_bearing(np.eye(3), 0.5 * np.pi)
        np.testing.assert_allclose(to_the_east, np.eye(3), atol=1e-15)
        to_the_north = along_bearing(np.eye(3), 0.0)
        np.testing.assert_allclose(to_the_north, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-15)


@pytest.mark.parametrize(
    ('options', 'match'),
    [
        ({'mean_speed': 0.0}, 'mean_speed: 0.0 is out of range'),
        ({'mean_speed': math.nan}, 'mean_speed'),
        ({'height': 0.0}, 'height'),
        ({'intensity': -0.1}, 'intensity'),
        ({'rate': 0.0}, 'rate'),
        ({'duration': -1.0}, 'duration'),
        ({'bearing_to': math.inf}, 'bearing_to'),
    ],
)
def test_parameters_out_of_range_are_refused(options, match):
    values = {'mean_speed': 5.0, 'rate': 10.0, 'duration': 10.0, **options}
    with pytest.raises(ParameterError, match=match):
        simulate_turbulence(rng=np.random.default_rng(0), **values)
