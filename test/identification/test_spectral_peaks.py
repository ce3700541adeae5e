# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Peaks of smooth spectra."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.identification.spectral_peaks import spectral_peaks

F = np.linspace(0.0, 10.0, 5001)
DURATION = 500.0


def hills(*places):
    """Hills of the same relative width on a falling slope."""
    power = 1e-3 / (0.01 + F)
    for place, height in places:
        power = power + height * np.exp(-0.5 * ((F - place) / (0.05 * place)) ** 2)
    return power


def test_hills_are_found_where_they_are():
    frequencies, levels = spectral_peaks(F, hills((0.7, 1.0), (3.0, 0.2)), DURATION, None)
    np.testing.assert_allclose(frequencies, [0.7, 3.0], rtol=0.03)
    assert levels[0] > levels[1]


def test_a_band_leaves_the_others_out():
    frequencies, _ = spectral_peaks(F, hills((0.7, 1.0), (3.0, 0.2)), DURATION, (1.0, 5.0))
    np.testing.assert_allclose(frequencies, [3.0], rtol=0.03)


def test_a_band_without_a_peak_gives_its_strongest_point():
    frequencies, _ = spectral_peaks(F, hills(), DURATION, (1.0, 2.0))
    np.testing.assert_allclose(frequencies, [1.0])


@pytest.mark.parametrize(
    ('spectrum', 'band', 'message'),
    [
        (hills(), None, 'no peak in its spectrum'),
        (hills((0.7, 1.0)), (20.0, 30.0), 'have no content in the band'),
        (hills((0.7, 1.0)), (1e-5, 1e-4), 'have no content in the band'),
    ],
)
def test_refusals(spectrum, band, message):
    with pytest.raises(FormatError, match=message):
        spectral_peaks(F, spectrum, DURATION, band)
