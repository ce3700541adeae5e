# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Odd real spherical harmonics: orthonormal, odd, complete up to their degree."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import eval_legendre

from tree_sway.core.model.records import N_HARMONICS
from tree_sway.core.setup.spherical_harmonics import harmonics_at


def sphere():
    """Directions and weights that integrate polynomials of degree 23 exactly."""
    z, weight = np.polynomial.legendre.leggauss(12)
    azimuth = 2.0 * np.pi * np.arange(24) / 24.0
    level = np.sqrt(1.0 - z * z)[:, None]
    directions = np.stack(
        [level * np.cos(azimuth), level * np.sin(azimuth), z[:, None] + 0.0 * azimuth], axis=-1
    )
    return directions.reshape(-1, 3), np.repeat(weight / 48.0, 24)


def test_they_are_orthonormal():
    directions, weight = sphere()
    values = harmonics_at(directions)
    assert values.T @ (weight[:, None] * values) == pytest.approx(np.eye(N_HARMONICS), abs=1e-13)


def test_the_opposite_wind_has_the_opposite_values():
    directions, _ = sphere()
    assert harmonics_at(-directions) == pytest.approx(-harmonics_at(directions), abs=1e-14)


def test_the_addition_theorem_holds_():
    directions, _ = sphere()
    values = harmonics_at(directions[:40])
    cosine = np.clip(directions[:40] @ directions[:40].T, -1.0, 1.0)
    wanted = sum((2 * n + 1) * eval_legendre(n, cosine) for n in (1, 3, 5))
    assert values @ values.T == pytest.approx(wanted, abs=1e-12)
