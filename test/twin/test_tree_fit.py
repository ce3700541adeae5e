# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A fit tells the damping below the noise of a sensor, and follows a tree whose leaves get wet."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.twin.tree_fit import fit_of, Known, Spectrum, TreeFit

CIRCULAR = 2.0 * np.pi * np.linspace(0.5, 2.2, 69)
STIFFNESS = np.full(2, (2.0 * np.pi) ** 2)
DAMPING, AIR = np.full(2, 0.6), np.full(2, 0.4)
"""Of two coordinates that move a sensor to east and to north, of 1 Hz."""


def spectrum(stiff: float, damped: float, noise: float) -> Spectrum:
    """Spectrum of the displacement under white forces, of a peak of 1, with its noise."""
    rows = np.zeros((3, 6))
    rows[0, 0] = rows[1, 1] = 1.0
    loss = damped * math.sqrt(stiff) * DAMPING[0] + AIR[0]
    response = 1.0 / (stiff * STIFFNESS[0] - CIRCULAR**2 + 1j * CIRCULAR * loss)
    power: Floats = np.square(np.abs(response))
    power = power / power.max() + noise
    products = np.zeros((len(CIRCULAR), 4, 4), dtype=np.complex128)
    products[:, 0, 0] = products[:, 1, 1] = power
    return Spectrum(rows, products, CIRCULAR, 400, 600.0, noise)


def fitted(measured: Spectrum, before: Known | None = None) -> tuple[TreeFit, Known]:
    return fit_of([measured], STIFFNESS, DAMPING, AIR, np.eye(2), 1.0, before)


@pytest.mark.parametrize('noise', [0.001, 0.03, 0.3])
def test_the_noise_of_a_sensor_is_no_damping(noise: float) -> None:
    found, _ = fitted(spectrum(1.0, 1.0, noise))
    assert found.stiffness == pytest.approx(1.0, abs=0.02)
    assert found.damping == pytest.approx(1.0, rel=0.1)


def test_noise_that_is_not_counted_is_damping() -> None:
    found, _ = fitted(spectrum(1.0, 1.0, 0.03)._replace(noise=0.0))
    assert found.damping > 1.3


def test_noise_alone_tells_nothing() -> None:
    flat = spectrum(1.0, 1.0, 1e9)
    found, _ = fitted(flat)
    assert found.stiffness_error > 0.15
    assert found.damping_error > 0.4


@pytest.mark.parametrize('stiff', [0.7, 1.3])
def test_the_damping_of_a_softer_tree_is_that_of_its_ratio(stiff: float) -> None:
    found, _ = fitted(spectrum(stiff, 1.4, 0.01))
    assert found.stiffness == pytest.approx(stiff, rel=0.03)
    assert found.damping == pytest.approx(1.4, rel=0.1)


def test_wet_leaves_change_the_stiffness_and_not_the_damping() -> None:
    found, known = fitted(spectrum(1.0, 1.0, 0.01))
    for stiff in (*np.geomspace(1.0, 0.87, 6), *np.full(4, 0.87)):
        found, known = fitted(spectrum(float(stiff), 1.0, 0.01), known.later())
    assert found.stiffness == pytest.approx(0.87, rel=0.03)
    assert found.damping == pytest.approx(1.0, rel=0.1)
    assert found.damping_error < 0.2
    assert found.hours == pytest.approx(11.0 * 600.0 / 3600.0)
