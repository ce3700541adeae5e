# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Crowns of trees of a species by stem diameter and height.

Width and depth of crowns are the linear fits of ForestGALES, width on the diameter at breast
height and depth on the height (Hale et al. 2015, Forest Ecology and Management 354, 255-266; table
of the R package fgr: Locatelli et al. 2022, Environmental Modelling & Software 148). How far the
crown reaches down follows slenderness and diameter (Hasenauer & Monserud 1996, Forest Ecology and
Management 84, 49-60; coefficients of Hasenauer 2000, as the R package Prognaus has them).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tree_sway.core.species import species_named
from tree_sway.core.tree import Tree

BREAST_HEIGHT = 1.3
"""Height above the ground at which foresters measure the diameter of a stem in [m]."""

_WIDTH_AND_DEPTH = {
    'spruce': (0.8524, 11.5, 0.4206, 0.4368),
    'sitka': (0.6418, 13.46, 2.4682, 0.3667),
    'pine': (0.7005, 11.98, 1.3424, 0.3156),
    'douglas_fir': (1.83, 10.92, 1.1044, 0.4811),
    'fir': (2.1633, 7.71, -0.9251, 0.5968),
    'larch': (1.547, 14.19, 0.4706, 0.4692),
    'birch': (0.88, 17.0, 1.97, 0.40),
    'beech': (0.88, 18.0, 0.90, 0.47),
    'oak': (0.36, 19.0, 1.41, 0.40),
    'eucalyptus': (0.064, 15.49, 1.7828, 0.3486),
}
"""Width [m] at 0 and per [m] of diameter; depth [m] at 0 and per [m] of height [-]."""

_CROWN_RATIO = {
    'spruce': (0.011232, -0.63580e-4),
    'fir': (0.007637, -0.74049e-4),
    'larch': (0.009106, 0.0),
    'pine': (0.002942, 0.0),
    'beech': (0.007435, -1.35686e-4),
    'oak': (0.005525, -1.10735e-4),
    'conifer': (0.011232, -0.63580e-4),
    'broadleaf': (0.006490, -1.22350e-4),
}
"""Logit of the bare share of a stem per height over diameter [-] and per diameter^2 [1/cm^2]."""

_OF_HABIT = {'conifer': ('spruce', 'sitka', 'douglas_fir'), 'broadleaf': ('birch', 'beech', 'oak')}
"""Species whose means are used for others of a habit."""

_BARE_OPACITY = 0.35
"""
Share of the light that a bare broadleaf crown blocks [-], from the side: measured crowns block
0.16 to 0.48 (Heisler 1986, Urban Ecology 9, 337-359).
"""

AREA_SPREAD = 0.40
"""
Log-deviation of the area of wood in a crown of given diameter and height [-]: 0.18 of the width,
0.20 of the depth, 0.30 of the opacity.
"""


class CrownSize(NamedTuple):
    """Width and depth of a crown in [m]."""

    width: float
    depth: float

    @property
    def wood_area(self) -> float:
        """
        Diameter times length, summed over all wood of a bare broadleaf crown but its stem [m^2].

        Wood at random in an elliptic outline blocks `_BARE_OPACITY` of it (Monsi & Saeki 1953).
        """
        return -math.log(1.0 - _BARE_OPACITY) * 0.25 * math.pi * self.width * self.depth


def crown_size(species: str, diameter: float, height: float) -> CrownSize | None:
    """
    Return the crown of a tree of a species, by diameter at breast height and height in [m].

    None for pot plants, which no allometry of trees describes.
    """
    wood = species_named(species)
    rows = [_WIDTH_AND_DEPTH[wood.key]] if wood.key in _WIDTH_AND_DEPTH else None
    if rows is None:
        if wood.habit not in _OF_HABIT:
            return None
        rows = [_WIDTH_AND_DEPTH[each] for each in _OF_HABIT[wood.habit]]
    width_0, width_1, depth_0, depth_1 = np.mean(rows, axis=0).tolist()
    depth = min(max(depth_0 + depth_1 * height, 0.1 * height), height)
    return CrownSize(width_0 + width_1 * diameter, depth)


class CrownChange(NamedTuple):
    """How a crown differs from that of a tree of the usual diameter for its height."""

    width: float
    """Its width over the usual one [-]."""
    bare: float
    """Added to the logit of the share of the stem below the crown [-]."""


def crown_change(
    species: str, height: float, usual_diameter: float, diameter: float
) -> CrownChange:
    """
    Return how the diameter of a stem changes the crown of a tree of a height.

    Parameters
    ----------
    species
        Key of the species; those without an allometry have that of their habit.
    height
        Height in [m].
    usual_diameter, diameter
        Diameters at breast height in [m].

    """
    habit = species_named(species).habit
    usual = crown_size(species, usual_diameter, height)
    own = crown_size(species, diameter, height)
    if usual is None or own is None:
        return CrownChange(1.0, 0.0)
    of_slenderness, of_section = _CROWN_RATIO.get(species, _CROWN_RATIO[habit])
    slenderness = height / diameter - height / usual_diameter
    section = (100.0 * diameter) ** 2 - (100.0 * usual_diameter) ** 2
    return CrownChange(
        own.width / usual.width, of_slenderness * slenderness + of_section * section
    )


def breast_height_diameter(tree: Tree) -> float | None:
    """Diameter of the stem 1.3 m above the ground in [m]; None if it is not that high."""
    stem = tree.segments_of(0)
    level = np.append(tree.start[stem, 2], tree.end[stem, 2][-1]) - tree.start[0, 2]
    thick = np.append(tree.base_diameter[stem], tree.tip_diameter[stem][-1])
    if level.max() < BREAST_HEIGHT:
        return None
    return float(np.interp(BREAST_HEIGHT, np.maximum.accumulate(level), thick))
