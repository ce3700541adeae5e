# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Where a tree stands: alone in the open, in a street, at the edge of a stand, or inside it.

Open: a log profile over grass, U ~ ln(z / z0) with z0 = 0.03 m, and its mean wind at the top of
the tree, or 10 m above the ground where the tree is higher, as weather stations measure it.

Street: the log profile of suburbs, terrain III of EN 1991-1-4 (2005) with z0 = 0.3 m, and its mean
wind 10 m above the ground. The same weather has a mean wind in terrains II and III that is as
z0^0.07 ln(z / z0) (equations 4.3 to 4.5 there).

In the open and in a street one gust is smaller than the whole crown: the deviation of the wind is
that of its mean over the crown, by the background factor B of EN 1991-1-4 (equation B.3).

Stand: a tree as high as its neighbours. Displacement d, roughness z0 and friction velocity u* over
the wind U_h at the top follow from the streamlined frontal area of the crowns per ground area
(Raupach 1994, Boundary-Layer Meteorology 71, 211-216; with the constants of ForestGALES: Hale et
al. 2015; Locatelli et al. 2022, Environmental Modelling & Software, R package fgr). Below the top
the wind decays exponentially (Cionco 1965). Its mean is that at the top.

Edge: the same at the windward edge of the stand behind a wide gap. The largest moment there over
the one inside is a function of spacing over height (Gardiner et al. 1997, wind tunnel; Hale et al.
2015; `edge_factor`); the wind in the crown is its root times that inside, at most that at the top.
Mean wind and gusts at the top are those inside.

Crowns in leaf that touch damp each other: see `CONTACT`.

Symbols: h height [m], D spacing [m], w and c width and depth of a crown [m], L frontal area of the
crowns over ground [-].
"""

from __future__ import annotations

from dataclasses import dataclass, replace
import math
from typing import Any

import numpy as np

from tree_sway.core.checks import one_of, within
from tree_sway.core.species import SPECIES, Species
from tree_sway.core.tree import Tree
from tree_sway.core.wind import SCALE_RATIOS, turbulence_scale, WindProfile

_INTEGRAL_SCALE = float(SCALE_RATIOS[0])
"""Integral scale of the wind along itself over the turbulence scale [-]."""

_OPEN_PEAK, _STAND_PEAK = 0.25, 0.15
"""
Frequency n at which n S(n) of the wind along itself is largest: n L / U of Kaimal's spectrum
(1 + 6 n L / U)^(-5/3), L its integral scale, and n h / U_h at the top of a stand of height h
(0.15 +- 0.05: Kaimal & Finnigan 1994, chapter 3).
"""

_HART_BECKING = 0.18
"""Spacing of a stand over its height [-]."""

EXPOSURES = ('open', 'street', 'edge', 'stand')
"""Kinds of exposure."""

STATION_HEIGHT, _GRASS = 10.0, 0.03
"""Height of weather stations and roughness of open grass in [m] (WMO guide no. 8)."""

_COUNTRY, _SUBURB = 0.05, 0.3
"""Roughness of the terrains II and III of EN 1991-1-4 in [m]."""

_ALONE = {'open': _GRASS, 'street': _SUBURB}
"""Roughness by the kinds of exposure without a stand in [m]."""

ATTENUATION = 2.7
"""
Attenuation a of the wind in a stand in [-]: 2.74 in spruce, 2.68 in oak and gum (Cionco 1978,
Boundary-Layer Meteorology 15, 81-93).
"""

_CD1, _CW, _CS, _CR, _LARGEST, _KARMAN = 7.5, 2.0, 0.003, 0.3, 0.6, 0.4
"""Constants of Raupach (1994), and the frontal area from which u* / U_h no longer grows."""

_GUSTS = {'open': 2.4, 'street': 2.4, 'edge': 1.8, 'stand': 1.8}
"""Deviation of the wind over u* [-]: Panofsky & Dutton 1984; Raupach, Finnigan & Brunet 1996."""

CONTACT = {'open': 1.0, 'street': 1.0, 'edge': 1.25, 'stand': 1.5}
"""
Damping of a tree in leaf whose crown touches those of its neighbours over that of it alone [-].

Two sources disagree: in a plantation of Sitka spruce interference, drag of still air and the stem
damped as 5 to 4 to 1, so twice as much as without neighbours (Milne 1991, Tree Physiology 9,
383-399), while Douglas-firs were damped alike when neighbours were held off (Moore & Maguire 2005,
Trees 19, 363-373). Taken is their mean; at an edge half of the neighbours are there. Bare crowns
hardly touch: trees of Wytham Woods that were let go in winter had mostly 0.02 to 0.07 in all
(Jackson et al. 2019, Journal of the Royal Society Interface 16, 20190116; fitted here).
"""


@dataclass(frozen=True)
class Exposure:
    """
    Exposure of a tree to the wind.

    Parameters
    ----------
    kind
        One of `EXPOSURES`.
    height
        Height of the tree, and of the stand around it, in [m].
    spacing
        Mean distance between the trees of the stand in [m].
    crown_width, crown_depth
        Width and depth of the crowns of the stand in [m].
    drag
        Drag coefficient of a crown in [-], at 10 m/s.
    anemometer_height
        Height of the mean wind above the ground in [m]; that of the kind if None.

    Raises
    ------
    ParameterError
        An unknown kind, or a value out of its range.

    """

    kind: str = 'open'
    height: float = 20.0
    spacing: float = 3.0
    crown_width: float = 4.0
    crown_depth: float = 9.0
    drag: float = 0.73
    anemometer_height: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        one_of('exposure', self.kind, EXPOSURES)
        highs = {'height': 150.0, 'spacing': 100.0, 'crown_width': 60.0, 'crown_depth': 150.0}
        for name, high in highs.items():
            within(name, getattr(self, name), 0.0, high, 'm', above=True)

    @property
    def is_alone(self) -> bool:
        """Whether no stand is around the tree."""
        return self.kind in _ALONE

    @property
    def frontal_area(self) -> float:
        """Streamlined frontal area of the crowns over ground, L [-]."""
        return self.crown_width * self.drag * self.crown_depth / self.spacing**2

    @property
    def friction_ratio(self) -> float:
        """Friction velocity over the wind at the reference height [-]."""
        if self.is_alone:
            return _KARMAN / math.log(self.reference_height / _ALONE[self.kind])
        return math.sqrt(_CS + 0.5 * _CR * min(self.frontal_area, _LARGEST))

    @property
    def displacement(self) -> float:
        """Displacement d of a stand in [m]."""
        depth = math.sqrt(_CD1 * self.frontal_area)
        return (1.0 - (1.0 - math.exp(-depth)) / depth) * self.height

    @property
    def reference_height(self) -> float:
        """Height above the ground of the mean wind in [m]."""
        if self.anemometer_height is not None:
            return self.anemometer_height
        if self.kind == 'street':
            return STATION_HEIGHT
        return min(self.height, STATION_HEIGHT) if self.kind == 'open' else self.height

    @property
    def intensity(self) -> float:
        """
        Turbulence intensity at the reference height [-], of the wind over the crown.

        Alone the factor B is of the crown, with the scale of EN 1991-1-4 at 0.6 of the height.
        """
        point = _GUSTS[self.kind] * self.friction_ratio
        if not self.is_alone:
            return point
        power = 0.67 + 0.05 * math.log(_ALONE[self.kind])
        scale = 300.0 * (0.6 * self.height / 200.0) ** power
        return point / math.sqrt(1.0 + 0.9 * ((self.crown_width + self.height) / scale) ** 0.63)

    @property
    def turbulence_height(self) -> float:
        """
        Height in [m] at which the open country's spectrum peaks at the frequency of this one's.

        At the top of a stand eddies follow its height: the peak is that of Kaimal's spectrum with
        an integral scale of 1.67 times the height.
        """
        if self.is_alone:
            return self.reference_height
        integral_scale = _OPEN_PEAK / _STAND_PEAK * self.height
        return integral_scale / (_INTEGRAL_SCALE * turbulence_scale(1.0))

    @property
    def turbulence(self) -> dict[str, Any]:
        """Height and intensity of simulated turbulence, as keywords of `Turbulence`."""
        return {'height': self.turbulence_height, 'intensity': self.intensity}

    @property
    def edge_factor(self) -> float:
        """
        Largest moment at the edge of a stand, behind a wide gap, over that deep inside it [-].

        Gardiner et al. (1997), as the edge and gap factor of ForestGALES (Hale et al. 2015).
        """
        ratio = min(max(self.spacing / self.height, 0.075), 0.45)
        inside = 2.7193 * ratio - 0.061
        at_edge = 0.9701 - 1.273 * ratio
        decay = 1.1127 * ratio + 0.0311
        deep = at_edge * decay**9
        return (inside + at_edge) / (inside + deep)

    @property
    def at_ten_metres(self) -> float:
        """
        Wind at 10 m over that at the reference height [-].

        In the open it is 10 m above the ground, from a street that of the same weather over the
        terrain II of EN 1991-1-4, at the edge of a stand or inside it 10 m above
        the displacement d of the stand, as ForestGALES states its winds (Hale et al. 2015).
        """
        if self.kind == 'open':
            return math.log(STATION_HEIGHT / _GRASS) / math.log(self.reference_height / _GRASS)
        if self.kind == 'street':
            country = math.log(STATION_HEIGHT / _COUNTRY) * (_COUNTRY / _SUBURB) ** 0.07
            return country / math.log(self.reference_height / _SUBURB)
        profile = self.profile()
        z0 = profile.roughness
        top = float(profile.over_anemometer(np.array(self.height)))
        over_top = math.log(STATION_HEIGHT / z0) / math.log((self.height - self.displacement) / z0)
        return top * over_top

    def scaled(self, height: float) -> Exposure:
        """Return the exposure of a tree of a height [m] with a stand in proportion around it."""
        ratio = height / self.height
        return replace(
            self,
            height=height,
            spacing=ratio * self.spacing,
            crown_width=ratio * self.crown_width,
            crown_depth=ratio * self.crown_depth,
        )

    def profile(self, ground: float = 0.0) -> WindProfile:
        """Return the profile over the height above the ground, that is at a height in [m]."""
        if self.is_alone:
            roughness = _ALONE[self.kind]
            return WindProfile('log', self.reference_height, roughness=roughness, ground=ground)
        d = self.displacement
        psi = math.log(_CW) - 1.0 + 1.0 / _CW
        roughness = (self.height - d) * math.exp(psi - _KARMAN / self.friction_ratio)
        return WindProfile(
            'canopy', self.reference_height, roughness=roughness, ground=ground,
            canopy_height=self.height, displacement=d, attenuation=ATTENUATION,
            exposed=math.sqrt(self.edge_factor) if self.kind == 'edge' else 1.0,
        )  # fmt: skip

    def in_contact(self, species: Species, learned_damping: float = 1.0) -> Species:
        """
        Return the species with the damping in leaf that a tree has among its neighbours.

        That of the table, and that by the factor which motion sensors have told, is of the tree
        without its neighbours. Any other was measured where the tree stands, and is kept.
        """
        expected = SPECIES.get(species.key, species).damping_in_leaf
        alone = expected, learned_damping * expected
        if not any(math.isclose(species.damping_in_leaf, each) for each in alone):
            return species
        damping = CONTACT[self.kind] * species.damping_in_leaf
        return replace(species, damping_in_leaf=min(damping, 1.0))

    @property
    def place(self) -> str:
        """Where the tree stands, for people."""
        return {
            'open': 'in the open',
            'street': 'in a street',
            'edge': f'at the edge of a stand, trees {self.spacing:.2g} m apart',
            'stand': f'in a stand, trees {self.spacing:.2g} m apart',
        }[self.kind]

    def __str__(self) -> str:
        """Return where the tree stands and where its mean wind is, for people."""
        return f'{self.place}; mean wind {self.reference_height:.3g} m above the ground'


def exposure_of(
    tree: Tree,
    species: Species,
    kind: str = 'open',
    *,
    spacing: float | None = None,
    anemometer_height: float | None = None,
) -> Exposure:
    """
    Return the exposure of a tree among others of its size.

    Parameters
    ----------
    tree, species
        The tree.
    kind
        One of `EXPOSURES`.
    spacing
        Mean distance between trees in [m]; if None, 0.18 of the height, that of stands thinned as
        foresters recommend (Hart-Becking spacing of 16 to 20 %).
    anemometer_height
        Height of the mean wind above the ground in [m]; that of the kind if None.

    """
    height = max(tree.height, 0.1)
    nodes = np.vstack([tree.start, tree.end])[:, :2]
    width = float(np.ptp(nodes, axis=0).mean())
    feet = tree.start[tree.branch_first[1:-1], 2] - tree.start[0, 2]
    lowest = float(np.percentile(feet, 5.0)) if len(feet) else 0.5 * height
    c, n = species.drag_law(in_leaf=True)
    return Exposure(
        kind, height, _HART_BECKING * height if spacing is None else spacing,
        max(width, 0.05 * height), max(height - lowest, 0.05 * height), c * 10.0**-n,
        anemometer_height,
    )  # fmt: skip
