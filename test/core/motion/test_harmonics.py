# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Odd real spherical harmonics: orthonormal, odd, complete up to their degree."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import eval_legendre

from tree_sway.core.motion.harmonics import COUNT
from tree_sway.core.motion.wind_basis_table import harmonics_at


def sphere():
    """Directions and weights that integrate polynomials of degree 23 exactly."""
    z, weight = np.polynomial.legendre.leggauss(12)
    azimuth = 2.0 * np.pi * np.arange(24) / 24.0
    level = np.sqrt(1.0 - z * z)[:, None]
    directions = np.stack(
        [level * np.cos(azimuth), level * np.sin(azimuth), z[:, None] + 0.0 * azimuth], axis=-1
    )
    return directions.reshape(-1, 3), np.repeat(weight / 48.0, 24)


@pytest.mark.parametrize('degree', COUNT)
def test_they_are_orthonormal(degree):
    directions, weight = sphere()
    values = harmonics_at(directions, degree)
    assert values.T @ (weight[:, None] * values) == pytest.approx(np.eye(COUNT[degree]), abs=1e-13)


@pytest.mark.parametrize('degree', COUNT)
def test_the_opposite_wind_has_the_opposite_values(degree):
    directions, _ = sphere()
    assert harmonics_at(-directions, degree) == pytest.approx(
        -harmonics_at(directions, degree), abs=1e-14
    )


@pytest.mark.parametrize('degree', COUNT)
def test_the_addition_theorem_holds_for_every_degree(degree):
    directions, _ = sphere()
    values = harmonics_at(directions[:40], degree)
    cosine = np.clip(directions[:40] @ directions[:40].T, -1.0, 1.0)
    wanted = sum((2 * n + 1) * eval_legendre(n, cosine) for n in range(1, degree + 1, 2))
    assert values @ values.T == pytest.approx(wanted, abs=1e-12)
