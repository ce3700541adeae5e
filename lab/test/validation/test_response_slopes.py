# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Slopes above the first frequency: of a known spectrum, of one oscillator, of a grown tree."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.validation.response_slopes import response_slopes, slope_above
from tree_sway_lab.validation.sections.slopes import FLATTEST, SEEDS, STEEPEST

from tree_sway.core.wind.gusts.crown_wind import USUAL_COHERENCE

RATE = 30.0


def noise(shape, seconds=3000.0):
    """Signal whose spectrum has the amplitude `shape` of each frequency."""
    n = round(seconds * RATE)
    frequency = np.fft.rfftfreq(n, 1.0 / RATE)
    frequency[0] = frequency[1]
    phase = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, len(frequency))
    return np.fft.irfft(shape(frequency) * np.exp(1j * phase), n)


@pytest.mark.parametrize('power', [-2.0, -4.4])
def test_a_known_slope_is_found(power):
    signal = noise(lambda f: np.maximum(f, 0.4) ** (0.5 * power))
    assert slope_above(signal, 0.6, RATE) == pytest.approx(power, abs=0.15)


def test_one_oscillator_alone_is_steeper_than_any_tree():
    signal = noise(lambda f: f ** (-5 / 6) / np.abs(0.6**2 - f**2 + 0.12j * 0.6 * f))
    assert -7.5 < slope_above(signal, 0.6, RATE) < -6.2


@pytest.mark.long
@pytest.mark.xfail(strict=True, reason='reads 1.5 since what modes lack has inertia')
def test_the_tip_of_a_broadleaf_falls_more_steeply_than_the_strain_of_its_stem():
    slopes = response_slopes('walnut', coherence=1.0, in_leaf=False, seconds=120.0)
    assert 0.7 < slopes.first < 1.2
    assert np.mean(slopes.tip) < np.mean(slopes.strain) - 2.0


@pytest.mark.long
@pytest.mark.parametrize('in_leaf', [False, True])
@pytest.mark.parametrize('species', ['spruce', 'pine', 'birch', 'walnut'])
def test_the_strain_falls_as_on_real_trees_with_gusts_limb_by_limb(species, in_leaf):
    trees = [
        response_slopes(species, coherence=USUAL_COHERENCE, in_leaf=in_leaf, seed=seed)
        for seed in SEEDS
    ]
    mean = np.mean([tree.strain for tree in trees], axis=0)
    assert mean.shape == (2,)
    assert ((mean >= STEEPEST) & (mean <= FLATTEST)).all()
