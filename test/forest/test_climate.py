# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Years between winds, beside published factors and a closed form."""

from __future__ import annotations

import math

import pytest

from tree_sway.errors import ParameterError
from tree_sway.forest.climate import beaufort, climate_of


@pytest.mark.parametrize(('years', 'factor'), [(10, 0.902), (50, 1.0), (100, 1.04)])
def test_the_basic_wind_is_scaled_as_by_eurocode(years: float, factor: float) -> None:
    """c_prob of EN 1991-1-4 for K = 0.2 and n = 0.5, as its commentaries tabulate it."""
    assert climate_of('25').per_year(25.0 * factor) == pytest.approx(1.0 / years, rel=0.07)


def test_hours_of_a_weibull_distribution() -> None:
    """Rayleigh with a mean of 4 m/s: 15 m/s comes once in seven years."""
    climate = climate_of(f'{8.0 / math.sqrt(math.pi)},2')
    assert 1.0 / climate.per_year(15.0) == pytest.approx(7.1, rel=0.02)


def test_beaufort_is_that_of_the_table() -> None:
    forces = {0.2: 0, 10.7: 5, 10.8: 6, 24.5: 10, 32.7: 12, 60.0: 12}
    assert {speed: beaufort(speed) for speed in forces} == forces


@pytest.mark.parametrize('text', ['windy', '', '1,2,3', '0', 'nan', '5,99', '-3', '22,5'])
def test_what_is_no_climate_is_refused(text: str) -> None:
    with pytest.raises(ParameterError, match='climate'):
        climate_of(text)
