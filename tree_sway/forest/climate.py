# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How often a mean wind comes, in a climate that is stated.

A basic wind, of ten minutes at 10 m in open country, that comes once in 50 years: others by the
probability factor of EN 1991-1-4 (2005, equation 4.2, K = 0.2, n = 0.5), the largest of each year
being of Gumbel's kind in the pressure. Or hours of a Weibull distribution, each by itself, which
knows no storms: its tail is too short in most places.

In leaf, from April to September, the same wind comes as often as one 1 / `SUMMER` as high in the
whole year (BS 6399-2, 1997, table D.1).
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.errors import ParameterError

SUMMER = 0.84
_K = 0.2
_HOURS = 8766.0
_REDUCED_50 = -math.log(-math.log(0.98))
_MOST_SCALE = 20.0
"""Largest scale of a Weibull distribution [m/s]: above it stands a comma for a point."""
_BEAUFORT = (0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7)
"""Least mean wind of the forces 1 to 12 in [m/s] (WMO no. 306, table 1100)."""


@dataclass(frozen=True)
class Climate:
    """
    Climate of a place.

    ``speed`` in [m/s] is the basic wind, or with a ``shape`` the scale of a Weibull distribution.
    """

    speed: float = 22.5
    shape: float | None = None

    def per_year(self, speed: ArrayLike) -> Floats:
        """Return how often a year has mean winds of some speeds [m/s] or more at 10 m."""
        over = np.asarray(speed) / self.speed
        if self.shape is not None:
            return np.asarray(_HOURS * np.exp(-(over**self.shape)))
        squared = over**2 * (1.0 + _K * _REDUCED_50)
        return np.asarray(np.exp((1.0 - squared) / _K))

    def __str__(self) -> str:
        """Say what it is."""
        if self.shape is not None:
            return f'hours of a Weibull distribution, {self.speed:g} m/s, shape {self.shape:g}'
        return f'{self.speed:g} m/s once in 50 years (EN 1991-1-4)'


INLAND = Climate()
"""Zone 1 of the German annex of EN 1991-1-4."""


def climate_of(text: str) -> Climate:
    """Read a basic wind in [m/s], or the scale [m/s] and shape of a Weibull distribution."""
    try:
        speed, *shape = (float(word) for word in text.split(','))
        climate = Climate(speed, *shape)
    except (TypeError, ValueError):
        cure = 'give a basic wind, 25, or scale and shape of a Weibull distribution, 4.5,2'
        what = f"'{text[:40]}' is no climate"
        raise ParameterError(what, where='--climate', cure=cure) from None
    within('--climate', climate.speed, 0.5, 80.0, 'm/s')
    if climate.shape is not None:
        within(f'--climate {text[:20]}: shape of a Weibull distribution', climate.shape, 0.5, 10.0)
        if climate.speed > _MOST_SCALE:
            what = f"'{text}' is hours of a Weibull distribution, and no place is as windy"
            cure = 'give a basic wind with a point, 22.5'
            raise ParameterError(what, where='--climate', cure=cure)
    return climate


def beaufort(speed: float) -> int:
    """Return the force of a mean wind [m/s]."""
    return int(np.searchsorted(_BEAUFORT, speed, side='right'))
