# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records in closed form, and the frequency and damping found in them."""

from __future__ import annotations

import re

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.identification.measured_sway import estimate_sway

RATE = 20.0


def release(
    frequency=0.7, damping=0.05, *, duration=40.0, pulled=5.0, noise=0.002, seed=0, second=0.15
):
    """Return time and motion after a pull: the sway and a quicker mode about a rest."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 1.0 / RATE)
    since = np.clip(time - pulled, 0.0, None)
    motion = np.full_like(time, 0.3)
    for share, w in ((1.0, 2 * np.pi * frequency), (second, 2 * np.pi * 3.1 * frequency)):
        wd = w * np.sqrt(1.0 - damping**2)
        swing = np.cos(wd * since) + damping * w / wd * np.sin(wd * since)
        motion += share * np.exp(-damping * w * since) * swing
    return time, motion + noise * rng.normal(size=len(time))


def in_wind(frequency=0.7, damping=0.05, *, duration=900.0, seed=0, second=0.05):
    """Driven by turbulence of slope -5/3, exact in the frequency domain, cut from a longer run."""
    rng = np.random.default_rng(seed)
    n = int(2 * duration * RATE)
    f = np.fft.rfftfreq(n, 1.0 / RATE)
    load = (rng.normal(size=len(f)) + 1j * rng.normal(size=len(f))) * (1.0 + f / 0.05) ** (-5 / 6)
    answer = sum(
        share / (1.0 - (f / f0) ** 2 + 2j * damping * f / f0)
        for share, f0 in ((1.0, frequency), (second, 2.7 * frequency))
    )
    motion = np.fft.irfft(load * answer, n)[n // 4 : 3 * n // 4]
    time = np.arange(len(motion)) / RATE
    return time, motion / motion.std() + 0.01 * rng.normal(size=len(time))


@pytest.mark.parametrize('damping', [0.02, 0.05, 0.1])
@pytest.mark.parametrize('frequency', [0.25, 0.7, 3.0])
def test_a_release(frequency, damping):
    found = estimate_sway(*release(frequency, damping, duration=5.0 + 25.0 / frequency))
    assert found.frequency == pytest.approx(frequency, rel=5e-3)
    assert found.damping_ratio == pytest.approx(damping, rel=0.05)
    assert abs(found.damping_ratio - damping) < 5.0 * found.damping_error


def test_the_acceleration_of_a_release():
    time, motion = release(noise=0.0, second=0.02)
    force = np.gradient(np.gradient(motion, time), time)
    found = estimate_sway(time, force / np.abs(force).max())
    assert found.frequency == pytest.approx(0.7, rel=5e-3)
    assert found.damping_ratio == pytest.approx(0.05, rel=0.05)


@given(
    angle=st.floats(0.0, 6.28),
    scale=st.floats(1e-4, 1e4),
    start=st.floats(-1e3, 1e6),
)
@settings(max_examples=10, deadline=None)
def test_axes_units_and_the_hour_do_not_matter(angle, scale, start):
    time, motion = release()
    plain = estimate_sway(time, motion)
    turned = scale * np.stack([np.cos(angle) * motion, np.sin(angle) * motion], axis=1)
    found = estimate_sway(time + start, turned)
    assert found.frequency == pytest.approx(plain.frequency, rel=1e-4)
    assert found.damping_ratio == pytest.approx(plain.damping_ratio, rel=1e-2)


def test_the_other_axis_does_not_bend_the_answer():
    """Two sways 4 % apart beat on any one axis; the slower and stronger is found."""
    time, along = release(0.70, 0.03)
    _, across = release(0.73, 0.03, seed=1)
    found = estimate_sway(
        time, np.stack([along + 0.3 * across, 0.2 * along - 0.5 * across], axis=1)
    )
    assert found.frequency == pytest.approx(0.70, rel=5e-3)
    assert found.damping_ratio == pytest.approx(0.03, rel=0.1)


def test_uneven_times_are_taken_as_they_are():
    rng = np.random.default_rng(3)
    time = np.sort(rng.uniform(0.0, 30.0, 3000))
    w, damping = 2 * np.pi * 0.7, 0.04
    motion = np.exp(-damping * w * time) * np.cos(w * np.sqrt(1 - damping**2) * time)
    found = estimate_sway(time, motion)
    assert found.frequency == pytest.approx(0.7, rel=5e-3)
    assert found.damping_ratio == pytest.approx(damping, rel=0.05)


def test_a_band_names_the_sway_that_is_meant():
    time, motion = release(second=1.0)
    quick = estimate_sway(time, motion, band=(1.5, 3.0))
    assert quick.frequency == pytest.approx(3.1 * 0.7, rel=5e-3)
    assert estimate_sway(time, motion, band=(0.4, 1.2)).frequency == pytest.approx(0.7, rel=5e-3)


def changed(index, value, column):
    time, motion = (array.copy() for array in release())
    (time, motion)[column][index] = value
    return time, motion


@pytest.mark.parametrize(
    ('record', 'message'),
    [
        (changed(7, np.nan, 1), 'sample 7: not a finite number'),
        (changed(7, np.inf, 0), 'sample 7: not a finite number'),
        (changed(7, 0.1, 0), r'sample 7: time 0.1 s after 0.3 s'),
        ((np.arange(50.0), np.full(50, 2.0)), 'nothing moves'),
        ((np.arange(9.0), np.arange(9.0)), '9 samples'),
        ((np.arange(50.0), np.zeros((2, 50))), r'shape \(50,\), motion of shape \(2, 50\)'),
    ],
)
def test_what_cannot_be_read(record, message):
    with pytest.raises(FormatError, match=message):
        estimate_sway(*record)


def test_too_short_a_release():
    time, motion = release(damping=0.02, pulled=0.0, duration=2.4 / 0.7, second=0.0)
    with pytest.raises(FormatError, match='cycles'):
        estimate_sway(time, motion)


def test_noise_has_no_sway():
    rng = np.random.default_rng(5)
    for colour in (lambda x: x, np.cumsum):
        with pytest.raises(FormatError, match=r'not decay|motion that decays|peak|cycles'):
            estimate_sway(np.arange(6000) / RATE, colour(rng.normal(size=6000)))


@pytest.mark.parametrize('seed', range(4))
def test_a_sway_in_wind_alone_is_no_release(seed):
    with pytest.raises(FormatError, match=r'release|calmer day|cycles of'):
        estimate_sway(*in_wind(seed=seed))


@pytest.mark.parametrize('frequency', [0.25, 0.7, 2.0])
def test_the_frequency_of_a_tree_in_wind_is_given_with_the_refusal(frequency):
    with pytest.raises(FormatError) as refusal:
        estimate_sway(*in_wind(frequency))
    found = float(refusal.value.what.partition('clearest at ')[2].split()[0])
    assert found == pytest.approx(frequency, rel=0.05)


@pytest.mark.parametrize('seed', range(3))
def test_the_noise_of_an_accelerometer_is_no_sway(seed):
    """It is white: times the square of frequency it is largest at the end of the spectrum."""
    time, motion = in_wind(0.4, seed=seed)
    acceleration = np.gradient(np.gradient(motion, time, axis=0), time, axis=0)
    noise = np.random.default_rng(seed).normal(size=acceleration.shape)
    noisy = acceleration + 0.2 * acceleration.std() * noise
    with pytest.raises(FormatError) as refusal:
        estimate_sway(time, noisy, (0.2, 1.0))
    found = float(re.findall(r'(?:clearest at|near) ([\d.]+) Hz', refusal.value.what)[0])
    assert found == pytest.approx(0.4, rel=0.1)


def test_the_frequency_of_a_record_of_minutes_is_given_too():
    found = []
    for seed in range(8):
        with pytest.raises(FormatError) as refusal:
            estimate_sway(*in_wind(0.4, duration=300.0, seed=seed))
        found += map(float, re.findall(r'(?:clearest at|near) ([\d.]+) Hz', refusal.value.what))
    assert len(found) >= 6  # others are refused for the swing that they look like
    assert np.median(np.abs(np.array(found) - 0.4)) < 0.04


def test_a_gap_and_a_slow_sensor_are_named():
    time, motion = release()
    kept = (time < 6.0) | (time > 7.0)
    with pytest.raises(FormatError, match=r'1.1 s between samples, for a sway of 0.685 Hz'):
        estimate_sway(time[kept], motion[kept])
    with pytest.raises(FormatError, match='between samples'):
        estimate_sway(time[::9], motion[::9])
    with pytest.raises(FormatError, match='without the gaps'):
        estimate_sway(np.where(time > 9.0, time + 1e6, time), motion)


@pytest.mark.parametrize('band', [(0.0, 1.0), (2.0, 1.0), (1.0, np.inf), (np.nan, 1.0)])
def test_an_empty_band(band):
    with pytest.raises(ParameterError, match='band'):
        estimate_sway(*release(), band=band)


@pytest.mark.parametrize('bad', [1e308, 1e200, np.inf])
def test_what_nothing_measures_is_refused(bad):
    time = 0.05 * np.arange(1000.0)
    motion = np.exp(-0.1 * time) * np.cos(3.0 * time)
    motion[9] = bad
    with pytest.raises(FormatError, match='sample 9: not a finite number, or an implausible'):
        estimate_sway(time, motion)


def test_a_time_that_counts_from_another_zero_is_a_gap():
    time = 0.05 * np.arange(1000.0)
    motion = np.exp(-0.1 * time) * np.cos(3.0 * time)
    time[-1] = 1.7e9
    with pytest.raises(FormatError, match=r'gaps of up to 1\.7e'):
        estimate_sway(time, motion)


@pytest.mark.parametrize('pulled', [0.0, 3.0, 5.0])
@pytest.mark.parametrize('frequency', [0.3, 0.5, 0.8])
@pytest.mark.parametrize('seed', [0, 1])
def test_a_short_pull_in_summer(frequency, pulled, seed):
    """Twenty seconds in all, a tenth of critical damping in leaf."""
    found = estimate_sway(
        *release(frequency, 0.1, duration=20.0, pulled=pulled, noise=0.005, seed=seed)
    )
    assert found.frequency == pytest.approx(frequency, rel=0.02)
    assert found.damping_ratio == pytest.approx(0.1, rel=0.1)


@pytest.mark.parametrize('seed', [0, 1, 2])
@pytest.mark.parametrize('noise', [0.005, 0.03])
def test_a_pull_too_short_for_its_tree_says_why(noise, seed):
    """Of a sway with too few cycles no other mode, and no noise, is taken in its place."""
    time, motion = release(0.2, 0.1, duration=20.0, pulled=5.0, noise=noise, seed=seed)
    with pytest.raises(
        FormatError, match=r'cycles of 0\.[12]\d+ Hz after .*; record 5 cycles after'
    ):
        estimate_sway(time, motion)


@pytest.mark.parametrize('seed', [3, 4, 6])
def test_a_pull_lost_in_the_wind_says_why(seed):
    """In leaf, a tenth of the pull in other motion: no other mode is taken for the sway."""
    time, motion = release(0.5, 0.1, duration=20.0, pulled=3.0, noise=0.005, seed=seed)
    _, wind = in_wind(0.5, 0.1, duration=60.0, seed=seed)
    with pytest.raises(FormatError, match=r'beside the swing; pull farther or on a calmer day'):
        estimate_sway(time, motion + 0.1 * wind[: len(motion)])
