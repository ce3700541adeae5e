# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Poles of damped exponentials: exact without noise, and as uncertain as they say with it."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.identification.free_decay import free_decay

DT = 0.02


def decay(modes, duration=40.0, noise=0.0, seed=0):
    """Sum of (frequency, damping, amplitude) from the first sample on, (n, 1)."""
    time = np.arange(0.0, duration, DT)
    motion = noise * np.random.default_rng(seed).normal(size=len(time))
    for frequency, damping, amplitude in modes:
        w = 2.0 * np.pi * frequency
        motion += (
            amplitude * np.exp(-damping * w * time) * np.sin(w * np.sqrt(1 - damping**2) * time)
        )
    return motion[:, None]


@pytest.mark.parametrize('damping', [0.005, 0.02, 0.1, 0.2])
def test_exact_without_noise(damping):
    """What is left is the filter's start-up, some cycles before the window."""
    found = free_decay(decay([(0.8, damping, 1.0)]), DT, 0.82)
    assert found.frequency == pytest.approx(0.8, rel=2e-4)
    assert found.damping_ratio == pytest.approx(damping, rel=5e-3)
    assert found.explained > 0.999


def test_a_near_mode_of_another_damping_is_kept_apart():
    found = free_decay(decay([(0.8, 0.02, 1.0), (1.1, 0.06, 0.5)]), DT, 0.8)
    assert found.frequency == pytest.approx(0.8, rel=1e-3)
    assert found.damping_ratio == pytest.approx(0.02, rel=0.02)


def test_standard_errors_are_those_of_many_records():
    found = [free_decay(decay([(0.8, 0.05, 1.0)], noise=0.05, seed=s), DT, 0.8) for s in range(40)]
    frequency = np.array([one.frequency for one in found])
    damping = np.array([one.damping_ratio for one in found])
    for values, truth, errors in (
        (frequency, 0.8, [one.frequency_error for one in found]),
        (damping, 0.05, [one.damping_error for one in found]),
    ):
        scatter = np.sqrt(np.mean((values - truth) ** 2))
        assert 0.4 < np.mean(errors) / scatter < 2.5


def test_quiet_separates_a_release_from_wind():
    assert free_decay(decay([(0.8, 0.05, 1.0)], noise=0.02), DT, 0.8).quiet < 0.1
    has_predecessor = decay([(0.8, 0.05, 1.0), (0.8, 0.0005, 0.9)], duration=100.0)
    assert free_decay(has_predecessor, DT, 0.8).quiet > 0.3


def test_a_decay_that_starts_too_late():
    late = decay([(0.8, 0.05, 1.0)])[::-1].copy()
    with pytest.raises(FormatError, match=r'0\.\d cycles of 0.8 Hz after the largest swing'):
        free_decay(late, DT, 0.8)


def test_a_growing_swing_does_not_decay():
    time = np.arange(0.0, 6.0, DT)
    growing = (np.exp(0.05 * time) * np.sin(2 * np.pi * 0.8 * time))[:, None]
    growing = np.vstack([10.0 * growing[:30], growing])
    with pytest.raises(FormatError, match=r'no motion that decays near 0\.8 Hz'):
        free_decay(growing, DT, 0.8)
