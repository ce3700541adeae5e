# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The resonance in a spectrum: the model, scatter of the answer, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.identification.ambient_sway import ambient_sway, log_spectrum
from tree_sway.errors import FormatError

DT = 0.1


def driven(damping, seed, duration=600.0, colour=0.0):
    """Oscillator of 0.7 Hz under noise of spectral slope `colour`, (n, 1)."""
    rng = np.random.default_rng(seed)
    n = int(2 * duration / DT)
    f = np.fft.rfftfreq(n, DT)
    load = (rng.normal(size=len(f)) + 1j * rng.normal(size=len(f))) * np.maximum(f, 0.02) ** (
        colour / 2
    )
    motion = np.fft.irfft(load / (1.0 - (f / 0.7) ** 2 + 2j * damping * f / 0.7), n)[
        n // 4 : 3 * n // 4
    ]
    return (motion / motion.std())[:, None]


def test_the_peak_is_that_of_an_oscillator():
    """At resonance the power is (2 zeta)^-2 of the static one (no floor, no slope)."""
    x = np.array([np.log(0.7), np.log(0.05), 0.0, -50.0, 0.0])
    level = log_spectrum(x, np.array([1e-6, 0.7]))
    assert level[1] - level[0] == pytest.approx(np.log(100.0), rel=1e-9)


@pytest.mark.parametrize('damping', [0.03, 0.1])
@pytest.mark.parametrize('colour', [0.0, -5.0 / 3.0, 2.0])
def test_unbiased_and_as_uncertain_as_it_says(damping, colour):
    found = [ambient_sway(driven(damping, seed, colour=colour), DT, 0.68) for seed in range(16)]
    for name, truth in (('frequency', 0.7), ('damping', damping)):
        values = np.array(
            [one.frequency if name == 'frequency' else one.damping_ratio for one in found]
        )
        error = np.mean([getattr(one, f'{name}_error') for one in found])
        scatter = np.sqrt(np.mean((values - truth) ** 2))
        assert abs(values.mean() - truth) < 0.1 * truth
        assert 0.6 < error / scatter < 1.8


def test_the_uncertainty_is_that_of_theory():
    """Au (2014): sqrt(zeta / 2 pi N) and 1 / sqrt(2 pi zeta N), relative, of N cycles at best."""
    found = ambient_sway(driven(0.05, 1, duration=2000.0), DT, 0.7)
    assert 1.0 < found.frequency_error / 0.7 / np.sqrt(0.05 / (2 * np.pi * found.cycles)) < 1.6
    assert 1.0 < found.damping_error / 0.05 * np.sqrt(2 * np.pi * 0.05 * found.cycles) < 2.5


def test_the_axis_that_moves_is_found():
    motion = driven(0.05, 2)
    noise = np.random.default_rng(0).normal(size=motion.shape)
    plain = ambient_sway(motion, DT, 0.7)
    tilted = ambient_sway(np.hstack([0.3 * motion, 0.1 * noise, -0.8 * motion]), DT, 0.7)
    assert tilted.frequency == pytest.approx(plain.frequency, rel=1e-4)
    assert tilted.damping_ratio == pytest.approx(plain.damping_ratio, rel=1e-3)


def test_no_resonance_is_refused():
    """Of 30 records of noise without any, none may pass."""
    for seed in range(30):
        noise = np.random.default_rng(seed).normal(size=(6000, 1))
        with pytest.raises(FormatError, match=r'the spectrum has no peak around 0\.7 Hz'):
            ambient_sway(noise if seed % 2 else np.cumsum(noise, axis=0), DT, 0.7)


def test_too_few_cycles():
    refusal = r'14\.0 cycles of 0.7 Hz; an ambient record takes at least 20'
    with pytest.raises(FormatError, match=refusal):
        ambient_sway(driven(0.05, 0)[:200], DT, 0.7)
