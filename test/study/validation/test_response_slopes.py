# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Slopes above the first frequency: of a known spectrum, of one oscillator, and as a table."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.wind.crown_wind import USUAL_COHERENCE
from tree_sway_ros.study.chart.slopes import chart_slopes
from tree_sway_ros.study.validation.response_slopes import slope_above

RATE = 30.0


def noise(shape, seconds=3000.0):
    """Signal whose spectrum has the amplitude `shape` of each frequency."""
    n = round(seconds * RATE)
    frequency = np.fft.rfftfreq(n, 1.0 / RATE)
    frequency[0] = frequency[1]
    phase = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, len(frequency))
    return np.fft.irfft(shape(frequency) * np.exp(1j * phase), n)


@pytest.mark.parametrize("power", [-2.0, -4.4])
def test_a_known_slope_is_found(power):
    signal = noise(lambda f: np.maximum(f, 0.4) ** (0.5 * power))
    assert slope_above(signal, 0.6, RATE) == pytest.approx(power, abs=0.15)


def test_one_oscillator_alone_is_steeper_than_any_tree():
    signal = noise(lambda f: f ** (-5 / 6) / np.abs(0.6**2 - f**2 + 0.12j * 0.6 * f))
    assert -7.5 < slope_above(signal, 0.6, RATE) < -6.2


def test_the_table_has_both_winds(tmp_path):
    found = chart_slopes(tmp_path, species=["pine"], seconds=60.0)
    assert set(found) == {
        ("pine", leaf, c) for leaf in (False, True) for c in (1.0, USUAL_COHERENCE)
    }
    assert all(-12.0 < each.along < 1.0 for each in found.values())
    text = (tmp_path / "slopes.md").read_text(encoding="utf-8")
    assert text.count("| pine |") == 2
