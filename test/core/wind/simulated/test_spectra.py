# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every model of turbulence: its variance, its scale, its fall."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.integrate

from tree_sway.core.wind.simulated.anemometer import AnemometerModel
from tree_sway.core.wind.simulated.spectra import SPECTRA
from tree_sway.core.wind.simulated.turbulence import Turbulence

every = pytest.mark.parametrize('name', SPECTRA)


@every
@pytest.mark.parametrize('across', [False, True])
def test_it_holds_its_variance(name, across):
    total, _ = scipy.integrate.quad(
        lambda n: float(SPECTRA[name].of_component(n, 7.0, 1.5, 40.0, across=across)),
        0.0,
        np.inf,
        limit=400,
    )
    assert total == pytest.approx(1.5**2, rel=3e-4)


@every
def test_it_begins_with_its_integral_scale(name):
    """S(0) = 4 L s^2 / U is what makes L the integral scale."""
    at_zero = float(SPECTRA[name].of_component(0.0, 7.0, 1.5, 40.0, across=False))
    assert at_zero == pytest.approx(4.0 * 40.0 * 1.5**2 / 7.0)


@every
def test_it_falls_with_the_power_of_the_inertial_subrange(name):
    low, high = Turbulence(7.0, name).spectrum(np.array([1e4, 1e5]))
    np.testing.assert_allclose(high / low, 10 ** (-5 / 3), rtol=2e-3)


@every
def test_the_simulated_anemometer_offers_it(name):
    model = AnemometerModel(8.0, turbulence=name, intensity=0.2)
    speed = np.array([model.sample(k)[0] for k in range(0, 12_000, 5)])
    assert 0.5 < speed.std() / 1.6 < 1.5
