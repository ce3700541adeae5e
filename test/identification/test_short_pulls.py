# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pull tests of 20 s on trees in leaf, of damping 0.1: they calibrate, or say why not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.identification.measured_sway import estimate_sway

DT, DAMPING = 0.05, 0.1


def pulled(frequency, seed, wind=0.0):
    """Tip held for 3 s, then released, over a sway in the wind that is a share of the pull."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 20.0, DT)
    w = 2.0 * math.pi * frequency
    damped = w * math.sqrt(1.0 - DAMPING**2)
    since = np.maximum(time - 3.0, 0.0)
    swing = np.cos(damped * since) + DAMPING * w / damped * np.sin(damped * since)
    tip = np.exp(-DAMPING * w * since) * swing + rng.normal(0.0, 0.005, len(time))
    if wind:
        lines = np.fft.rfftfreq(len(time), DT)
        gain = 1.0 / (w**2 - (2 * np.pi * lines) ** 2 + 2j * DAMPING * w * 2 * np.pi * lines)
        sway = np.fft.irfft(gain * np.fft.rfft(rng.normal(size=len(time))), len(time))
        tip += wind * sway / sway.std()
    return time, tip


@pytest.mark.parametrize('frequency', [0.3, 0.5, 0.8, 1.5])
def test_in_calm_air_frequency_and_damping_are_found(frequency):
    for seed in range(4):
        found = estimate_sway(*pulled(frequency, seed))
        assert found.frequency == pytest.approx(frequency, rel=0.01)
        assert found.damping_ratio == pytest.approx(DAMPING, rel=0.05)


@pytest.mark.parametrize('frequency', [0.3, 0.5, 0.8, 1.5])
def test_in_wind_they_are_found_or_it_is_said_why_not(frequency):
    for seed in range(6):
        found, why = None, ''
        try:
            found = estimate_sway(*pulled(frequency, seed, wind=0.02))
        except FormatError as error:
            why = str(error)
        if found is None:
            assert 'beside the swing' in why
        else:
            assert found.frequency == pytest.approx(frequency, rel=0.05)
            assert found.damping_ratio == pytest.approx(DAMPING, rel=0.4)
