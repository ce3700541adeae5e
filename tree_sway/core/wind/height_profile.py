# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Profile of the wind over height."""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of, within

PROFILES = ('none', 'power', 'log')
"""Kinds of profile."""


@dataclass(frozen=True)
class WindProfile:
    """
    Mean wind speed by height.

    Parameters
    ----------
    kind
        ``none`` (the same at every height), ``power`` (U ~ z^p) or ``log`` (U ~ ln(z / z0)).
    anemometer_height
        Height of the anemometer over the ground in [m].
    exponent
        p of the power law in [-]; 0.14 over open ground, 0.25 and more between trees (Davenport,
        1960).
    roughness
        z0 of the log law in [m]; 0.03 over grass, 0.5 and more between trees.
    ground
        Height of the ground in the tree's frame in [m].

    """

    kind: str = 'none'
    anemometer_height: float = 10.0
    exponent: float = 0.14
    roughness: float = 0.03
    ground: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        one_of('wind profile', self.kind, PROFILES)
        within('anemometer_height', self.anemometer_height, 0.0, 1e4, 'm', above=True)
        if self.kind == 'log':
            highest = 0.999 * self.anemometer_height
            within('roughness', self.roughness, 0.0, highest, 'm', above=True)

    def over_anemometer(self, z: Floats) -> Floats:
        """
        Wind speed over that at the anemometer.

        Parameters
        ----------
        z
            Heights in the tree's frame in [m], any shape.

        Returns
        -------
        Floats
            Ratios of the same shape in [-]; 0 at the ground and below, except for kind ``none``.

        """
        height = np.maximum(np.asarray(z, dtype=np.float64) - self.ground, 0.0)
        if self.kind == 'none':
            return np.ones_like(height)
        if self.kind == 'power':
            return np.asarray((height / self.anemometer_height) ** self.exponent)
        above = np.maximum(height / self.roughness, 1.0)
        return np.asarray(np.log(above) / math.log(self.anemometer_height / self.roughness))
