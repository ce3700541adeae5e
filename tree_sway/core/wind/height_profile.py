# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Profile of the wind over height."""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of, within

PROFILES = ('none', 'power', 'log', 'canopy')
"""Kinds of profile."""


@dataclass(frozen=True)
class WindProfile:
    """
    Mean wind speed by height.

    Parameters
    ----------
    kind
        ``none`` (the same at every height), ``power`` (U ~ z^p), ``log`` (U ~ ln(z / z0)) or
        ``canopy``, in a stand: U ~ ln((z - d) / z0) above its top h, and exp(-a (1 - z / h)) times
        the wind at its top below (Cionco 1965; Raupach, Finnigan & Brunet 1996).
    anemometer_height
        Height of the anemometer over the ground in [m].
    exponent
        p of the power law in [-]; 0.14 over open ground, 0.25 and more between trees (Davenport,
        1960).
    roughness
        z0 of the log law in [m]; 0.03 over grass, 0.5 and more between trees.
    ground
        Height of the ground in the tree's frame in [m].
    canopy_height, displacement
        h and d of a stand in [m].
    attenuation
        a of a stand in [-].
    exposed
        Wind below the top of a stand over that deep inside it [-]; at an edge it is above 1.

    """

    kind: str = 'none'
    anemometer_height: float = 10.0
    exponent: float = 0.14
    roughness: float = 0.03
    ground: float = 0.0
    canopy_height: float = 0.0
    displacement: float = 0.0
    attenuation: float = 0.0
    exposed: float = 1.0

    def __post_init__(self) -> None:
        """Check the values."""
        one_of('wind profile', self.kind, PROFILES)
        within('anemometer_height', self.anemometer_height, 0.0, 1e4, 'm', above=True)
        if self.kind == 'canopy':
            within('canopy_height', self.canopy_height, 0.0, 200.0, 'm', above=True)
            within('displacement', self.displacement, 0.0, 0.99 * self.canopy_height, 'm')
            within('attenuation', self.attenuation, 0.0, 20.0)
            within('exposed', self.exposed, 1.0, 10.0)
        if self.kind in ('log', 'canopy'):
            highest = 0.999 * (self._reference - self.displacement)
            within('roughness', self.roughness, 0.0, highest, 'm', above=True)

    @property
    def _reference(self) -> float:
        """Height of the anemometer, or of the top of a stand if that is higher, in [m]."""
        return max(self.anemometer_height, self.canopy_height)

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
        if self.kind == 'canopy':
            at_anemometer = self._in_canopy(np.array([self.anemometer_height]))[0]
            return np.asarray(self._in_canopy(height) / at_anemometer)
        above = np.maximum(height / self.roughness, 1.0)
        return np.asarray(np.log(above) / math.log(self.anemometer_height / self.roughness))

    def _in_canopy(self, height: Floats) -> Floats:
        """Wind in and above a stand over that at its top, at heights above the ground [m]."""
        top = self.canopy_height
        d = self.displacement
        z0 = self.roughness
        above = np.log(np.maximum(height - d, top - d) / z0) / math.log((top - d) / z0)
        inside = np.exp(-self.attenuation * (1.0 - np.minimum(height / top, 1.0)))
        inside = np.minimum(self.exposed * inside, 1.0)
        return np.asarray(np.where(height > top, above, np.where(height > 0.0, inside, 0.0)))
