# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A spectrum that is found over many steps is the one of the whole record."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import ShortTimeFFT

from tree_sway.core.arrays import Floats
from tree_sway.twin.sensor_spectrum import SensorSpectrum

FREQUENCY, DT, FORCES = 1.0, 0.1, 3
LENGTH = 400


def add(spectrum: SensorSpectrum, motion: Floats, force: Floats) -> None:
    """Add a sample as the native core does, whose watched motion is the other one too."""
    rows, native = spectrum._series.reshape(-1, FORCES + 4), spectrum.native
    rows[native.filled % len(rows)] = np.concatenate((motion, force, motion))
    native.filled += 1
    assert spectrum.advance()
    assert not spectrum.advance()


def test_it_is_the_mean_over_stretches_that_overlap_by_half() -> None:
    rng = np.random.default_rng(6)
    motion, force = rng.normal(size=(1000, 2)), rng.normal(size=(1000, FORCES)) + 5.0
    spectrum = SensorSpectrum(FREQUENCY, DT, FORCES)
    for each in zip(motion, force, strict=True):
        add(spectrum, *each)
    # The fifth half ends with the record: its stretch has not been transformed yet.
    assert spectrum.count == 3
    series = np.hstack([motion[:, :2], force])
    window = np.hanning(LENGTH + 1)[:-1]
    welch = ShortTimeFFT(window, LENGTH // 2, 1.0 / DT, phase_shift=None)
    stretches = [slice(first, first + LENGTH) for first in (0, 200, 400)]
    means = [series[each] - series[each].mean(axis=0) for each in stretches]
    waves = [welch.stft(each.T, k_offset=LENGTH // 2, p0=0, p1=1)[..., 0] for each in means]
    inside = np.isin(
        np.arange(LENGTH // 2 + 1), np.round(spectrum.circular * LENGTH * DT / 2 / np.pi)
    )
    wanted = np.mean([each[:, None] * each[None].conj() for each in waves], axis=0)
    np.testing.assert_allclose(
        spectrum.products, np.moveaxis(wanted[..., inside], 2, 0), atol=1e-9 * np.abs(wanted).max()
    )
    frequencies = np.round(spectrum.watched_frequencies * LENGTH * DT).astype(int)
    power = 3.0 * wanted[[0, 1], [0, 1]].real
    np.testing.assert_allclose(spectrum.end_block().watched, power[:, frequencies].T, rtol=1e-9)


def test_a_gap_begins_a_stretch_anew() -> None:
    spectrum = SensorSpectrum(FREQUENCY, DT, FORCES)
    still = np.zeros(2), np.zeros(FORCES)
    for _ in range(300):
        add(spectrum, *still)
    assert spectrum.until_first == pytest.approx(10.0)
    spectrum.skip()
    assert spectrum.until_first == pytest.approx(LENGTH * DT)
    for _ in range(LENGTH + 4 + FORCES):
        assert spectrum.count == 0
        add(spectrum, *still)
    assert spectrum.count == 1
    assert spectrum.until_first == 0.0


def test_the_noise_is_the_mean_over_the_stretches_that_are_new() -> None:
    spectrum = SensorSpectrum(FREQUENCY, DT, FORCES)
    one = spectrum.power_of_noise(1.0)
    spectrum.note_noise(0.1, 1.0)
    spectrum.count = 1
    assert spectrum.noise == pytest.approx(0.01 * one)
    spectrum.take_products()
    assert spectrum.noise == 0.0
    spectrum.note_noise(0.2, 2.0)
    spectrum.note_noise(0.4, 4.0)
    spectrum.count = 3
    assert spectrum.noise == pytest.approx(0.1 * one)
    np.testing.assert_allclose(spectrum.end_block().noise, [0.21 * one, 21.0 * one])
    spectrum.note_noise(0.3, 3.0)
    np.testing.assert_allclose(spectrum.end_block().noise, [0.09 * one, 9.0 * one])
